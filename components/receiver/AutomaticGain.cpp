#include "components/receiver/AutomaticGain.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::receiver {

void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db) {
    const auto shareOf = [&](double time_ms) { return time_ms > 0 ? -std::expm1(-bin_ms / time_ms) : 1.0; };
    const double attack = shareOf(config.attack_ms), release = shareOf(config.release_ms);
    double level = -1;  // smoothed level of the bins so far; below 0 before the first
    for (size_t k = 0; k < means.size(); ++k) {
        const bool is_received = k >= first && means[k] >= 0;
        if (is_received && level < 0) level = means[k];
        if (is_received) level += (means[k] - level) * (means[k] > level ? attack : release);
        const double wanted = level > 0 ? target - 10 * std::log10(level) : level < 0 ? 0 : config.max_db;
        gains_db[k] = std::clamp(wanted, -config.max_db, config.max_db);
    }
}

}  // namespace insonify::receiver
