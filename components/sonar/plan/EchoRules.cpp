#include "components/sonar/plan/EchoRules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/sonar/plan/Effects.hpp"
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

/** Returns the min width of a sample [rad]: a quarter of the narrower of a row and a column, because images are finer
 *  at their edges. */
double minSample(const RenderPlan& plan) {
    const SonarConfig& config = plan.sampled;
    const double row = config.beam_height_deg / config.rows(), column = config.beamWidthDeg() / config.columnsPerBeam();
    return types::radians(std::min(row, column)) / 4;
}

/** Returns the max width of the azimuth cells relative to the middle cell [1]. */
double widestCell(const RenderPlan& plan) {
    const auto widthOf = [](const Beam& cell) { return cell.high - cell.low; };
    const double middle = widthOf(plan.cells[plan.cells.size() / 2]);
    return plan.has(Pass::Beamform) ? widthOf(*std::ranges::max_element(plan.cells, {}, widthOf)) / middle : 1;
}

/** Returns the number of a beam's samples that a lobe can fill: those in a circle of its slope, at eight places at
 *  once. */
double samplesOfLobe(const RenderPlan& plan, double samples) {
    double widest = 0;
    for (const MaterialRecord& record : plan.laws.records)
        if (record.law.y > 0) widest = std::max(widest, double{record.law.z});
    const double sample = minSample(plan);
    return std::min(samples, 8 * std::numbers::pi * (widest / (sample * sample) + 1));
}

}  // namespace

EchoRules makeEchoRules(const RenderPlan& plan, const PingEffects& effects) {
    const BinGrid bins = summedGrid(plan);
    EchoRules rules;
    rules.features = plan.features;
    rules.bins = bins;
    rules.attenuation = makeAbsorption(plan.config).amplitudeNepersPerMetre();
    rules.strength_scale = strengthScale(plan);
    rules.laws = plan.laws;
    rules.looks_down = plan.config.across_track;
    rules.echoes_from_misses = plan.echoes_from_misses;
    rules.has_maps = plan.has(Pass::SurfaceMaps);
    rules.lattice = scattererLattice(plan);
    rules.selection = plan.options.selection;
    if (plan.config.frequency_khz) rules.turns_per_metre = 2e3 * *plan.config.frequency_khz / bins.speed_of_sound;
    const double nearest = bins.range_min > 0 ? 1 / bins.range_min : std::numeric_limits<double>::max();
    for (int k = 0; k <= bins.bin_count; ++k)
        rules.edges.push_back(k == 0 ? nearest : std::min(nearest, 1 / bins.edge(k)));
    for (int k = 0; k < bins.bin_count; ++k) rules.middles.push_back(bins.centre(k));
    rules.edges.resize(rules.edges.size() + bins_at_once);
    rules.middles.resize(rules.middles.size() + bins_at_once);
    if (rules.features.has(Feature::ElevationPattern) && !plan.traces_rays) tabulateElevation(plan, rules);
    effects.giveRules(rules);
    return rules;
}

EchoRules makeEnergyRules(RenderPlan plan, const PingEffects& effects) {
    plan.features = plan.features.without(Feature::Speckle);
    return makeEchoRules(plan, effects);
}

double strengthScale(const RenderPlan& plan) {
    const SonarConfig& config = plan.sampled;
    const BinGrid& bins = plan.grid;
    constexpr double maximum = 1048576, max_sum = 8 * maximum;  // max of one deposit, and of a bin: half of 64 bits
    if (config.model != Model::Physical) return 1;              // S and its weights are at most 1
    const double ratio =
        std::max(1.5, 0.5 * bins.bin_width / std::max(bins.range_min, 1e-3));  // of a bin's middle to its ranges
    const double pixels =
        static_cast<double>(plan.options.samples_per_pixel * config.rows()) * (config.columnsPerBeam() + 2);
    const double lobe = plan.laws.loudestLobe(minSample(plan)), surface = plan.laws.loudest();
    const double strongest = std::max(surface, lobe), sum = surface * pixels + lobe * samplesOfLobe(plan, pixels);
    const double scale = ratio * ratio * widestCell(plan) * std::max(plan.max_map_strength, 1.0);
    return std::exp2(-std::ceil(std::max(0.0, std::log2(scale * std::max(strongest / maximum, sum / max_sum)))));
}

}  // namespace insonify::sonar
