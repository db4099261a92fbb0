#pragma once
// Bodies with known motions.
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>

#include "components/nav/Motion.hpp"

namespace insonify::nav {

/** Returns a body at a time [s]. */
using Path = std::function<types::Pose(double)>;

inline types::Pose poseAt(double time, glm::dvec3 position, glm::dquat orientation = {1, 0, 0, 0}) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(time);
    pose.position = position;
    pose.orientation = orientation;
    return pose;
}

/** Returns the rotation by yaw, then pitch, then roll [deg]. */
inline glm::dquat turned(double yaw, double pitch = 0, double roll = 0) {
    return types::Mount{.roll_deg = roll, .pitch_deg = pitch, .yaw_deg = yaw}.orientation();
}

/** Returns a path round a circle at a rate [rad/s], heading along it and turning to port. */
inline Path circle(double radius, double rate) {
    return [=](double time) {
        const double angle = rate * time;
        return poseAt(time, {radius * std::sin(angle), -radius * std::cos(angle), -5},
                      glm::angleAxis(angle, glm::dvec3(0, 0, 1)));
    };
}

/** Returns the motion at a time, from poses `step` apart [s]. */
inline Motion motionAt(const Path& path, double time, double step, const types::Mount& mount = {}) {
    MotionTracker tracker(mount);
    tracker.take(path(time - step));
    tracker.take(path(time));
    return tracker.take(path(time + step)).value();
}

/** Returns the motion of a body at rest. */
inline Motion atRest(double time, glm::dquat orientation = {1, 0, 0, 0}, glm::dvec3 position = {}) {
    return motionAt([=](double t) { return poseAt(t, position, orientation); }, time, 0.01);
}

}  // namespace insonify::nav
