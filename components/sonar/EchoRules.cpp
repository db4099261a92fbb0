#include "components/sonar/EchoRules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/Interface.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

void tabulateElevation(const RenderPlan& plan, EchoRules& rules) {
    rules.elevation_reach = std::sin(types::radians(plan.sampled.beam_height_deg) / 2);
    for (int i = 0; i <= ELEVATION_STEPS; ++i) {
        const double sine = rules.elevation_reach * (2.0 * i / ELEVATION_STEPS - 1);
        rules.elevation_powers.push_back(plan.directivity->elevation(std::asin(sine)));
    }
}

}  // namespace

EchoRules makeEchoRules(const RenderPlan& plan, const types::Geometry& geometry) {
    const BinGrid& bins = plan.grid;
    EchoRules rules;
    rules.features = plan.features;
    rules.bins = bins;
    rules.attenuation = makeAbsorption(plan.config).amplitudeNepersPerMetre();
    rules.strength_scale = strengthScale(plan.sampled, bins, loudest(geometry));
    const double nearest = bins.range_min > 0 ? 1 / bins.range_min : std::numeric_limits<double>::max();
    for (int k = 0; k <= bins.bin_count; ++k)
        rules.edges.push_back(k == 0 ? nearest : std::min(nearest, 1 / bins.edge(k)));
    for (int k = 0; k < bins.bin_count; ++k) rules.middles.push_back(bins.centre(k));
    rules.edges.resize(rules.edges.size() + bins_at_once);
    rules.middles.resize(rules.middles.size() + bins_at_once);
    if (rules.features.has(Feature::ElevationPattern)) tabulateElevation(plan, rules);
    return rules;
}

double loudest(const types::Geometry& geometry) {
    double strongest = 0;
    for (const types::Material& material : geometry.materials)
        strongest = std::max(strongest, std::pow(10.0, material.lambert_db / 10.0));
    return strongest;
}

double strengthScale(const SonarConfig& config, const BinGrid& bins, double loudest) {
    constexpr double most = 1048576, max_sum = 8 * most;  // of one deposit, and of a bin: half of 64 bits
    if (config.model != Model::Physical) return 1;        // S and its weights are at most 1
    const double ratio =
        std::max(1.5, 0.5 * bins.bin_width / std::max(bins.range_min, 1e-3));  // of a bin's middle to its ranges
    const double strongest = loudest * ratio * ratio;
    const double pixels = static_cast<double>(config.samples_per_pixel * config.rows()) * (config.columnsPerBeam() + 2);
    return std::exp2(-std::ceil(std::max(0.0, std::log2(strongest * std::max(1 / most, pixels / max_sum)))));
}

}  // namespace insonify::sonar
