#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "components/device/OculusMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::device {

/** A ping as a Blueprint Subsea Oculus sends it: a "simple ping result" of version 1 or 2. */
struct OculusPing {
    uint32_t number = 0;
    double frequency_hz = 0;
    double speed_of_sound = 0;        ///< As the device took it [m/s].
    double range_resolution = 0;      ///< Slant range of a bin [m].
    double gamma = 1;                 ///< Of the codes: largest code * amplitude^gamma [1].
    int bits = 8;                     ///< Of a code: 8, 16, 24 or 32.
    std::vector<double> bearings;     ///< Middle of each beam, 0 ahead, positive to port [rad].
    uint32_t bin_count = 0;           ///< Per beam, nearest first.
    std::vector<uint32_t> codes;      ///< Beam-first: of beam b in bin k at b * bin_count + k.
    std::vector<uint32_t> row_gains;  ///< Of each bin, where the device sends them; else empty.

    uint32_t beamCount() const { return static_cast<uint32_t>(bearings.size()); }
    double largestCode() const { return static_cast<double>((uint64_t{1} << bits) - 1); }
};

OculusPing pingOf(const OculusResult& result);

/** What a receiver would have given out: codes as bins, in rows with gains divided by the root of them; beams from
 *  starboard to port, as in a fan of ours. Its bin_duration is the nearest whole microsecond, at least 1. A speed
 *  of sound that the ping does not tell is 1500 m/s, so that ranges hold. */
types::Sonar sonarOf(const OculusPing& ping, types::Time time);

/** Every ping in these bytes, in order: network messages, one after the other, with anything between them, as in
 *  captures and in the maker's own log files. Other messages are passed over. What begins as a ping and contradicts
 *  itself (an image of another size than bins and beams make, bytes that are missing) is no ping.
 *  @param diagnostics where not null takes one line for each of these, up to 100 */
std::vector<OculusPing> oculusPings(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics = nullptr);

/** Those of a file. Throws types::ConfigError where it cannot be read or holds none, with the reason. */
std::vector<OculusPing> readOculusPings(const std::filesystem::path& file);

/** Makes a receiver's codes, which go as amplitude, into the image of a ping.
 *
 *  A code is its largest times `(code / largest)^gamma`, at 8, 16 or 32 bits. With row gains it is, in each row, times
 *  the root of the row's gain: the largest whole number that keeps the row below the largest code. That is what drivers
 *  divide by. At 32 bits there are no more than 65,536 different codes. */
class OculusEncoder {
public:
    /** @param bits of the receiver's codes */
    explicit OculusEncoder(int bits = 16) : largest_in_((1u << bits) - 1) {}

    /** Sets image, bearings, counts and width of a code, as `result.fire` asks. Beams go from port to starboard;
     *  bearings ascend, and go on below -180 degrees. Beams of unknown bearing are omitted. */
    void encode(const types::Sonar& codes, OculusResult& result);

private:
    void bend(double gamma);
    uint32_t indexOf(float code) const;
    template <class Code>
    void rows(const types::Sonar& codes, const std::vector<uint32_t>& beams, OculusResult& result) const;

    uint32_t largest_in_;
    double gamma_ = 0;
    std::vector<double> bent_;  ///< Share of the largest code, by the receiver's code.
};

}  // namespace insonify::device
