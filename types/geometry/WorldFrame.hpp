#pragma once
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <string_view>

#include "types/text/Describe.hpp"

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

/** Returns whether a quaternion's length differs from 1 by more than 1 %: its components may be degrees, or in another
 *  order. */
inline bool isOddlyLong(const glm::dquat& orientation) { return std::abs(glm::length(orientation) - 1) > 0.01; }

/** Rotation angles about z, then y, then x: R = Rz(yaw) Ry(pitch) Rx(roll), as in types::Mount [rad]. */
struct Turns {
    double yaw = 0, pitch = 0, roll = 0;
};

/** Returns the rotation angles of a unit quaternion. */
inline Turns toTurns(const glm::dquat& q) {
    return {.yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z)),
            .pitch = std::asin(std::clamp(2 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
            .roll = std::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y))};
}

/** Axes of poses. Rock's axes are used internally: world x north, y west, z up; body x forward, y left, z up. */
enum class WorldFrame {
    AsIs,  ///< Rock's axes.
    Enu,   ///< World x east, y north, z up; body as in Rock (REP 103).
    Ned    ///< World x north, y east, z down; body x forward, y right, z down.
};

/** Conversions between Rock's axes and those of a frame: rotations that only exchange and negate axes. */
struct Axes {
    WorldFrame frame;

    glm::dvec3 worldFromRock(glm::dvec3 v) const {
        if (frame == WorldFrame::Enu) return {-v.y, v.x, v.z};
        return body(v);
    }
    glm::dvec3 rockFromWorld(glm::dvec3 v) const {
        if (frame == WorldFrame::Enu) return {v.y, -v.x, v.z};
        return body(v);
    }
    /** Converts vectors of the body; the conversion is its own inverse. */
    glm::dvec3 body(glm::dvec3 v) const { return frame == WorldFrame::Ned ? glm::dvec3{v.x, -v.y, -v.z} : v; }
    glm::dquat orientationFromRock(glm::dquat q) const { return turned(q, 1); }
    glm::dquat rockFromOrientation(glm::dquat q) const { return turned(q, -1); }

private:
    glm::dquat turned(glm::dquat q, int way) const {
        constexpr double half = std::numbers::sqrt2 / 2;
        if (frame == WorldFrame::Enu) return glm::dquat(half, 0, 0, way * half) * q;
        return frame == WorldFrame::Ned ? glm::dquat(q.w, q.x, -q.y, -q.z) : q;
    }
};

}  // namespace insonify::types

template <>
struct insonify::types::EnumNames<insonify::types::WorldFrame> {
    static constexpr std::string_view names[] = {"as_is", "enu", "ned"};
};
