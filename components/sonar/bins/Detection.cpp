#include "components/sonar/bins/Detection.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/plan/Effect.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

/** Min ratio of a return to the water's mean echo: of fields, whose squares exceed their mean by so much once in 5e8
 *  bins, and of energies [1]. */
constexpr double above_fields = 20, above_water = 2;

double computeShare(double level_db) { return std::pow(10, level_db / 10); }

}  // namespace

DetectionRules DetectionRules::of(const RenderPlan& plan) {
    DetectionRules rules{makeReturnRules(plan.config), {}};
    const double margin = plan.sumsFields() ? above_fields : above_water;
    for (const Effect* effect : plan.effects) {
        const std::vector<float> water = effect->withoutSurfaces(plan);
        rules.water.resize(std::max(rules.water.size(), water.size()));
        for (size_t i = 0; i < water.size(); ++i) rules.water[i] += water[i] * static_cast<float>(margin);
    }
    return rules;
}

void Detector::take(const types::Sonar& ping, const DetectionConfig& config, const DetectionRules& rules) {
    INSONIFY_CHECK(ping.bins.size() == size_t{ping.beam_count} * ping.bin_count, ping.bins.size(), ping.beam_count,
                   ping.bin_count);
    INSONIFY_CHECK(rules.water.empty() || rules.water.size() == ping.bins.size(), rules.water.size());
    ping_ = &ping;
    gate_share_ = computeShare(-config.gate_db);
    tables_.take(ping, ping.bin_count, rules.returns);
    range_min_ = rules.returns.range_min;
    levels_.resize(ping.bins.size());
    double strongest = 0;
    for (size_t i = 0, k = 0; i < levels_.size(); ++i, k = k + 1 < ping.bin_count ? k + 1 : 0) {
        const double level = tables_.at(k, static_cast<double>(ping.bins[i]));
        const bool is_water = i < rules.water.size() && level <= static_cast<double>(rules.water[i]) * tables_.gain(k);
        levels_[i] = is_water ? 0 : level;
        strongest = std::max(strongest, levels_[i]);
    }
    minimum_ = std::max(strongest * computeShare(config.threshold_db), std::numeric_limits<double>::min());
    if (!config.floor_db) return;
    for (size_t i = 0; i < levels_.size(); ++i)
        if (static_cast<double>(ping.bins[i]) < computeShare(*config.floor_db)) levels_[i] = 0;
}

Detection Detector::at(uint32_t beam, double place, size_t bin) const {
    INSONIFY_CHECK(beam < ping_->beam_count && bin < ping_->bin_count, beam, bin, ping_->beam_count, ping_->bin_count);
    const size_t at = size_t{beam} * ping_->bin_count + bin;
    return {std::max(place * ping_->binWidth(), range_min_), ping_->bins[at], levels_[at], bin};
}

std::optional<Detection> Detector::strongest(uint32_t beam) const {
    const auto begin = levels_.begin() + static_cast<std::ptrdiff_t>(size_t{beam} * ping_->bin_count),
               end = begin + static_cast<std::ptrdiff_t>(ping_->bin_count);
    const auto peak = std::max_element(begin, end);
    if (peak == end || *peak < minimum_) return std::nullopt;
    const double gate = *peak * gate_share_;
    auto from = peak, to = peak + 1;
    while (from != begin && *(from - 1) >= gate) --from;
    while (to != end && *to >= gate) ++to;
    double sum = 0, moment = 0;
    for (auto bin = from; bin != to; ++bin) {
        const auto k = static_cast<size_t>(bin - begin);
        const double place = static_cast<double>(k) + 0.5, weight = *bin / tables_.gain(k) * place * place;
        sum += weight;
        moment += weight * place;
    }
    return at(beam, moment / sum, static_cast<size_t>(peak - begin));
}

std::optional<Detection> Detector::first(uint32_t beam) const {
    for (size_t k = 0; k < ping_->bin_count; ++k)
        if (levels_[size_t{beam} * ping_->bin_count + k] >= minimum_) return at(beam, static_cast<double>(k) + 0.5, k);
    return std::nullopt;
}

}  // namespace insonify::sonar
