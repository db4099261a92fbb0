#include "components/logger/Rotation.hpp"

#include <iterator>
#include <map>

#include "components/log/Files.hpp"
#include "types/ConfigError.hpp"
#include "types/Elapsed.hpp"

namespace insonify::logger {

namespace {

/** Returns the files that follow `log` from an earlier run by their number, also after missing numbers. */
std::map<unsigned, std::filesystem::path> sequelsOf(const std::filesystem::path& log) {
    std::map<unsigned, std::filesystem::path> sequels;
    if (!sequenceNumber(log)) return sequels;
    std::error_code failed;
    const auto nameOf = [](const std::filesystem::path& file) { return file.stem().stem().string(); };
    const auto folder = log.has_parent_path() ? log.parent_path() : std::filesystem::path(".");
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
        const std::filesystem::path file = folder / entry.path().filename();
        const auto number = sequenceNumber(file);
        if (number > sequenceNumber(log) && file.extension() == log.extension() && nameOf(file) == nameOf(log) &&
            entry.is_regular_file(failed))
            sequels[*number] = file;
    }
    return sequels;
}

}  // namespace

void refuseSequels(const std::filesystem::path& log) {
    for (const auto& [number, sequel] : sequelsOf(log))
        if (log::isBeingWritten(sequel))
            throw types::ConfigError(sequel, "", "the log cannot be removed: another logger writes it");
}

void removeSequels(const std::filesystem::path& log) {
    for (auto sequels = sequelsOf(log); !sequels.empty(); sequels.erase(std::prev(sequels.end())))
        log::removeLog(sequels.rbegin()->second);
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
    began_ = now;  // also of a file that is opened later, because that fails now
    log_.next(nextInSequence(log_.path()));
}

}  // namespace insonify::logger
