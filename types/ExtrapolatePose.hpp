#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "types/Pose.hpp"

namespace insonify::types {

/** A pose as its velocities have it at `time`, but at most `most` seconds on and never back; its stamp as well. As it
 *  is where they are not known. */
inline Pose extrapolatePose(Pose pose, Time time, double most) {
    const double seconds = std::clamp((time - pose.time).seconds(), 0.0, most);
    const double turn = glm::length(pose.angular_velocity) * seconds;
    if (!std::isfinite(glm::length(pose.velocity)) || !std::isfinite(turn)) return pose;
    pose.time.microseconds += std::llround(seconds * 1e6);
    pose.position += pose.velocity * seconds;
    if (turn > 0)
        pose.orientation =
            glm::normalize(pose.orientation) * glm::angleAxis(turn, glm::normalize(pose.angular_velocity));
    return pose;
}

}  // namespace insonify::types
