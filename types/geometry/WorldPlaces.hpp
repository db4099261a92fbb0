#pragma once
#include <cmath>
#include <glm/vec3.hpp>

namespace insonify::types {

/** Distance from the world's origin, along each axis, up to which numbers of 32 bits resolve half a millimetre [m].
 * Beyond it, as in UTM coordinates, places in the world have 64 bits, or are relative to an origin near by that has
 * them. */
inline constexpr double resolved_in_32_bits = 8192;

/** Whether a place needs more than 32 bits; false for a place that is not finite. */
inline bool isFarOut(const glm::dvec3& place) {
    const auto is_far = [](double x) { return std::isfinite(x) && std::abs(x) > resolved_in_32_bits; };
    return is_far(place.x) || is_far(place.y) || is_far(place.z);
}

}  // namespace insonify::types
