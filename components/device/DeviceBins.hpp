#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "types/samples/Sonar.hpp"

namespace insonify::device {

/** Fills samples of `width` [m] of one beam of a ping, from a slant range on [m]: the value of the bin at the middle of
 *  each; NaN beyond the ping. Finds each bin that is at least as wide as a sample. */
inline void resampleBeam(const types::Sonar& ping, size_t beam, double from, double width, std::span<float> samples) {
    for (size_t i = 0; i < samples.size(); ++i) {
        const double at = (from + (static_cast<double>(i) + 0.5) * width) / ping.binWidth();
        samples[i] = at < ping.bin_count ? ping.bins[beam * ping.bin_count + static_cast<size_t>(at)]
                                         : std::numeric_limits<float>::quiet_NaN();
    }
}

/** Puts the bins of a ping into those of a device whose protocol does not state their width, because its driver
 *  computes ranges from its own sample period. Sonars may have longer bins (`range_rounding: sample`). Returns false
 *  where the ping has bins of this width [m], or of none. */
inline bool setBinWidth(double width, types::Sonar& ping) {
    const double own = ping.binWidth();
    if (!(own > 0 && width > 0) || std::abs(own / width - 1) * ping.bin_count < 0.01) return false;
    std::vector<float> bins(ping.bins.size());
    for (size_t beam = 0; beam < bins.size() / ping.bin_count; ++beam)
        resampleBeam(ping, beam, 0, width, std::span(bins).subspan(beam * ping.bin_count, ping.bin_count));
    ping.bins = std::move(bins);
    ping.setBins(width, static_cast<double>(ping.speed_of_sound));
    return true;
}

}  // namespace insonify::device
