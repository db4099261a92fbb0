#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "components/receiver/ReceiverConfig.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** The pings of a log that a receiver gave out as codes, imported or recorded from a run. */
struct CodedLog {
    std::vector<types::Sonar> pings;
    std::vector<types::Pose> sonars = {};  ///< The sonar at each ping; not usable: unknown.
    std::vector<double> altitudes = {};    ///< Above the bottom at each ping [m]; 0: unknown.
    receiver::CodeConfig code = {};        ///< As far as the log states it.
    bool law_known = false;                ///< Whether the log states the law of the codes.
    double frequency_khz = 0;              ///< 0: unknown.
};

/** Reads the first stream of a log whose bins are all whole numbers from 0 to 65535, as codes are, with the poses and
 *  altitudes at its pings (LoggedTrack.hpp); none: the file is no log by its name. Throws types::ConfigError for a log
 * that cannot be read or has no such stream. */
std::optional<CodedLog> codedLog(const std::filesystem::path& file);

}  // namespace insonify::deployer
