#include "components/sonar/Volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sonar/CellDeposit.hpp"
#include "components/sonar/Estimators.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double no_strength_db = -200;

/** Backscattering strength as a number [1/m]; 0 at its least. */
double strengthOf(const VolumeLayer& layer) {
    return *layer.strength_db <= no_strength_db ? 0 : std::pow(10, *layer.strength_db / 10);
}

double strongest(const SonarConfig& config) {
    double most = 0;
    for (const VolumeLayer& layer : config.volume) most = std::max(most, strengthOf(layer));
    return most;
}

double azimuthBetween(const SonarConfig& config, const Beam& cell, double elevation) {
    if (config.beam_geometry == BeamGeometry::Planar) return cell.high - cell.low;
    return coneAzimuth(cell.high, elevation) - coneAzimuth(cell.low, elevation);
}

/** Where shaders/volume.glsl adds what cells hide of the volume, or let hear of its layers. */
struct VolumeChanges {
    VolumeChanges(const EchoRules& rules, double height, uint64_t* all_sums)
        : changes(all_sums + rules.volumeOffset()),
          beam_sums(rules.sumCount()),
          bin_count(static_cast<uint>(rules.bins.bin_count)),
          bin_width(rules.bins.bin_width),
          numbers(rules.layers.data()),
          layer_count(static_cast<uint>(rules.layers.size() / 3)),
          sonar_height(height) {}

    void addVolume(uint beam, uint bin, double amount) const {
        changes[beam * beam_sums + bin] +=
            static_cast<uint64_t>(static_cast<int64_t>(amount * quanta_per_unit + (amount < 0 ? -0.5 : 0.5)));
    }
    double layerNumber(uint i) const { return numbers[i]; }

    uint64_t* changes;
    size_t beam_sums;
    uint bin_count;
    double bin_width;
    const double* numbers;
    uint layer_count;
    double sonar_height;
};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // layers alone ask how steep a ray is
struct OpenVolume : VolumeChanges {
    static constexpr bool hears_misses = false;
    using VolumeChanges::VolumeChanges;
#include "shaders/volume.glsl"
};
#pragma GCC diagnostic pop
#define HAVE_VOLUME_LAYERS
struct LayeredVolume : VolumeChanges {
    static constexpr bool hears_misses = true;
    using VolumeChanges::VolumeChanges;
#include "shaders/volume.glsl"
};
#undef HAVE_VOLUME_LAYERS

/** Metres up in the world for each metre along the middle of cell i. */
double riseOf(const WaterView& water, const Cells& cells, int i) {
    return cells.cos_el[i] * (water.up.x * cells.cos_az[i] + water.up.y * cells.sin_az[i]) +
           water.up.z * cells.sin_el[i];
}

template <class Volume>
void hideVolumeBy(const EchoRules& rules, const WaterView& water, const Cells& cells, const Covered& covered,
                  const EchoSums& to) {
    Volume volume(rules, water.height, to.sums);
    for (int i = 0; i < cells.count; ++i) {
        const auto beam = static_cast<uint>(cells.beam[i] - to.first_beam);
        if (covered.pixel[i] > 0)
            volume.hideVolume(footprintOf(covered, i), beam, riseOf(water, cells, i), cells.size[i]);
        else if constexpr (Volume::hears_misses)
            volume.hearLayers(beam, riseOf(water, cells, i), rules.bins.range_max, cells.size[i]);
    }
}

}  // namespace

void hideVolume(const EchoRules& rules, const WaterView& water, const Cells& cells, const Covered& covered,
                const EchoSums& to) {
    if (rules.features.has(Feature::VolumeLayers))
        hideVolumeBy<LayeredVolume>(rules, water, cells, covered, to);
    else
        hideVolumeBy<OpenVolume>(rules, water, cells, covered, to);
}

WaterView waterViewOf(const types::Snapshot& snapshot) {
    const glm::dvec3 up = glm::inverse(glm::normalize(snapshot.sonar.orientation)) * glm::dvec3(0, 0, 1);
    return {up, snapshot.sonar.position.z - snapshot.water_surface.value_or(0)};
}

glm::dvec3 upwardIn(const ViewFrustum& frustum, const WaterView& water) {
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
    return {cosine * water.up.x + sine * water.up.y, cosine * water.up.y - sine * water.up.x, water.up.z};
}

std::vector<double> layersOf(const SonarConfig& config) {
    if (!config.hasLayers()) return {};
    const double most = strongest(config);
    std::vector<double> layers;
    for (const VolumeLayer& layer : config.volume) {
        constexpr double far = 1e9;
        layers.push_back(layer.bottom_m ? -*layer.bottom_m : -far);
        layers.push_back(layer.top_m ? -*layer.top_m : far);
        layers.push_back(most > 0 ? strengthOf(layer) / most : 0);
    }
    return layers;
}

std::vector<double> openSolidAngles(const RenderPlan& plan) {
    constexpr int steps = 2048;
    const double half = types::radians(plan.sampled.beam_height_deg) / 2, step = 2 * half / steps;
    std::vector<double> all(plan.cells.size(), 0.0);
    for (int i = 0; i < steps; ++i) {
        const double elevation = (i + 0.5) * step - half;
        const bool weighted = plan.features.has(Feature::ElevationPattern);
        const double part = std::cos(elevation) * step * (weighted ? plan.directivity->elevation(elevation) : 1);
        for (size_t k = 0; k < all.size(); ++k) all[k] += part * azimuthBetween(plan.sampled, plan.cells[k], elevation);
    }
    return all;
}

VolumeLevels::VolumeLevels(const RenderPlan& plan, const BinGrid& grid) : open_(plan.cells.size(), 0.0) {
    if (!plan.features.has(Feature::VolumeLayers)) open_ = openSolidAngles(plan);
    const double strength = strongest(plan.config), beta = makeAbsorption(plan.config).intensityPerMetre();
    const double nearest = std::max(grid.range_min, grid.bin_width / 4);
    for (int j = 0; j < grid.bin_count; ++j) {
        const double from = std::max(grid.edge(j), nearest), to = std::max(grid.edge(j + 1), from);
        intensity_.push_back(strength * (1 / from - 1 / to) * std::exp(-beta * grid.centre(j)));
    }
}

void VolumeLevels::add(const uint64_t* changes, size_t cell, double unit, std::span<float> bins) const {
    const double quantum = unit / quanta_per_unit;
    uint64_t sum = 0;
    for (size_t j = 0; j < bins.size(); ++j) {
        sum += changes[j];
        const double heard = std::max(0.0, open_[cell] + static_cast<double>(static_cast<int64_t>(sum)) * quantum);
        bins[j] = static_cast<float>(
            std::min(double{bins[j]} + intensity_[j] * heard, double{std::numeric_limits<float>::max()}));
    }
}

}  // namespace insonify::sonar
