#pragma once
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>
#include <string>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::types {

/** State of a body in the world, field for field Rock's base::samples::RigidBodyState.
 *
 *  Frames: body x forward, y left, z up (`source_frame`); world x north, y west, z up (`target_frame`).
 *  NaN means unknown. Covariances are row-symmetric 3x3 of the quantity above them. */
struct Pose {
    static constexpr const char* type_name = "/base/samples/RigidBodyState";
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    static glm::dmat3 unknownMatrix() { return {glm::dvec3(unknown), glm::dvec3(unknown), glm::dvec3(unknown)}; }

    Time time;
    std::string source_frame;
    std::string target_frame;
    glm::dvec3 position{0};
    glm::dmat3 cov_position = unknownMatrix();
    glm::dquat orientation{1, 0, 0, 0};
    glm::dmat3 cov_orientation = unknownMatrix();
    glm::dvec3 velocity{unknown};
    glm::dmat3 cov_velocity = unknownMatrix();
    glm::dvec3 angular_velocity{unknown};
    glm::dmat3 cov_angular_velocity = unknownMatrix();

    /** Returns the homogeneous transform from body to world coordinates; `orientation` must be of unit length. */
    glm::dmat4 worldFromBody() const {
        glm::dmat4 transform = glm::mat4_cast(orientation);
        transform[3] = glm::dvec4(position, 1);
        return transform;
    }

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the state was true in the world"}, self.time);
        visit({"sourceFrame", "", "the body whose state this is"}, self.source_frame);
        visit({"targetFrame", "", "the frame in which it is given"}, self.target_frame);
        visit({"position", "m", "origin of the body in the target frame"}, self.position);
        visit({"cov_position", "m^2", "covariance of position"}, self.cov_position);
        visit({"orientation", "1", "unit quaternion that turns body vectors into the target frame"}, self.orientation);
        visit({"cov_orientation", "rad^2", "covariance of orientation, axis-angle in the body"}, self.cov_orientation);
        visit({"velocity", "m/s", "of the body, in the target frame"}, self.velocity);
        visit({"cov_velocity", "m^2/s^2", "covariance of velocity"}, self.cov_velocity);
        visit({"angular_velocity", "rad/s", "axis-angle rate, in the body"}, self.angular_velocity);
        visit({"cov_angular_velocity", "rad^2/s^2", "covariance of angular velocity"}, self.cov_angular_velocity);
    }
};

/** Returns whether position and orientation are finite, and the quaternion is longer than 1e-6. */
inline bool isUsable(const Pose& pose) {
    const double length = glm::length(pose.orientation);
    return std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.position.z) &&
           std::isfinite(length) && length > 1e-6;
}

/** Interpolates position and orientation between two poses, or other types with both: position linearly, orientation by
 *  slerp along the shorter way. Share 0 is `from`, 1 is `to` [1]. */
template <class Placed>
void interpolate(const Placed& from, const Placed& to, double share, Pose& pose) {
    pose.position = glm::mix(from.position, to.position, share);
    pose.orientation = glm::normalize(glm::slerp(from.orientation, to.orientation, share));
}

/** An orientation of unit length, and when it was true. */
struct Attitude {
    Time time;
    glm::dquat orientation;
};

/** Returns the orientation at a time in a list of at least one Attitude, in the order of time: by slerp between two of
 *  them, and before and after all of them the nearest. */
glm::dquat findOrientation(const auto& attitudes, Time time) {
    const auto after = std::ranges::lower_bound(attitudes, time, {}, &Attitude::time);
    if (after == attitudes.end()) return attitudes.back().orientation;
    if (after == attitudes.begin() || after->time == time) return after->orientation;
    const Attitude& before = *std::prev(after);
    const double share = (time - before.time).seconds() / (after->time - before.time).seconds();
    return glm::normalize(glm::slerp(before.orientation, after->orientation, share));
}

/** Returns a pose, with its stamp, extrapolated by its velocities to `time`, but at most `most` seconds forward and
 *  never back. Returns the pose unchanged when its velocities are unknown. */
inline Pose extrapolatePose(Pose pose, Time time, double maximum) {
    const double seconds = std::clamp((time - pose.time).seconds(), 0.0, maximum);
    const double turn = glm::length(pose.angular_velocity) * seconds;
    if (!std::isfinite(glm::length(pose.velocity)) || !std::isfinite(turn)) return pose;
    pose.time.microseconds += std::llround(seconds * 1e6);
    pose.position += pose.velocity * seconds;
    if (turn > 0)
        pose.orientation =
            glm::normalize(pose.orientation) * glm::angleAxis(turn, glm::normalize(pose.angular_velocity));
    return pose;
}

/** The pose of a sensor in the body: x forward, y left, z up; R = Rz(yaw) Ry(pitch) Rx(roll). */
struct Mount {
    glm::dvec3 position{0};                           ///< [m]
    double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;  ///< Positive pitch looks down, positive yaw turns to port [deg].

    glm::dquat orientation() const {
        const auto about = [](glm::dvec3 axis, double deg) { return glm::angleAxis(radians(deg), axis); };
        return about({0, 0, 1}, yaw_deg) * about({0, 1, 0}, pitch_deg) * about({1, 0, 0}, roll_deg);
    }

    static void describe(auto& self, auto& visit) {
        visit({"position", "m", "of the sensor in the body", -1e5, 1e5}, self.position);
        visit({"roll_deg", "deg", "about x", -360, 360}, self.roll_deg);
        visit({"pitch_deg", "deg", "about y, positive looks down", -360, 360}, self.pitch_deg);
        visit({"yaw_deg", "deg", "about z, positive turns to port", -360, 360}, self.yaw_deg);
    }
};

/** Sets the pose of the sensor in the world, at the body's time; velocities stay unknown. */
inline void place(const Pose& body, const Mount& mount, Pose& sensor) {
    const glm::dquat world_from_body = glm::normalize(body.orientation);
    sensor.time = body.time;
    sensor.source_frame = "sonar";
    sensor.target_frame = body.target_frame;
    sensor.position = body.position + world_from_body * mount.position;
    sensor.orientation = world_from_body * mount.orientation();
}

}  // namespace insonify::types
