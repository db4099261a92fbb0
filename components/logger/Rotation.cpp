#include "components/logger/Rotation.hpp"

#include <vector>

#include "components/log/Files.hpp"
#include "types/Elapsed.hpp"

namespace insonify::logger {

void removeSequels(const std::filesystem::path& log) {
    if (!sequenceNumber(log)) return;
    std::vector<std::filesystem::path> sequels;
    std::error_code failed;
    for (auto old = nextInSequence(log); std::filesystem::exists(old, failed); old = nextInSequence(old))
        sequels.push_back(old);
    for (; !sequels.empty(); sequels.pop_back()) log::removeLog(sequels.back());
}

Rotation::Rotation(const LoggerConfig& config, log::Writer& log)
    : log_(log), max_size_(config.max_file_size), max_duration_(config.max_file_duration) {}

bool Rotation::due(types::Time now) const {
    return (max_size_ && static_cast<double>(log_.size()) >= *max_size_) ||
           (max_duration_ && types::due(*began_, types::Time::fromSeconds(*max_duration_), now));
}

void Rotation::before(types::Time now) {
    if (!began_) began_ = now;
    if (!due(now)) return;
    log_.next(nextInSequence(log_.path()));
    began_ = now;
}

}  // namespace insonify::logger
