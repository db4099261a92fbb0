#pragma once
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace insonify::types {

/** Returns whether a quaternion's length differs from 1 by more than 1 %: its components may be degrees, or in another
 *  order. */
inline bool isOddlyLong(const glm::dquat& orientation) { return std::abs(glm::length(orientation) - 1) > 0.01; }

/** Rotation angles about z, then y, then x: R = Rz(yaw) Ry(pitch) Rx(roll), as in types::Mount [rad]. */
struct Turns {
    double yaw = 0, pitch = 0, roll = 0;
};

/** Returns the rotation angles of a unit quaternion. */
inline Turns turnsOf(const glm::dquat& q) {
    return {.yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z)),
            .pitch = std::asin(std::clamp(2 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
            .roll = std::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y))};
}

}  // namespace insonify::types
