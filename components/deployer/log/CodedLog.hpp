#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "components/receiver/Receiver.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {

/** The pings of a log, imported or recorded from a run, whose receiver output codes. */
struct CodedLog {
    std::vector<types::Sonar> pings;
    std::vector<types::Pose> sonars = {};  ///< Poses of the sonar at the pings; an unusable pose is unknown.
    std::vector<double> altitudes = {};    ///< Above the bottom at each ping [m]; 0: unknown.
    receiver::CodeConfig code = {};        ///< As far as the log records it.
    bool law_known = false;                ///< Whether the log records the law of the codes.
    double frequency_khz = 0;              ///< 0: unknown.
};

/** Reads the first stream of a log whose bins are all codes, that is whole numbers from 0 to 65535, with the poses and
 *  altitudes at its pings (LoggedTrack.hpp). Returns none if the file name is not that of a log. Throws
 *  types::ConfigError for a log that cannot be read or has no such stream. */
std::optional<CodedLog> codedLog(const std::filesystem::path& file);

}  // namespace insonify::deployer
