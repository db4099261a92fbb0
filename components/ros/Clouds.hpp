#pragma once
// Conversions of points, distance maps and ranges to ROS 2 messages and back. All throw std::out_of_range for a time
// that ROS cannot represent, and std::invalid_argument for invalid messages.
#include <initializer_list>

#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/DepthMap.hpp"
#include "types/PointCloud.hpp"
#include "types/Range.hpp"

namespace insonify::ros {

/** Makes `message` an empty cloud with the given fields of 32 bits. */
void beginCloud(std::initializer_list<const char*> fields, PointCloud2& message);
/** Adds one point; `numbers` has one number for each field. */
void addPoint(std::initializer_list<float> numbers, PointCloud2& message);
/** Sets the number of rows; 1 for unordered points. */
void endCloud(uint32_t rows, PointCloud2& message);

/** Writes x, y, z in the axes of the world frame, named map [m], and the intensity of each point's echo. The fields are
 *  FLOAT32; x, y and z are FLOAT64 if a point is farther from the origin than 32 bits resolve (WorldPlaces.hpp). */
void convert(const types::PointCloud& cloud, WorldFrame frame, PointCloud2& message);
/** Reads x, y and z, and intensity if present, of 32 or 64 bits. */
void convert(const PointCloud2& message, WorldFrame frame, types::PointCloud& cloud);

/** Writes one point for each cell, rows from the top: x, y, z in the sonar [m], intensity, range [m], azimuth [rad],
 *  elevation [rad], positive up. x, y and z are NaN where there is no return. Only for polar maps with an angle for
 *  each row and column. */
void convert(const types::DepthMap& map, const std::string& frame_id, PointCloud2& message);
/** Reads range, azimuth, elevation and intensity of a cloud as written above. */
void convert(const PointCloud2& message, types::DepthMap& map);

/** Writes a sonar's range: +infinity if there is no return. */
void convert(const types::Range& range, const std::string& frame_id, Range& message);
void convert(const Range& message, types::Range& range);

}  // namespace insonify::ros
