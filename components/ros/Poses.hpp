#pragma once
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "components/ros/GeometryMessages.hpp"
#include "components/ros/Options.hpp"
#include "types/Mount.hpp"
#include "types/Pose.hpp"

namespace insonify::ros {

/** Converts a vector of the world from Rock's axes to those of a frame, and back. */
glm::dvec3 worldFromRock(WorldFrame frame, glm::dvec3 v);
glm::dvec3 rockFromWorld(WorldFrame frame, glm::dvec3 v);

/** Converts Rock's pose to the axes of ROS. Frame names are kept: target_frame is header.frame_id.
 *
 *  Odometry has velocities and their covariances in the body; Rock has the velocity in the world. Odometry has the
 *  covariance of the orientation in the world; Rock has it in the body. Unknown values (NaN) become 0, with -1 in their
 *  covariance, as in sensor_msgs/Imu; an unknown covariance becomes zeros. All throw std::out_of_range for a time that
 *  ROS cannot represent. */
void convert(const types::Pose& pose, WorldFrame frame, PoseStamped& message);
void convert(const types::Pose& pose, WorldFrame frame, Odometry& message);
/** Writes one transform: from the body to the world. */
void convert(const types::Pose& pose, WorldFrame frame, TFMessage& message);

/** Returns the mount of a sensor on the body, whose axes are those of `frame`. `axes` gives the sensor's axes. */
Transform toTransform(const types::Mount& mount, WorldFrame frame, SensorFrame axes);

/** Converts back. Values that the message lacks are unknown. */
void convert(const PoseStamped& message, WorldFrame frame, types::Pose& pose);
void convert(const Odometry& message, WorldFrame frame, types::Pose& pose);

// Helpers for poses and readings: unknown values, and covariances in other axes.

inline bool isUnknown(glm::dvec3 v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }
inline bool isUnknown(const glm::dmat3& m) { return isUnknown(m[0]) || isUnknown(m[1]) || isUnknown(m[2]); }

/** Turns a covariance by `turn`, which turns vectors: C becomes A C A^T. */
glm::dmat3 both(const glm::dmat3& covariance, auto&& turn) {
    const auto columns = [&](const glm::dmat3& m) { return glm::dmat3(turn(m[0]), turn(m[1]), turn(m[2])); };
    return columns(glm::transpose(columns(covariance)));
}

}  // namespace insonify::ros
