#pragma once
#include "components/log/Stream.hpp"
#include "types/Samples.hpp"

namespace insonify::log {

constexpr const char *objects_key = "insonify_objects", *bin_width_key = "insonify_bin_width",
                     *speed_of_sound_key = "insonify_speed_of_sound";

/** Adds what the first sample of a stream states for all of its samples: the names of objects as a JSON list
 *  (`insonify_objects`), and for bins that are not whole microseconds their exact width [m] and the speed of sound in
 *  the water [m/s] (`insonify_bin_width`, `insonify_speed_of_sound`). The samples of such a stream contain the speed of
 *  sound with which bin_duration is the width, see types::RangeBins. */
void addSampleMetadata(types::SampleView first, Metadata& metadata);

/** Restores the exact width of bins and the speed of sound in the water from a stream's metadata, if they are those of
 *  the sample. */
void restoreBins(const Metadata& metadata, types::SampleRoom sample);

}  // namespace insonify::log
