#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <string_view>

#include "types/text/Describe.hpp"

namespace insonify::types {

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
