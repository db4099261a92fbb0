#pragma once
// Recordings of speckle in the format of an Oculus.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/OculusMessage.hpp"
#include "types/text/Hash.hpp"

namespace insonify::test {

/** Two pings of 64 beams by 128 bins of Rayleigh speckle, numbers 5 and 6. @param frozen both have the same */
inline std::string recordedSpeckle(bool frozen = false) {
    std::string bytes;
    for (const uint32_t number : {5u, 6u}) {
        const auto speckle = [&](size_t beam, size_t bin) {
            const uint64_t word = types::hashed(frozen ? 5 : number, beam, bin);
            return static_cast<uint8_t>(std::min(255.0, 90 * std::sqrt(std::sqrt(-std::log(types::unit(word >> 32))))));
        };
        const auto message = OculusMessage{.beams = 64, .bins = 128, .number = number, .code = speckle}.bytes();
        bytes.append(message.begin(), message.end());
    }
    return bytes;
}

}  // namespace insonify::test
