#pragma once
#include "components/ros/Options.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::ros {

/** How an image is to be read: its order and its axes. */
struct ImageLayout {
    ImageOrder order = ImageOrder::RangeMajor;
    SensorFrame frame = SensorFrame::ZForward;
};

/** The ping of an image; its memory is used again. Float bins are taken as they are, those of whole numbers with their
 *  greatest value becoming 1. bin_duration, one way, is the whole number of microseconds nearest to what ranges and
 *  speed of sound say; a time is cut to the microsecond. Throws std::invalid_argument, naming the diagnostic, for lists
 *  of unequal lengths, types other than uint8, uint16, uint32, float32 and float64, big-endian numbers, no speed of
 *  sound, and ranges that are not the centres of equal bins from 0 on. */
void convert(const ProjectedSonarImage& message, const ImageLayout& layout, types::Sonar& ping);

}  // namespace insonify::ros
