#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/receiver/Receiver.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::study {

/** The place of a side-scan's line. */
struct LinePlace {
    double altitude = 0;  ///< Above the bottom [m]; 0: unknown.
    double along = 0;     ///< Distance along the track since the first line [m].
    double pitch = 0;     ///< The sonar's pitch: positive looks down [rad].
};

/** Returns the places of lines from the poses of the sonar and its altitudes; empty if both are unknown. Repeated
 *  values are from a slower sensor: track, altitude and pitch are interpolated over the lines between two different
 *  values. @param altitudes [m]; 0: unknown */
std::vector<LinePlace> getPlaces(const std::vector<types::Pose>& sonars, const std::vector<double>& altitudes);

/** A ping as output by an instrument, recorded or simulated. */
struct CodedPing {
    std::string name;
    size_t beam_count = 0, bin_count = 0;
    std::vector<double> bearings = {};   ///< Bearing of each beam's middle: 0 ahead, positive to port [rad].
    std::vector<float> codes = {};       ///< Beam-first, as fractions of the max code [1].
    int bits = 8;                        ///< Bits of a code.
    receiver::CodeConfig law = {};       ///< The relation of codes and intensity: `law`, `gamma`, `dynamic_range_db`.
    std::string file = {};               ///< Name of the recording.
    bool law_known = true;               ///< Whether the recording states the law of its codes.
    double resolution = 0;               ///< Slant range of a bin [m]; 0: unknown.
    double speed_of_sound = 0;           ///< [m/s]; 0: unknown.
    double frequency_khz = 0;            ///< 0: unknown.
    bool is_waterfall = false;           ///< Whether the beams are consecutive lines of one side of a side-scan.
    std::vector<LinePlace> places = {};  ///< Places of the lines of a waterfall; empty: unknown.

    float code(size_t beam, size_t bin) const { return codes[beam * bin_count + bin]; }
    /** Returns the level of a code relative to the max code; for code 0 that of half a code [dB]. */
    double levelDb(float code) const;
};

/** Returns a ping that a receiver output as codes, by the receiver's configuration. */
CodedPing codedPing(const types::Sonar& ping, const receiver::CodeConfig& code, std::string name);

/** Returns the lines of a side-scan, starboard and port, as two pings whose beams are its lines: "NAME_starboard",
 *  "NAME_port". Lines that differ in length from the first are omitted. @param places of the lines; empty: unknown */
std::vector<CodedPing> codedLines(const std::vector<types::Sonar>& lines, const receiver::CodeConfig& code,
                                  const std::string& name, const std::vector<LinePlace>& places = {});

/** Returns the pings of a recording, numbered as in it: "recorded_5"; a side-scan becomes a waterfall for each side.
 *  @param assumed law of codes whose law the recording does not state */
std::vector<CodedPing> codedPings(recordings::RecordingReader& reader, const receiver::CodeConfig& assumed);

/** Pings of a log, and the law of their codes if the log states it. */
struct LoggedPings {
    std::vector<types::Sonar> pings;
    receiver::CodeConfig code;
    bool law_known = false;
    double frequency_khz = 0;              ///< 0: unknown.
    std::vector<types::Pose> sonars = {};  ///< The sonar's pose at each ping; empty or not usable: unknown.
    std::vector<double> altitudes = {};    ///< Altitude above the bottom at each ping [m]; empty or 0: unknown.
};
/** Reads the pings of a log; returns none if the file is not a log. Throws types::ConfigError for a log without pings
 *  of codes. */
using ReadLog = std::function<std::optional<LoggedPings>(const std::filesystem::path& file)>;

struct PictureConfig;
/** Returns the pings of recordings, which are files or folders of files: of another program or device
 *  (recordings/RecordingReader.hpp), a log, or a picture (PictureFile.hpp). Names are numbered: "recorded_5". A
 * side-scan becomes a waterfall for each side.
 *  @param law of codes whose law the recording does not state; null: codes are proportional to amplitude
 *  @param readLog may be null
 *  @param pictures what is known of pictures; null: they are refused
 *  @throws types::ConfigError for a file without pings, or a folder without files */
std::vector<CodedPing> recordedPings(const std::vector<std::string>& names, const receiver::CodeConfig* law = nullptr,
                                     const ReadLog& readLog = nullptr, const PictureConfig* pictures = nullptr);

}  // namespace insonify::study
