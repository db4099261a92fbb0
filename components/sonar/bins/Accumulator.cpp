#include "components/sonar/bins/Accumulator.hpp"

#include <cmath>

#include "components/sonar/bins/EchoField.hpp"
#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {

BinLevels::BinLevels(const SonarConfig& config, const BinGrid& grid)
    : factor_(static_cast<size_t>(grid.bin_count), 1.0) {
    if (config.model == Model::Cerqueira2017) return;
    const acoustics::Absorption absorption = makeAbsorption(config);
    loss_ = absorption.db_per_m * std::log(10.0) / 10;
    for (int j = 0; j < grid.bin_count; ++j) {
        const double r = grid.centre(j);
        factor_[static_cast<size_t>(j)] = std::pow(10, (-20 * std::log10(r) - 2 * absorption.db_per_m * r) / 10);
    }
}

bool BinLevels::fill(const EchoRules& rules, const uint64_t* sums, double solid_angle, std::span<float> bins) const {
    INSONIFY_CHECK(bins.size() <= factor_.size(), bins.size(), factor_.size());
    INSONIFY_CHECK(solid_angle > 0 && std::isfinite(solid_angle), solid_angle);
    const double quantum = solid_angle / (quanta_per_unit * rules.strength_scale);
    const bool physical = rules.features.has(Feature::Physical);
    uint64_t any = 0;
    for (size_t j = 0; j < bins.size(); ++j) {
        const uint64_t sum = sums[j * rules.channels()];
        any |= sum;
        if (physical) {
            bins[j] = intensity(j, static_cast<double>(sum) * quantum);
        } else {
            const uint64_t weight = sums[2 * j + 1];
            bins[j] = intensity(j, weight ? static_cast<double>(sum) / static_cast<double>(weight) : 0);
        }
    }
    INSONIFY_CHECK(any >> 63 == 0, any);  // strengthScale() leaves half of 64 bits
    return any != 0;
}

Accumulator::Accumulator(const RenderPlan& plan) : levels_(plan.config, plan.summed) {}

std::unique_ptr<Accumulator> makeAccumulator(const RenderPlan& plan, int threads) {
    if (plan.sumsFields()) return std::make_unique<EchoField>(plan, threads);
    return std::make_unique<EchoGrid>(plan, threads);
}

}  // namespace insonify::sonar
