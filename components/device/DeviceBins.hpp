#pragma once
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "types/Sonar.hpp"

namespace insonify::device {

/** Returns samples of one beam of a ping, from a slant range on [m]: the value of the bin at the middle of each; NaN
 *  beyond the ping. Finds each bin that is at least as wide as a sample. */
inline std::vector<float> samplesOf(const types::Sonar& ping, size_t beam, double from, double width, size_t count) {
    std::vector<float> samples(count, std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < count; ++i)
        if (const double at = (from + (static_cast<double>(i) + 0.5) * width) / ping.binWidth(); at < ping.bin_count)
            samples[i] = ping.bins[beam * ping.bin_count + static_cast<size_t>(at)];
    return samples;
}

/** Puts the bins of a ping into those of a device whose protocol does not state their width, because its driver
 *  computes ranges from its own sample period. Sonars may have longer bins (`range_rounding: sample`). Returns false
 *  where the ping has bins of this width [m], or of none. */
inline bool takeBinWidth(double width, types::Sonar& ping) {
    const double own = ping.binWidth();
    if (!(own > 0 && width > 0) || std::abs(own / width - 1) * ping.bin_count < 0.01) return false;
    std::vector<float> bins;
    for (size_t beam = 0; beam < ping.bins.size() / ping.bin_count; ++beam) {
        const std::vector<float> samples = samplesOf(ping, beam, 0, width, ping.bin_count);
        bins.insert(bins.end(), samples.begin(), samples.end());
    }
    ping.bins = std::move(bins);
    ping.setBins(width, static_cast<double>(ping.speed_of_sound));
    return true;
}

}  // namespace insonify::device
