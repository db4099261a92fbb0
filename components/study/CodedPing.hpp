#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/device/OculusPing.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** Where a line of a side-scan was recorded. */
struct LinePlace {
    double altitude = 0;  ///< Above the bottom [m]; 0: unknown.
    double along = 0;     ///< Way since the first line [m].
    double pitch = 0;     ///< The sonar's: positive looks down [rad].
};

/** The places of lines from the poses of the sonar and its altitudes; empty where neither is known. What stays while
 *  lines go on is from a slower sensor: way, altitude and pitch are spread evenly over the lines between two values
 *  that differ. @param altitudes [m]; 0: unknown */
std::vector<LinePlace> placesOf(const std::vector<types::Pose>& sonars, const std::vector<double>& altitudes);

/** A ping as an instrument gives it out, recorded or simulated. */
struct CodedPing {
    std::string name;
    size_t beam_count = 0, bin_count = 0;
    std::vector<double> bearings = {};   ///< Of each beam's middle, 0 ahead, positive to port [rad].
    std::vector<float> codes = {};       ///< Beam-first, as shares of the largest code [1].
    int bits = 8;                        ///< Of a code.
    receiver::CodeConfig law = {};       ///< How codes go with intensity: `law`, `gamma`, `dynamic_range_db`.
    std::string file = {};               ///< Of a recording.
    bool law_known = true;               ///< Whether the recording states the law of its codes.
    double resolution = 0;               ///< Slant range of a bin [m]; 0: unknown.
    double speed_of_sound = 0;           ///< [m/s]; 0: unknown.
    double frequency_khz = 0;            ///< 0: unknown.
    bool is_waterfall = false;           ///< Its beams are consecutive lines of one side of a side-scan.
    std::vector<LinePlace> places = {};  ///< Of the lines of a waterfall; empty: unknown.

    float code(size_t beam, size_t bin) const { return codes[beam * bin_count + bin]; }
    /** Level of a code below that of the largest; of code 0 that of half a code [dB]. */
    double levelDb(float code) const;
};

/** A recorded ping. Where rows have gains of their own, these are taken off: codes by sqrt(gain), by what open drivers
 *  do. */
CodedPing codedPing(const device::OculusPing& ping, std::string name);

/** A ping that a receiver gave out as codes, by what it was configured to. */
CodedPing codedPing(const types::Sonar& ping, const receiver::CodeConfig& code, std::string name);

/** The lines of a side-scan, starboard and port, as two pings whose beams are its lines: "NAME_starboard", "NAME_port".
 *  Lines of other length than the first are omitted. @param places of the lines; empty: unknown */
std::vector<CodedPing> codedLines(const std::vector<types::Sonar>& lines, const receiver::CodeConfig& code,
                                  const std::string& name, const std::vector<LinePlace>& places = {});

/** Pings as a log has them, and the law of their codes where the log states it. */
struct LoggedPings {
    std::vector<types::Sonar> pings;
    receiver::CodeConfig code;
    bool law_known = false;
    double frequency_khz = 0;              ///< 0: unknown.
    std::vector<types::Pose> sonars = {};  ///< The sonar at each ping; empty or not usable: unknown.
    std::vector<double> altitudes = {};    ///< Above the bottom at each ping [m]; empty or 0: unknown.
};
/** Reads the pings of a log; none: the file is no log. Throws types::ConfigError for a log without pings of codes. */
using ReadLog = std::function<std::optional<LoggedPings>(const std::filesystem::path& file)>;

/** The pings of recordings, files or folders of them: of an Oculus, an ARIS, a Gemini, a side-scan, or a log. Each
 * comes once, named by its number: "recorded_5"; a side-scan is a waterfall for each side. @param law of codes whose
 * law the recording does not state; null: codes go as amplitude @param readLog may be null
 *  @throws types::ConfigError where a file holds none, or a folder no file */
std::vector<CodedPing> recordedPings(const std::vector<std::string>& names, const receiver::CodeConfig* law = nullptr,
                                     const ReadLog& readLog = nullptr);

}  // namespace insonify::study
