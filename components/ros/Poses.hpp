#pragma once
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/samples/Dvl.hpp"
#include "types/samples/Fix.hpp"
#include "types/samples/Imu.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Pressure.hpp"

namespace insonify::ros {

// Conversions of the measurements of inertial units, Doppler logs and pressure gauges to ROS 2 messages and back. All
// throw std::out_of_range for a time that ROS cannot represent.
/** Converts attitude and readings to the axes of `frame`: the attitude to the world's, the readings to the body's. An
 *  unknown reading becomes 0 and an unknown attitude the identity, with -1 as the first element of the covariance. An
 *  unknown covariance becomes zeros. The attitude's covariance is about the axes of the world. */
void convert(const types::Imu& imu, WorldFrame frame, const std::string& frame_id, Imu& message);
void convert(const Imu& message, WorldFrame frame, types::Imu& imu);

/** Converts the same readings without an attitude. The message has no field for a magnetic field. */
void convert(const types::ImuSensors& sensors, WorldFrame frame, const std::string& frame_id, Imu& message);
void convert(const Imu& message, WorldFrame frame, types::ImuSensors& sensors);

/** Converts to the message's axes: x forward, y to starboard, z down. An unknown velocity stays NaN, so that it is not
 *  mistaken for standing still, with -1 in its covariance. Ranges and velocities of lost beams are NaN too.
 *  `beam_velocities_valid` states whether there is bottom lock, as in drivers of instruments. Velocities and variances
 *  of beams have 32 bits. Throws std::invalid_argument for more than four beams. */
void convert(const types::Dvl& dvl, const std::string& frame_id, Dvl& message);
void convert(const Dvl& message, types::Dvl& dvl);

/** Leaves the variance unknown. */
void convert(const types::Pressure& pressure, const std::string& frame_id, FluidPressure& message);
void convert(const FluidPressure& message, types::Pressure& pressure);

/** Converts a position on the earth. The message has the height above the ellipsoid, three kinds of fix (autonomous,
 *  differential, RTK), and neither the number of satellites nor the age of corrections. An unknown deviation makes the
 *  covariance unknown; covariances between the axes are lost on the way back. */
void convert(const types::Fix& fix, const std::string& frame_id, NavSatFix& message);
void convert(const NavSatFix& message, types::Fix& fix);

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
void convert(const types::Pose& pose, WorldFrame frame, PoseWithCovarianceStamped& message);
void convert(const types::Pose& pose, WorldFrame frame, Odometry& message);
/** Writes one transform: from the body to the world. */
void convert(const types::Pose& pose, WorldFrame frame, TFMessage& message);

/** Returns the mount of a sensor on the body, whose axes are those of `frame`. `axes` gives the sensor's axes. */
Transform toTransform(const types::Mount& mount, WorldFrame frame, SensorFrame axes);

/** Converts back. Values that the message lacks are unknown. */
void convert(const PoseStamped& message, WorldFrame frame, types::Pose& pose);
void convert(const PoseWithCovarianceStamped& message, WorldFrame frame, types::Pose& pose);
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
