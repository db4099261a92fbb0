#include "components/sonar/bins/Accumulator.hpp"

#include <cmath>

#include "components/sonar/bins/EchoField.hpp"
#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Fills bins from sums below 2^63, for which there is an instruction, as intensity() does. Returns all sums, by or. */
INSONIFY_VECTOR_CLONES uint64_t fillEnergies(const uint64_t* sums, const double* factors, double quantum,
                                             float* __restrict bins, size_t count) {
    constexpr double maximum = static_cast<double>(std::numeric_limits<float>::max());
    uint64_t any = 0;
    for (size_t j = 0; j < count; ++j) {
        any |= sums[j];
        const double level = static_cast<double>(static_cast<int64_t>(sums[j])) * quantum * factors[j];
        bins[j] = static_cast<float>(level > 0 ? (level < maximum ? level : maximum) : 0);
    }
    return any;
}

}  // namespace

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
    uint64_t any = 0;
    if (rules.features.has(Feature::Physical)) {
        any = fillEnergies(sums, factor_.data(), quantum, bins.data(), bins.size());
    } else {
        for (size_t j = 0; j < bins.size(); ++j) {
            const uint64_t sum = sums[2 * j], weight = sums[2 * j + 1];
            any |= sum;
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
