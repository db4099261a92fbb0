#include "components/receiver/AutomaticGain.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::receiver {

void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db) {
    const auto keptOf = [&](double time_ms) { return time_ms > 0 ? std::exp(-bin_ms / time_ms) : 0.0; };
    const double attack = keptOf(config.attack_ms), release = keptOf(config.release_ms);
    double level = -1;  // smoothed level of the bins so far; below 0 before the first
    for (size_t k = 0; k < means.size(); ++k) {
        const bool is_received = k >= first && means[k] >= 0;
        if (is_received && level < 0) level = means[k];
        const double kept = means[k] > level ? attack : release;
        // A sum of positive numbers, which keeps its digits where the level falls by many orders of magnitude.
        if (is_received) level = level * kept + means[k] * (1 - kept);
        const double wanted = level > 0 ? target - 10 * std::log10(level) : level < 0 ? 0 : config.max_db;
        gains_db[k] = std::clamp(wanted, -config.max_db, config.max_db);
    }
}

}  // namespace insonify::receiver
