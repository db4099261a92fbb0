#pragma once
#include <string>

#include "components/ros/Messages.hpp"
#include "types/Time.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::gazebo {

/** The header of a message of Gazebo. */
struct Stamp {
    types::Time time;
    std::string frame_id;
};

// Bytes of Gazebo's messages. Throw std::invalid_argument for a sample that the message cannot represent.

/** Writes an Image: grey or colours of 8 bits, or grey of 16. */
std::string encode(const ros::Image& picture, const Stamp& stamp);
/** Writes a LaserScan: a range for each ray from starboard to port [m], infinite where there is no return. */
std::string encode(const ros::LaserScan& scan, const Stamp& stamp);
/** Writes a PointCloudPacked. */
std::string encode(const ros::PointCloud2& cloud, const Stamp& stamp);
/** Writes a Float_V: all bins of the first beam, then of the next. Its header has `beam_count` and `bin_count` [1],
 *  `bin_width` [m], `speed_of_sound` [m/s] and a list `bearings`, positive to port [rad]. */
std::string encode(const types::Sonar& ping, const Stamp& stamp);

}  // namespace insonify::gazebo
