#pragma once
// Points, maps of distances and ranges as ROS 2 messages, and back. All throw std::out_of_range for a time that ROS
// cannot hold, std::invalid_argument for what is no such message.
#include <initializer_list>

#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "types/DepthMap.hpp"
#include "types/PointCloud.hpp"
#include "types/Range.hpp"

namespace insonify::ros {

/** Makes `message` an empty cloud whose points are these numbers of 32 bits. */
void beginCloud(std::initializer_list<const char*> fields, PointCloud2& message);
/** Adds the numbers of one point, as many as there are fields. */
void addPoint(std::initializer_list<float> numbers, PointCloud2& message);
/** Tells how many rows the points make: 1 where they have no order. */
void endCloud(uint32_t rows, PointCloud2& message);

/** x, y, z in the axes of the world frame, named map [m], intensity: of each point's echo. Numbers of 32 bits, which
 *  far from the origin are coarse: half a metre at 5000 km. */
void convert(const types::PointCloud& cloud, WorldFrame frame, PointCloud2& message);
/** Reads x, y and z, and intensity where it is there, of 32 or 64 bits. */
void convert(const PointCloud2& message, WorldFrame frame, types::PointCloud& cloud);

/** One point for each cell, rows from the top: x, y, z of the sonar [m] and NaN where there is no return, intensity,
 *  range [m], azimuth [rad], elevation [rad], positive up. For polar maps with an angle for each row and column. */
void convert(const types::DepthMap& map, const std::string& frame_id, PointCloud2& message);
/** Reads range, azimuth, elevation and intensity of such a cloud. */
void convert(const PointCloud2& message, types::DepthMap& map);

/** A sonar's: +infinity where there is no return. */
void convert(const types::Range& range, const std::string& frame_id, Range& message);
void convert(const Range& message, types::Range& range);

}  // namespace insonify::ros
