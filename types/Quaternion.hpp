#pragma once
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace insonify::types {

/** True where a quaternion's length is more than 1 % off 1: its parts may be degrees, or in another order. */
inline bool isOddlyLong(const glm::dquat& orientation) { return std::abs(glm::length(orientation) - 1) > 0.01; }

}  // namespace insonify::types
