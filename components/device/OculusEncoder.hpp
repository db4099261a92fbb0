#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "components/device/OculusMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::device {

/** Makes a receiver's codes, which go as amplitude, into the image of a ping.
 *
 *  A code is its largest times `(code / largest)^gamma`, at 8, 16 or 32 bits. With row gains it is, in each row, times
 *  the root of the row's gain: the largest whole number that keeps the row below the largest code. That is what drivers
 *  divide by. At 32 bits there are no more than 65,536 different codes. */
class OculusEncoder {
public:
    /** @param bits of the receiver's codes */
    explicit OculusEncoder(int bits = 16) : largest_in_((1u << bits) - 1) {}

    /** Sets image, bearings, counts and width of a code, as `result.fire` asks; beams go from port to starboard. */
    void encode(const types::Sonar& codes, OculusResult& result);

private:
    void bend(double gamma);
    /** Beams from port to starboard. */
    static std::vector<uint32_t> order(const types::Sonar& codes);
    uint32_t indexOf(float code) const;
    template <class Code>
    void rows(const types::Sonar& codes, const std::vector<uint32_t>& beams, OculusResult& result) const;

    uint32_t largest_in_;
    double gamma_ = 0;
    std::vector<double> bent_;  ///< Share of the largest code, by the receiver's code.
};

}  // namespace insonify::device
