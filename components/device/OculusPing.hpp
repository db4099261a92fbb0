#pragma once
#include <cstdint>
#include <vector>

#include "components/device/oculus/OculusMessages.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::device {

/** A ping of a Blueprint Subsea Oculus: a "simple ping result" of version 1 or 2. */
struct OculusPing {
    uint32_t number = 0;
    double frequency_hz = 0;
    double speed_of_sound = 0;        ///< Used by the device [m/s].
    double range_resolution = 0;      ///< Slant range of a bin [m].
    double gamma = 1;                 ///< Exponent of the codes: max code * amplitude^gamma [1].
    int bits = 8;                     ///< Bits of a code: 8, 16, 24 or 32.
    std::vector<double> bearings;     ///< Middle of each beam, 0 ahead, positive to port [rad].
    uint32_t bin_count = 0;           ///< Per beam, nearest first.
    std::vector<uint32_t> codes;      ///< Beam by beam: beam b, bin k at b * bin_count + k.
    std::vector<uint32_t> row_gains;  ///< One per bin, if the device sends gains; else empty.

    uint32_t beamCount() const { return static_cast<uint32_t>(bearings.size()); }
    double maxCode() const { return static_cast<double>((uint64_t{1} << bits) - 1); }
};

OculusPing makePing(const OculusResult& result);

/** Returns the ping as a receiver's output: codes as bins, divided by the root of their row's gain; beams from
 *  starboard to port, as in simulated fans. Bins have the ping's range resolution, see types::RangeBins. If
 *  the ping has no speed of sound, it is 1500 m/s. */
types::Sonar getSonar(const OculusPing& ping, types::Time time);

/** Converts a receiver's codes of amplitude to the image of a ping.
 *
 *  A code is its max times `(code / max)^gamma`, at 8, 16 or 32 bits. With row gains, each row is multiplied by the
 *  root of its gain: the largest whole gain that keeps the row below the max code. Drivers divide by this root. At 32
 *  bits there are at most 65,536 different codes. */
class OculusEncoder {
public:
    /** @param bits of the receiver's codes */
    explicit OculusEncoder(int bits = 16) : max_code_((1u << bits) - 1) {}

    /** Sets image, bearings, counts and code width by `result.fire`. Beams are ordered from port to starboard; bearings
     *  ascend, also below -180 degrees. Beams of unknown bearing are omitted. */
    void encode(const types::Sonar& codes, OculusResult& result);

private:
    void bend(double gamma);
    uint32_t findIndex(float code) const;
    template <class Code>
    void rows(const types::Sonar& codes, const std::vector<uint32_t>& beams, OculusResult& result) const;

    uint32_t max_code_;
    double gamma_ = 0;
    std::vector<double> bent_;  ///< Fraction of the max code, by the receiver's code.
};

}  // namespace insonify::device
