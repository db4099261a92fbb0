#pragma once
// Conversions of the measurements of inertial units, Doppler logs and pressure gauges to ROS 2 messages and back. All
// throw std::out_of_range for a time that ROS cannot represent.
#include <string>

#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Dvl.hpp"
#include "types/Imu.hpp"
#include "types/Pressure.hpp"

namespace insonify::ros {

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

}  // namespace insonify::ros
