#pragma once
// What an inertial unit, a Doppler log and a pressure gauge measure as ROS 2 messages, and back. All throw
// std::out_of_range for a time that ROS cannot hold.
#include <string>

#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Dvl.hpp"
#include "types/Imu.hpp"
#include "types/Pressure.hpp"

namespace insonify::ros {

/** Attitude and readings in the axes of `frame`: those of the world for the attitude, those of its body for the rest.
 *  What is unknown becomes 0, and an attitude the unit one, with -1 as the first element of its covariance; an unknown
 *  covariance becomes zeros. The covariance of the attitude is about the axes of the world. */
void convert(const types::Imu& imu, WorldFrame frame, const std::string& frame_id, Imu& message);
void convert(const Imu& message, WorldFrame frame, types::Imu& imu);

/** The same without an attitude. There is no place for a magnetic field. */
void convert(const types::ImuSensors& sensors, WorldFrame frame, const std::string& frame_id, Imu& message);
void convert(const Imu& message, WorldFrame frame, types::ImuSensors& sensors);

/** In the message's axes: x forward, y to starboard, z down. A velocity that is not known stays NaN, so that nobody
 *  takes it for standing still, with -1 in its covariance; so do ranges and velocities of lost beams.
 *  `beam_velocities_valid` tells whether there is bottom lock, as drivers of instruments have it. Velocities and
 *  variances of beams have 32 bits. std::invalid_argument for more than four beams. */
void convert(const types::Dvl& dvl, const std::string& frame_id, Dvl& message);
void convert(const Dvl& message, types::Dvl& dvl);

/** Its variance stays unknown. */
void convert(const types::Pressure& pressure, const std::string& frame_id, FluidPressure& message);
void convert(const FluidPressure& message, types::Pressure& pressure);

}  // namespace insonify::ros
