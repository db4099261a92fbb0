#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/bins/EchoGrid.hpp"
#include "components/sonar/bins/Estimators.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double no_strength_db = -200;
constexpr size_t max_layers = 16;

/** Backscattering strength as a number [1/m]; 0 at its min. */
double computeStrength(const VolumeLayer& layer) {
    return *layer.strength_db <= no_strength_db ? 0 : std::pow(10, *layer.strength_db / 10);
}

std::string clear(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "strength_db is -200: no scatterers"; }

double strongest(const SonarConfig& config) {
    double maximum = 0;
    for (const VolumeLayer& layer : config.volume) maximum = std::max(maximum, computeStrength(layer));
    return maximum;
}

double azimuthBetween(const SonarConfig& config, const Beam& cell, double elevation) {
    if (config.beam_geometry == BeamGeometry::Planar) return cell.high - cell.low;
    return coneAzimuth(cell.high, elevation) - coneAzimuth(cell.low, elevation);
}

/** Input of shaders/volume.glsl. */
struct VolumeNumbers {
    explicit VolumeNumbers(const CellBatch& batch)
        : bin_count(static_cast<uint>(batch.rules.bins.bin_count)),
          bin_width(batch.rules.bins.bin_width),
          numbers(batch.rules.layers.data()),
          layer_count(static_cast<uint>(batch.rules.layers.size() / 3)),
          sonar_height(batch.water.height) {}
    double layerNumber(uint i) const { return numbers[i]; }

    uint bin_count;
    double bin_width;
    const double* numbers;
    uint layer_count;
    double sonar_height;  ///< Above the surface [m].
};
struct OpenVolume : VolumeNumbers {
    static constexpr bool has_layers = false;
    using VolumeNumbers::VolumeNumbers;
#include "shaders/volume.glsl"
};
#define HAVE_VOLUME_LAYERS
struct LayeredVolume : VolumeNumbers {
    static constexpr bool has_layers = true;
    using VolumeNumbers::VolumeNumbers;
#include "shaders/volume.glsl"
};
#undef HAVE_VOLUME_LAYERS

/** Returns the metres up in the world per metre along the middle of cell i. */
double rise(const WaterView& water, const Cells& cells, int i) {
    return cells.cos_el[i] * (water.up.x * cells.cos_az[i] + water.up.y * cells.sin_az[i]) +
           water.up.z * cells.sin_el[i];
}

/** Ends of the rays of a batch, one in each cell: at the surface, or for a miss at the max range. */
struct RayEnds {
    double parts[Cells::capacity];  ///< Ends of the cell [1].
    double rise[Cells::capacity], range[Cells::capacity], size[Cells::capacity];
};

/** Adds changes of the water, one of each cell, to the sums. */
class WaterChanges {
public:
    explicit WaterChanges(const CellBatch& batch) : batch_(batch) {}

    /** Changes the water from a range on, which is the cell's. */
    template <class Water>
    void add(Water& water, const double* ranges, const double* amounts) {
        const int count = batch_.cells.count;
        uint bins[Cells::capacity];
        int64_t here[Cells::capacity], behind[Cells::capacity];
        for (int i = 0; i < count; ++i) {
            const auto change = water.volumeChange(ranges[i], amounts[i]);
            bins[i] = amounts[i] != 0 ? change.bin : water.bin_count;
            here[i] = getQuanta(change.here);
            behind[i] = getQuanta(change.behind);
        }
        for (int i = 0; i < count; ++i) {
            if (bins[i] >= water.bin_count) continue;
            const auto beam = static_cast<size_t>(batch_.cells.beam[i] - batch_.first_beam);
            uint64_t* const sums = batch_.own + beam * batch_.beam_stride + bins[i];
            sums[0] += static_cast<uint64_t>(here[i]);
            if constexpr (Water::has_layers) sums[1] += static_cast<uint64_t>(behind[i]);
        }
    }

private:
    static int64_t getQuanta(double amount) {
        return static_cast<int64_t>(amount * quanta_per_unit + (amount < 0 ? -0.5 : 0.5));
    }

    const CellBatch& batch_;
};

