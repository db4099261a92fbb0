#include "components/logger/Rotation.hpp"

#include <algorithm>
#include <vector>

#include "components/log/Files.hpp"
#include "types/ConfigError.hpp"

namespace insonify::logger {

namespace {

std::vector<std::filesystem::path> sequelsOf(const std::filesystem::path& log) {
    std::vector<std::filesystem::path> sequels;
    if (!sequenceNumber(log)) return sequels;
    std::error_code failed;
    for (auto old = nextInSequence(log); std::filesystem::exists(old, failed); old = nextInSequence(old))
        sequels.push_back(old);
    return sequels;
}

}  // namespace

void refuseSequels(const std::filesystem::path& log) {
    for (const auto& sequel : sequelsOf(log))
        if (log::isBeingWritten(sequel))
            throw types::ConfigError(sequel, "", "the log cannot be removed: another logger writes it");
}

void removeSequels(const std::filesystem::path& log) {
    const std::vector<std::filesystem::path> sequels = sequelsOf(log);
    std::for_each(sequels.rbegin(), sequels.rend(), log::removeLog);
}

Rotation::Rotation(const LoggerConfig& config, log::Writer& log)
    : log_(log), max_size_(config.max_file_size), max_duration_(config.max_file_duration) {}

bool Rotation::due(types::Time now) const {
    return (max_size_ && static_cast<double>(log_.size()) >= *max_size_) ||
           (max_duration_ && (now - *began_).seconds() >= *max_duration_);
}

void Rotation::before(types::Time now) {
    if (!began_) began_ = now;
    if (!due(now)) return;
    log_.next(nextInSequence(log_.path()));
    began_ = now;
}

}  // namespace insonify::logger
