#include "components/sonar/plan/ScattererLattice.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/beams/RangeResponse.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Min range cells within the resolution [1]. */
constexpr double parts_of_resolution = 4;
/** Min scatterers of the scene per lattice scatterer: with fewer, too much depends on single squares [1]. */
constexpr double min_shape = 0.01;
constexpr int lowest_level = -60, highest_level = 40;

acoustics::Pulse pulseOf(const RenderPlan& plan) {
    return acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound);
}

}  // namespace

double beamWidth(const RenderPlan& plan) {
    if (plan.has(Pass::Beamform)) return plan.directivity->halfPowerAzimuth();
    const auto widthOf = [](const Beam& beam) { return beam.high - beam.low; };
    return widthOf(*std::ranges::min_element(plan.beams, {}, widthOf));
}

double rangeResolution(const RenderPlan& plan) {
    return plan.has(Pass::Pulse) ? pulseOf(plan).resolution() : plan.grid.bin_width;
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

}  // namespace insonify::sonar
