#pragma once
// Conversions of points, distance maps and ranges to ROS 2 messages and back. All throw std::out_of_range for a time
// that ROS cannot represent, and std::invalid_argument for invalid messages.
#include <initializer_list>
#include <optional>

#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/PointCloud.hpp"
#include "types/samples/Range.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::ros {

/** Returns the range of the centre of bin k of a ping [m]. */
inline float binCentre(const types::Sonar& ping, uint32_t k) { return static_cast<float>(ping.binStart(k + 0.5)); }

/** Returns the unit vector at a bearing (positive to port) in the plane of the fan. */
Vector3 computeDirection(double bearing_rad, SensorFrame frame);

/** Returns the range from which on bins of a ping are returns [m]. */
double rangeMin(const SonarOptions& options);

/** Decides which bins of one ping are returns, by a threshold for types::ReturnLevels. It is relative to the strongest
 *  level of the ping; with a `reference_db`, to that level of a bin. Of levels in decibels only the range counts. */
class DetectionThreshold {
public:
    DetectionThreshold(const types::Sonar& ping, const SonarOptions& options);
    /** Whether bin `k` of a beam, which has this value, is a return. */
    bool isReturn(size_t k, float bin) const {
        const double gain = is_absolute_ ? levels_.gain(k) : 1;
        if (is_linear_) return levels_.at(k, static_cast<double>(bin)) >= minimum_ * gain;
        return k >= levels_.first() && bin >= static_cast<float>(minimum_);
    }
    /** Returns the first bin of a beam that is a return. */
    std::optional<uint32_t> findFirst(uint32_t beam) const;
    /** Whether a beam has no return, but a strong echo nearer than rangeMin(). */
    bool isTooNear(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    const types::ReturnLevels& levels_;
    bool is_linear_, is_absolute_;
    double minimum_;
};

/** Writes the bins in the order and type of the options. */
void fillImage(const types::Sonar& ping, const SonarOptions& options, SonarImageData& image);

/** Makes `message` an empty cloud with the given fields of 32 bits. */
void beginCloud(std::initializer_list<const char*> fields, PointCloud2& message);
/** Adds one point; `numbers` has one number for each field. */
void addPoint(std::initializer_list<float> numbers, PointCloud2& message);
/** Sets the number of rows; 1 for unordered points. */
void endCloud(uint32_t rows, PointCloud2& message);

/** Writes x, y, z in the axes of the world frame, named map [m], and the intensity of each point's echo. The fields are
 *  FLOAT32; x, y and z are FLOAT64 if a point is farther from the origin than 32 bits resolve (WorldFrame.hpp). */
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
