#include "types/ReturnLevels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace insonify::types {
namespace {

constexpr double per_db = std::numbers::ln10 / 10;  ///< [1/dB]

/** Returns the mean of the ring-down between two slant ranges (ACOUSTICS.md 5.15) [1]. */
double ringDown(const ReturnRules& rules, double from, double to) {
    const double decay = per_db * rules.ring_down_db_per_m;
    return std::pow(10, rules.ring_down_db / 10) * std::exp(-decay * from) * -std::expm1(-decay * (to - from)) /
           (decay * (to - from));
}

}  // namespace

void ReturnLevels::take(const RangeBins& bins, uint32_t count, const ReturnRules& rules) {
    if (gain_.size() == count && bins_.sameBins(bins) && rules_ == rules) return;
    bins_ = bins;
    rules_ = rules;
    const double width = bins.binWidth();
    gain_.assign(count, 1);
    ring_down_.clear();
    first_ = 0;
    while (first_ < count && bins.binStart(static_cast<double>(first_) + 1) <= rules.range_min * (1 + 1e-9)) ++first_;
    for (size_t k = 0; rules.spreads && k < count; ++k) {
        const double range = bins.binStart(static_cast<double>(k) + 0.5);
        gain_[k] = range * range * std::exp(std::min(2 * per_db * rules.loss_db_per_m * range, 600.0));
    }
    for (size_t k = 0; k < count && width > 0; ++k) {
        const double from = bins.binStart(static_cast<double>(k)), received = ringDown(rules, from, from + width);
        if (!(static_cast<float>(received) > 0)) break;
        // Below the least normal float a bin has no digits left, and may be any multiple of the ring-down.
        ring_down_.push_back(std::max(received, static_cast<double>(std::numeric_limits<float>::min())));
    }
}

}  // namespace insonify::types
