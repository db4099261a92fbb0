#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"

namespace insonify::recordings {

/** A ping of a recording and further values of its record. */
struct FanFrame {
    types::Sonar ping;         ///< Codes; beams from starboard to port, nearest bin first.
    types::Pose sonar;         ///< In the world; not finite: unknown.
    double altitude = 0;       ///< Above the bottom [m]; 0: unknown.
    double frequency_khz = 0;  ///< 0: unknown.
    double window_start = 0;   ///< Slant range of the first sample [m]; the bins before it are 0.
};

/** Reads a recording of a forward-looking sonar with samples of 8 bits, ping by ping. */
class FanFile : public RecordingReader {
public:
    static constexpr int code_bits = 8;

    /** Returns the next ping; none at the end of the file. Throws types::ConfigError with the byte at which the first
     *  ping is damaged. Later damage ends the pings, with a notice. */
    std::optional<FanFrame> next();
    /** Returns the range of the levels from code 0 to the max code [dB]; none if the meaning of codes is unknown. */
    virtual std::optional<double> dynamicRange() const = 0;
    std::vector<std::string> notices() const override;

protected:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit FanFile(const std::filesystem::path& path) : RecordingReader(path, "a recording of a sonar") {}

    /** Returns the next ping, or fails. */
    virtual std::optional<FanFrame> read() = 0;
    /** Returns what is wrong with a time since the epoch [us], or with its order; empty if nothing is. */
    std::string diagnosticOf(double time_us) const;
    /** Sets beams and bins: `first` bins without echo, then the samples, all beams of the nearest range first.
     *  @param bearings of the samples' beams, in any order [rad] */
    static void setBins(std::span<const double> bearings, uint32_t first, std::span<const char> samples,
                        types::Sonar& ping);

private:
    size_t frames_ = 0;
    types::Time last_;
    std::string damage_;  ///< The damage that ended the pings; empty if none.
};

/** Opens a recording by its content; returns null for a file that is not a recording of an ARIS or a Gemini. */
std::unique_ptr<FanFile> openFan(const std::filesystem::path& path);

}  // namespace insonify::recordings
