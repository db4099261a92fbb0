#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "types/Sonar.hpp"

namespace insonify::device {

/** Puts the bins of a ping into those of a device whose protocol does not state their width, because its driver
 *  computes ranges from its own sample period. Sonars may have longer bins (`range_rounding: sample`). Each bin gets
 *  the value at its middle; NaN beyond the ping. Returns false where the ping has bins of this width [m], or of none.
 */
inline bool takeBinWidth(double width, types::Sonar& ping) {
    const double own = ping.binWidth();
    if (!(own > 0 && width > 0) || std::abs(own / width - 1) * ping.bin_count < 0.01) return false;
    const std::vector<float> before = ping.bins;
    for (size_t i = 0; i < before.size(); ++i) {
        const size_t beam = i / ping.bin_count, bin = i % ping.bin_count;
        const double at = (static_cast<double>(bin) + 0.5) * width / own;
        ping.bins[i] = at < ping.bin_count ? before[beam * ping.bin_count + static_cast<size_t>(at)]
                                           : std::numeric_limits<float>::quiet_NaN();
    }
    ping.setBins(width, static_cast<double>(ping.speed_of_sound));
    return true;
}

}  // namespace insonify::device
