#include "components/sonar/echo/Detection.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace insonify::sonar {
namespace {

double shareOf(double level_db) { return std::pow(10, level_db / 10); }

std::span<const float> binsOf(const types::Sonar& ping, uint32_t beam) {
    return std::span(ping.bins).subspan(size_t{beam} * ping.bin_count, ping.bin_count);
}

/** Returns the strongest bin; unknown bins count as silent. */
double strongestOf(const std::vector<float>& bins) {
    double strongest = 0;
    for (const float bin : bins) strongest = std::max(strongest, bin > 0 ? static_cast<double>(bin) : 0);
    return strongest;
}

}  // namespace

Detector::Detector(const DetectionConfig& config, const types::Sonar& ping)
    : ping_(ping),
      bin_width_(ping.binWidth()),
      minimum_(std::max(strongestOf(ping.bins) * shareOf(config.threshold_db),
                        config.floor_db ? shareOf(*config.floor_db) : 0)),
      gate_share_(shareOf(-config.gate_db)) {}

std::optional<Detection> Detector::strongest(uint32_t beam) const {
    const std::span<const float> bins = binsOf(ping_, beam);
    const auto weaker = [](float a, float b) { return !(a >= b) && !std::isnan(b); };
    const auto peak = std::max_element(bins.begin(), bins.end(), weaker);
    if (peak == bins.end() || !(*peak > 0) || *peak < minimum_) return std::nullopt;
    const double gate = *peak * gate_share_;
    auto from = peak, to = peak + 1;
    while (from != bins.begin() && *(from - 1) >= gate) --from;
    while (to != bins.end() && *to >= gate) ++to;
    double sum = 0, moment = 0;
    for (auto bin = from; bin != to; ++bin) {
        const double at = static_cast<double>(bin - bins.begin()) + 0.5, weight = static_cast<double>(*bin) * at * at;
        sum += weight;
        moment += weight * at;
    }
    return Detection{moment / sum * bin_width_, *peak, static_cast<size_t>(peak - bins.begin())};
}

std::optional<Detection> Detector::first(uint32_t beam) const {
    const std::span<const float> bins = binsOf(ping_, beam);
    const auto found = std::find_if(bins.begin(), bins.end(), [this](float bin) { return bin > 0 && bin >= minimum_; });
    if (found == bins.end()) return std::nullopt;
    return Detection{(static_cast<double>(found - bins.begin()) + 0.5) * bin_width_, *found,
                     static_cast<size_t>(found - bins.begin())};
}

}  // namespace insonify::sonar
