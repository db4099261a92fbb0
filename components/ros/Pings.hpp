#pragma once
// A ping as ROS 2 messages, and back. The memory of what is written to is used again. What makes messages throws
// std::invalid_argument for a ping whose lists are not as long as its counts say, and std::out_of_range for a time that
// ROS cannot hold.
#include "components/ros/Options.hpp"
#include "components/ros/SensorMessages.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::ros {

/** The level that 255 and thresholds refer to: `reference_db`, or that of the ping's strongest bin [dB]. -3000 for a
 *  ping without an echo. */
double referenceDb(const types::Sonar& ping, const SonarOptions& options);

/** The image with the directions of the beams and the centres of the bins. uint8 is
 *  255 * (1 + (level - reference) / dynamic_range_db), rounded, clipped to 0..255, and 0 for NaN and for no echo;
 *  float32 are the bins unchanged. Unknown beam widths become empty lists. Stamps of single beams are left out. */
void convert(const types::Sonar& ping, const SonarOptions& options, ProjectedSonarImage& message);

/** The image with angles of beams and a rate of samples; stamps of single beams become delays. */
void convert(const types::Sonar& ping, const SonarOptions& options, RawSonarImage& message);

/** The first bin of each beam that lies at or above the threshold, by its centre. A beam without one has range NaN,
 *  intensity 0 and the flag "bad filter". Intensities are the bins. */
void convert(const types::Sonar& ping, const SonarOptions& options, SonarRanges& message);

/** Every bin at or above the threshold as a point: x, y, z [m], intensity: the bin. */
void convert(const types::Sonar& ping, const SonarOptions& options, PointCloud2& message);

/** First returns as above, infinite where there is none. The rays go from starboard to port whatever the order of the
 *  beams; angles exceed pi across +-180 degrees. Beams at multiples of the smallest angle between two of them have rays
 *  of range NaN between them. Throws std::invalid_argument for beams at other angles from one another. */
void convert(const types::Sonar& ping, const SonarOptions& options, LaserScan& message);

/** How an image is to be read: its order and its axes. */
struct ImageLayout {
    ImageOrder order = ImageOrder::RangeMajor;
    SensorFrame frame = SensorFrame::ZForward;
};

/** The ping of an image. Float bins are taken as they are, those of whole numbers with their
 *  greatest value becoming 1. bin_duration, one way, is the whole number of microseconds nearest to what ranges and
 *  speed of sound say; a time is cut to the microsecond. Throws std::invalid_argument, naming the diagnostic, for lists
 *  of unequal lengths, types other than uint8, uint16, uint32, float32 and float64, big-endian numbers, no speed of
 *  sound, and ranges that are not the centres of equal bins from 0 on. */
void convert(const ProjectedSonarImage& message, const ImageLayout& layout, types::Sonar& ping);

}  // namespace insonify::ros
