#include "components/sonar/plan/EchoRules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Check.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Min range cells within the resolution [1]. */
constexpr double parts_of_resolution = 4;
/** Min scatterers of the scene per lattice scatterer: with fewer, too much depends on single squares [1]. */
constexpr double min_shape = 0.01;
constexpr int lowest_level = -60, highest_level = 40;

acoustics::Pulse makePulse(const RenderPlan& plan) {
    return acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound);
}

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
    const auto computeWidth = [](const Beam& cell) { return cell.high - cell.low; };
    const double middle = computeWidth(plan.cells[plan.cells.size() / 2]);
    return plan.has(Pass::Beamform) ? computeWidth(*std::ranges::max_element(plan.cells, {}, computeWidth)) / middle
                                    : 1;
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

double beamWidth(const RenderPlan& plan) {
    if (plan.has(Pass::Beamform)) return plan.directivity->halfPowerAzimuth();
    const auto computeWidth = [](const Beam& beam) { return beam.high - beam.low; };
    return computeWidth(*std::ranges::min_element(plan.beams, {}, computeWidth));
}

double rangeResolution(const RenderPlan& plan) {
    return plan.has(Pass::Pulse) ? makePulse(plan).resolution() : plan.grid.bin_width;
}

FieldSampling fieldSampling(const RenderPlan& plan) {
    if (!plan.features.has(Feature::Speckle) || !plan.has(Pass::Pulse)) return {};
    const double cells = plan.grid.bin_width / rangeResolution(plan);
    const int samples = std::max(1, static_cast<int>(std::ceil(cells - 0.25)));
    const int half = static_cast<int>(std::ceil((parts_of_resolution * cells / samples - 1) / 2));
    return {samples, samples * (2 * std::max(0, half) + 1)};
}

std::vector<LatticeLevel> scattererLattice(const RenderPlan& plan) {
    if (!plan.features.has(Feature::Speckle)) return {};
    const SpeckleConfig& speckle = *plan.config.speckle;
    const double density = speckle.scatterers_per_m2.value_or(0);
    // A side-scan is a fan across its track: along the track, its beam is narrower than the fan's.
    const double width = std::min(beamWidth(plan), types::radians(plan.config.beam_height_deg));
    const double area_per_metre = width * rangeResolution(plan) / speckle.scatterers_per_cell;
    std::vector<LatticeLevel> levels;
    for (int level = lowest_level; level <= highest_level; ++level) {
        const double square = std::exp2(level);  // [m^2]
        const double end = 2 * square / area_per_metre;
        const bool too_fine = end <= plan.grid.range_min || (density > 0 && density * square < min_shape);
        if (level < highest_level && too_fine) continue;
        levels.push_back({end, std::sqrt(square), density * square, static_cast<uint32_t>(level - lowest_level)});
        if (end >= plan.grid.range_max) break;
    }
    levels.back().range_end = std::max(levels.back().range_end, 2 * plan.grid.range_max);
    return levels;
}

EchoRules makeEchoRules(const RenderPlan& plan, const PingEffects& effects) {
    const BinGrid& bins = plan.summed;
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
    INSONIFY_CHECK(rules.strength_scale > 0 && rules.strength_scale <= 1, rules.strength_scale);
    INSONIFY_CHECK(std::is_sorted(rules.edges.rbegin(), rules.edges.rend()), rules.edges.front(), rules.edges.size());
    return rules;
}

EchoRules makeEnergyRules(RenderPlan plan, const PingEffects& effects) {
    plan.features = plan.features.without(Feature::Speckle);
    plan.summed = plan.grid;
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
