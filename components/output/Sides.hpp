#pragma once
#include <optional>

#include "types/Sonar.hpp"

namespace insonify::output {

/** Returns the first beam of a ping on a side, +1 for port, -1 for starboard; none if there is none. */
inline std::optional<uint32_t> firstBeamOn(const types::Sonar& ping, int side) {
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        if (ping.bearings[beam].rad * side > 0) return beam;
    return {};
}

}  // namespace insonify::output
