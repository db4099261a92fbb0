#pragma once
// Conversions of a ping to ROS 2 messages and back. The memory of outputs is reused. Conversions to messages throw
// std::invalid_argument for a ping whose lists do not match its counts, and std::out_of_range for a time that ROS
// cannot represent.
#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarDetections.hpp"

namespace insonify::ros {

/** Returns the level of 255 and of thresholds: `reference_db`, or the level of the ping's strongest bin [dB]. -3000 for
 *  a ping without an echo. */
double referenceDb(const types::Sonar& ping, const SonarOptions& options);

/** Writes the image, the directions of the beams and the centres of the bins. uint8 is 255 * (1 + (level - reference) /
 *  dynamic_range_db), rounded and clipped to 0..255; NaN and no echo become 0. float32 are the bins unchanged. Unknown
 *  beam widths become empty lists. Stamps of single beams are omitted. */
void convert(const types::Sonar& ping, const SonarOptions& options, ProjectedSonarImage& message);

/** Writes the image with angles of beams and a sample rate; stamps of single beams become delays. */
void convert(const types::Sonar& ping, const SonarOptions& options, RawSonarImage& message);

/** Writes the centre of each beam's first bin at or above the threshold. A beam without such a bin has range NaN,
 *  intensity 0 and the flag "bad filter". Intensities are the bins. */
void convert(const types::Sonar& ping, const SonarOptions& options, SonarRanges& message);

/** Writes first returns as above, as two-way travel times after each beam's own transmission: NaN, with intensity 0 and
 *  the flag "bad filter", for a beam without one. The angle of the receiver is the beam's, positive to starboard; that
 *  of the transmitter is 0. */
void convert(const types::Sonar& ping, const SonarOptions& options, SonarDetections& message);

/** Writes the detections of a sonar: the angle of the receiver is a beam's bearing, positive to starboard; that of the
 *  transmitter its elevation, positive up, which is forward for a sonar that looks down. A beam without a return has
 *  travel time NaN, intensity 0 and the flag "bad sonar". All beams transmit at the stamp. */
void convert(const types::SonarDetections& detections, const SonarOptions& options, SonarDetections& message);
/** Reads the detections of a sonar; a beam that is flagged for any reason has no return. Throws std::invalid_argument
 *  for lists of unequal lengths, except those that may be empty: flags (all good), intensities and angles of the
 *  transmitter (0). */
void convert(const SonarDetections& message, types::SonarDetections& detections);

/** Writes every bin at or above the threshold as a point: x, y, z [m], intensity: the bin. */
void convert(const types::Sonar& ping, const SonarOptions& options, PointCloud2& message);

/** Writes first returns as above, infinite where there is none (REP 117), -infinite where there is only an echo nearer
 *  than `range_min`. Rays are ordered from starboard to port for any order of beams; angles exceed pi across +-180
 *  degrees. If beams are at multiples of the min angle between two of them, the rays in gaps have range NaN. Throws
 *  std::invalid_argument for beams at other angles. */
void convert(const types::Sonar& ping, const SonarOptions& options, LaserScan& message);

/** The order and the axes of an image to read. */
struct ImageLayout {
    ImageOrder order = ImageOrder::RangeMajor;
    SensorFrame frame = SensorFrame::ZForward;
};

/** Reads the ping of an image. Float bins are taken unchanged; integers are divided by their max value. Bins have the
 *  width of the ranges, see types::RangeBins. Times are truncated to microseconds. Throws std::invalid_argument with a
 *  diagnostic for: lists of unequal lengths, types other than uint8, uint16, uint32, float32 and float64, big-endian
 *  numbers, no speed of sound, and ranges that are not the centres of equal bins from 0 on. */
void convert(const ProjectedSonarImage& message, const ImageLayout& layout, types::Sonar& ping);

}  // namespace insonify::ros