/** Ends the water behind the surfaces of a batch, or adds its layers before them. */
template <class Water>
void changeWater(const CellBatch& batch) {
    const Cells& cells = batch.cells;
    Water water(batch);
    WaterChanges changes(batch);
    RayEnds ends;
    constexpr double of_a_miss = Water::has_layers ? 1 : 0;
    const double range_max = batch.rules.bins.range_max;
    for (int i = 0; i < cells.count; ++i) {
        const double parts = water.countVolumeParts(getFootprint(batch.covered, i));
        ends.parts[i] = batch.covered.pixel[i] > 0 ? parts : of_a_miss;
        ends.rise[i] = rise(batch.water, cells, i);
    }
    const double max_parts = cells.count > 0 ? *std::max_element(ends.parts, ends.parts + cells.count) : 0;
    for (double part = 0; part < max_parts; ++part) {
        for (int i = 0; i < cells.count; ++i) {
            const double inverse = water.inverseAtPart(getFootprint(batch.covered, i), part, ends.parts[i]);
            const bool is_miss = !(batch.covered.pixel[i] > 0);
            const bool ends_ray = (part < ends.parts[i]) & (is_miss | (inverse > 0));
            ends.range[i] = is_miss ? range_max : 1 / inverse;
            const double size = cells.size[i] / ends.parts[i];
            ends.size[i] = ends_ray ? size : 0;
        }
        if constexpr (Water::has_layers) {
            for (uint layer = 0; layer < water.layer_count; ++layer) {
                double enters[Cells::capacity], leaves[Cells::capacity], amounts[Cells::capacity];
                const double share = water.layerNumber(3 * layer + 2);
                for (int i = 0; i < cells.count; ++i) {
                    const auto ray = water.layerStretch(layer, ends.rise[i], ends.range[i]);
                    enters[i] = ray.enters, leaves[i] = ray.leaves;
                    amounts[i] = ray.enters < ray.leaves ? ends.size[i] * share : 0;
                }
                changes.add(water, enters, amounts);
                for (int i = 0; i < cells.count; ++i) amounts[i] = -amounts[i];
                changes.add(water, leaves, amounts);
            }
        } else {
            for (int i = 0; i < cells.count; ++i) ends.size[i] = -ends.size[i];
            changes.add(water, ends.range, ends.size);
        }
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void changeOpenWater(const CellBatch& batch) {
    changeWater<OpenVolume>(batch);
}
INSONIFY_VECTOR_CLONES __attribute__((flatten)) void changeLayeredWater(const CellBatch& batch) {
    changeWater<LayeredVolume>(batch);
}

/** Returns the layers of a configuration as in EchoRules::layers; empty where a layer has no bounds. */
std::vector<double> getLayers(const SonarConfig& config) {
    if (!config.hasLayers()) return {};
    const double maximum = strongest(config);
    std::vector<double> layers;
    for (const VolumeLayer& layer : config.volume) {
        constexpr double far = 1e9;
        layers.push_back(layer.bottom_m ? -*layer.bottom_m : -far);
        layers.push_back(layer.top_m ? -*layer.top_m : far);
        layers.push_back(maximum > 0 ? computeStrength(layer) / maximum : 0);
    }
    return layers;
}

/** Solid angle of each of a plan's azimuth cells within its aperture, weighted by the pattern in elevation [sr]. */
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

/** Returns the water's intensity in bin j for a steradian and no absorption [1/sr]. */
double waterBetween(const BinGrid& grid, int j, double strength) {
    const double nearest = std::max(grid.range_min, grid.bin_width / 4);
    const double from = std::max(grid.edge(j), nearest), to = std::max(grid.edge(j + 1), from);
    return strength * (1 / from - 1 / to);
}

/** Intensity of the water itself, from the solid angle that receives its echo. */
class VolumeInPings final : public PingEffect {
public:
    explicit VolumeInPings(const RenderPlan& plan) : plan_(plan), layers_(getLayers(plan.config)) { updateQuality(); }

    void updateQuality() override;
    void giveRules(EchoRules& rules) const override { rules.layers = layers_; }
    bool hasSums() const override { return true; }
    bool isOnDevice() const override { return true; }
    void addCells(const CellBatch& batch) const override {
        layers_.empty() ? changeOpenWater(batch) : changeLayeredWater(batch);
    }
    void addToCell(const uint64_t* changes, size_t cell, double unit, std::span<float> bins) const override;

private:
    const RenderPlan& plan_;
    std::vector<double> layers_;
    std::vector<double> open_;  ///< Solid angle of each cell without obstacles [sr]; 0 with layers, whose cells add it.
    std::vector<double> intensity_;  ///< Intensity of each bin for a steradian [1/sr].
};

void VolumeInPings::updateQuality() {
    const BinGrid& grid = plan_.summed;
    open_.assign(plan_.cells.size(), 0.0);
    if (layers_.empty()) open_ = openSolidAngles(plan_);
    const double strength = strongest(plan_.config), beta = makeAbsorption(plan_.config).intensityPerMetre();
    intensity_.clear();
    for (int j = 0; j < grid.bin_count; ++j)
        intensity_.push_back(waterBetween(grid, j, strength) * std::exp(-beta * grid.centre(j)));
}

/** Adds intensities times received solid angles, `open` plus whole quanta, to bins. */
INSONIFY_VECTOR_CLONES void addReceived(const int64_t* sums, double quantum, double open, const double* intensities,
                                        float* __restrict bins, size_t count) {
    constexpr double loudest = std::numeric_limits<float>::max();
    for (size_t j = 0; j < count; ++j) {
        const double received = open + static_cast<double>(sums[j]) * quantum;
        const double sum = double{bins[j]} + intensities[j] * (received > 0 ? received : 0);
        bins[j] = static_cast<float>(sum < loudest ? sum : loudest);
    }
}

void VolumeInPings::addToCell(const uint64_t* changes, size_t cell, double unit, std::span<float> bins) const {
    std::array<int64_t, 256> sums;
    uint64_t sum = 0;
    for (size_t from = 0; from < bins.size(); from += sums.size()) {
        const size_t count = std::min(sums.size(), bins.size() - from);
        for (size_t j = 0; j < count; ++j) sums[j] = static_cast<int64_t>(sum += changes[from + j]);
        addReceived(sums.data(), unit / quanta_per_unit, open_[cell], &intensity_[from], &bins[from], count);
    }
}

/** Returns the intensities of the water alone, all of it as strong as its strongest layer. */
std::vector<float> openWater(const RenderPlan& plan) {
    const double strength = strongest(plan.config), beta = makeAbsorption(plan.config).intensityPerMetre();
    const std::vector<double> open = openSolidAngles(plan);
    types::Sonar ping;
    ping.resize(static_cast<uint32_t>(plan.grid.bin_count), static_cast<uint32_t>(plan.beams.size()));
    EchoGrid grid(plan, 1);
    grid.begin({}, ping);
    for (size_t cell = 0; cell < open.size(); ++cell) {
        const std::span<float> bins = grid.energies(cell, 0);
        for (int j = 0; j < plan.grid.bin_count; ++j) {
            const double of_steradian = waterBetween(plan.grid, j, strength) * std::exp(-beta * plan.grid.centre(j));
            bins[static_cast<size_t>(j)] = static_cast<float>(open[cell] * of_steradian);
        }
    }
    ThreadPool alone(1);
    grid.finish(alone);
    plan.beams.toTableOrder(std::span(ping.bins), ping.bin_count);
    return ping.bins;
}

/** Volume reverberation (ACOUSTICS.md 3.9): echoes of the water, also in layers, without the part that cells hide. */
class Volume final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (config.model == Model::Cerqueira2017 && !config.volume.empty())
            diagnostics.push_back({"volume", "is given with model: cerqueira2017; it belongs to physical"});
        if (config.volume.size() > max_layers)
            diagnostics.push_back(
                {"volume", fmt::format("has {} layers; may have {}", config.volume.size(), max_layers)});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.config.volume.empty()) return leaveOut(plan, {"volume reverberation", Reason::NotConfigured});
        if (!(strongest(plan.config) > 0))
            return leaveOut(plan, {.effect = "volume reverberation", .reason = Reason::Other, .words = clear});
        plan.effect_features.emplace_back("volume");
        plan.echoes_from_misses = plan.config.hasLayers();
        if (plan.echoes_from_misses) plan.effect_features.emplace_back("volume_layers");
        plan.fills_water = true;
        return true;
    }
    std::vector<std::string> features() const override { return {"volume", "volume_layers"}; }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<VolumeInPings>(plan);
    }
    std::vector<float> withoutSurfaces(const RenderPlan& plan) const override { return openWater(plan); }
    std::string removeFrom(SonarConfig& config) const override {
        if (config.volume.empty()) return {};
        config.volume.clear();
        return "volume reverberation";
    }
};

}  // namespace

void VolumeLayer::check(types::Diagnostics& diagnostics) const {
    if (!strength_db)
        diagnostics.push_back({"", "has no strength_db; open sea has -90 to -70, plumes of sediment -50"});
    if (top_m && bottom_m && !(*top_m < *bottom_m))
        diagnostics.push_back(
            {"bottom_m", fmt::format("is {:g}, not below top_m, {:g}; depths grow downwards", *bottom_m, *top_m)});
}

const Effect& volume() { return only<Volume>(); }

}  // namespace insonify::sonar
