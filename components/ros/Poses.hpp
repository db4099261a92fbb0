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

/** A vector of the world in the axes of a frame, and back. */
glm::dvec3 worldFromRock(WorldFrame frame, glm::dvec3 v);
glm::dvec3 rockFromWorld(WorldFrame frame, glm::dvec3 v);

/** Rock's pose in the axes of ROS. Names of frames are kept: target_frame is header.frame_id.
 *
 *  Odometry gives velocities and their covariances in the body; Rock has the velocity in the world, and the covariance
 *  of the orientation in the body, where Odometry has it in the world. What is unknown (NaN) becomes 0, with -1 in its
 *  covariance, as in sensor_msgs/Imu; an unknown covariance becomes zeros.
 *  All throw std::out_of_range for a time that ROS cannot hold. */
void convert(const types::Pose& pose, WorldFrame frame, PoseStamped& message);
void convert(const types::Pose& pose, WorldFrame frame, Odometry& message);
/** One transform: that of the body in the world. */
void convert(const types::Pose& pose, WorldFrame frame, TFMessage& message);

/** Where a sensor sits in the body, whose axes are those of `frame`; the sensor's are as `axes` says. */
Transform toTransform(const types::Mount& mount, WorldFrame frame, SensorFrame axes);

/** The reverse. What the message does not tell is unknown. */
void convert(const PoseStamped& message, WorldFrame frame, types::Pose& pose);
void convert(const Odometry& message, WorldFrame frame, types::Pose& pose);

// What poses and readings share: what is not known of them, and covariances in other axes.

inline bool isUnknown(glm::dvec3 v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }
inline bool isUnknown(const glm::dmat3& m) { return isUnknown(m[0]) || isUnknown(m[1]) || isUnknown(m[2]); }

/** A covariance, whose columns are vectors, where `turn` turns a vector: C becomes A C A^T. */
template <class Turn>
glm::dmat3 both(const glm::dmat3& covariance, Turn&& turn) {
    const auto columns = [&](const glm::dmat3& m) { return glm::dmat3(turn(m[0]), turn(m[1]), turn(m[2])); };
    return columns(glm::transpose(columns(covariance)));
}

}  // namespace insonify::ros
