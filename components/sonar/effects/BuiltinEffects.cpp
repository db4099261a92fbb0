#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr const char* inside_a_bin = "absorption inside a bin";

/** Returns an absorption that changes by `residual` to either side of a bin's middle, in decibels. */
double decibels(double residual) { return 10 * residual / std::numbers::ln10; }

std::string residualWords(const Omitted& what, const BinGrid& /*grid*/) {
    if (what.reason == Reason::BelowBound) return fmt::format("beta dR/2 = {:.1e} < {:.0e}", what.value, what.bound);
    return fmt::format("beta dR/2 = {:.1e}, {:.2g} dB to either side", what.value, decibels(what.value));
}

/** Absorption of sound in the water (ACOUSTICS.md 2.4): evaluated in the middle of each bin, in `cerqueira2017` at each
 *  sample. */
class Absorption final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.absorption) return leaveOut(plan, {"absorption", Reason::NotConfigured});
        const acoustics::Absorption absorption = makeAbsorption(plan.config);
        if (plan.config.model == Model::Cerqueira2017) {
            if (absorption.db_per_m > 0) plan.features.add(Feature::Absorption);
            return true;
        }
        const double residual = absorption.intensityPerMetre() * plan.grid.bin_width / 2;
        const Reason reason = residual < 1e-3 ? Reason::BelowBound : Reason::Approximated;
        plan.omitted.push_back({inside_a_bin, reason, residual, 1e-3, residualWords});
        return true;
    }
    void note(const RenderPlan& plan, const types::Geometry& /*geometry*/, types::Notices& notices) const override {
        const Omitted* inside = plan.findOmitted(inside_a_bin);
        if (inside && decibels(inside->value) > 0.1)
            notices.push_back(
                types::warning(fmt::format("absorption changes within a bin by {:.2g} dB to either side of its "
                                           "middle; it is taken in the middle",
                                           decibels(inside->value))));
    }
    void addTo(types::ReturnRules& rules, const SonarConfig& config) const override {
        rules.loss_db_per_m = makeAbsorption(config).db_per_m;
    }
    std::string removeFrom(SonarConfig& config) const override { return removeBlock(config.absorption, "absorption"); }
};

std::string means(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "cerqueira2017: bins are means of S(n.d)";
}
std::string scaledMeans(const Omitted& what, const BinGrid& grid) {
    return means(what, grid) + "; reflectivity scales n.d";
}
std::string oneBin(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "published: one bin per pixel"; }
std::string imageEdge(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "published: the image's edge, which is inside the aperture except straight ahead";
}
std::string oneBeam(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "published: every column belongs to one beam";
}
std::string fromZero(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "published: bins begin at range 0"; }

/** Model `cerqueira2017`: the effects that bins of means do not have, and with `published: true` the published
 *  simulator. */
class PublishedMeans final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.config.model != Model::Cerqueira2017) return false;
        const auto omit = [&](const char* effect, Omitted::Words words) {
            plan.omitted.push_back({.effect = effect, .reason = Reason::Other, .words = words});
        };
        omit("spreading", means);
        omit("backscatter by material", scaledMeans);
        if (!plan.config.published) return true;
        plan.features.add(Feature::Published);
        omit("range footprints", oneBin);
        omit("elevation mask", imageEdge);
        omit("shared columns", oneBeam);
        omit("near blanking", fromZero);
        return true;
    }
};

std::string lengthWords(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("the pulse resolves {:.2g} m, under half a bin, {:.2g} m", what.value, what.bound);
}

/** Checks that the band of a pulse does not reach below 0 Hz. */
void checkBand(const SonarConfig& config, types::Diagnostics& diagnostics) {
    if (!config.pulse || !config.frequency_khz) return;
    const double widest = 2 * *config.frequency_khz;
    if (const auto band = config.pulse->bandwidth_khz; band && *band > widest)
        diagnostics.push_back(
            {"pulse.bandwidth_khz", fmt::format("is {:g} kHz; a band about {:g} kHz may have {:g} kHz", *band,
                                                *config.frequency_khz, widest)});
}

/** Spread of an echo in range (ACOUSTICS.md 5.10). */
class PulseInRange final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (!config.pulse) return;
        if (config.model == Model::Cerqueira2017)
            diagnostics.push_back({"pulse", "is given with model: cerqueira2017; it belongs to physical"});
        if (config.pulse->chirp_us && !(config.motion_in_ping && config.frequency_khz))
            diagnostics.push_back(
                {"pulse.chirp_us", "is given without motion_in_ping: true and frequency_khz, both of which it needs"});
        checkBand(config, diagnostics);
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        constexpr const char* name = "range point-spread";
        if (!plan.config.pulse) return leaveOut(plan, {name, Reason::NotConfigured});
        const acoustics::Pulse pulse(*plan.config.pulse, plan.grid.speed_of_sound);
        if (isShort(pulse, plan.grid))
            return leaveOut(plan, {name, Reason::BelowBound, pulse.resolution(), plan.grid.bin_width / 2, lengthWords});
        plan.add(Pass::Pulse);
        return true;
    }
    std::string removeFrom(SonarConfig& config) const override { return removeBlock(config.pulse, "pulse"); }
};

/** The transmitter's ring-down in the first bins of every beam. */
class RingDownInPings final : public PingEffect {
public:
    explicit RingDownInPings(const RenderPlan& plan) {
        for (int k = 0; k < plan.grid.bin_count; ++k) {
            const double received = plan.config.pulse->ring_down->mean(plan.grid.edge(k), plan.grid.edge(k + 1));
            if (static_cast<float>(received) == 0) return;
            bins_.push_back(static_cast<float>(received));
        }
    }
    void addToBins(types::Sonar& ping) override {
        if (is_silent) return;
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            for (size_t k = 0; k < bins_.size(); ++k) ping.bins[beam * ping.bin_count + k] += bins_[k];
    }
    void addAlike(types::Sonar& bins) override { addToBins(bins); }

private:
    std::vector<float> bins_;  ///< The ring-down in the first bins of every beam.
};

/** The transmit ring-down (ACOUSTICS.md 5.15). */
class RingDown final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.pulse || !plan.config.pulse->ring_down)
            return leaveOut(plan, {"transmit ring-down", Reason::NotConfigured});
        plan.add(Pass::RingDown);
        return true;
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<RingDownInPings>(plan);
    }
    void addTo(types::ReturnRules& rules, const SonarConfig& config) const override {
        if (!config.pulse || !config.pulse->ring_down) return;
        rules.ring_down_db = *config.pulse->ring_down->level_db;
        rules.ring_down_db_per_m = *config.pulse->ring_down->decay_db_per_m;
    }
    std::string removeFrom(SonarConfig& config) const override {
        if (!config.pulse || !config.pulse->ring_down) return {};
        config.pulse->ring_down.reset();
        return "transmit ring-down";
    }
};

/** Echoes that interfere (ACOUSTICS.md 5.21): sums of cells are fields of scatterers. */
class Speckle final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (config.speckle && !config.speckle->coherent && config.speckle->scatterers_per_m2)
            diagnostics.push_back({"speckle.scatterers_per_m2", "is given without coherent: true, which it needs"});
        if (config.isCoherent() && !config.frequency_khz)
            diagnostics.push_back({"speckle", "is coherent without frequency_khz, which it needs"});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.isCoherent()) return leaveOut(plan, {"coherent speckle", Reason::NotConfigured});
        plan.features.add(Feature::Speckle);
        return true;
    }
};

std::string withoutShell(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has a shell"; }
std::string withoutFrequency(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no frequency_khz; shells let nothing through";
}
std::string withoutRays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "the scene is rasterised; sound passes through shells with `visibility: cpu`";
}
std::string onBentPaths(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "sound passes through shells on straight paths only; remove water.profile and motion_in_ping";
}
std::string withoutWalls(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "max_walls is 0"; }

/** Sound that passes through thin walls (ACOUSTICS.md 5.26). RayEchoes traces it. */
class ThinWalls final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        const bool has_shell =
            std::ranges::any_of(geometry.materials, [](const auto& one) { return one.shell.has_value(); });
        const auto omit = [&](Reason reason, Omitted::Words words) {
            return leaveOut(plan, {.effect = "thin walls", .reason = reason, .words = words});
        };
        if (!has_shell || plan.config.model != Model::Physical) return omit(Reason::NoneInScene, withoutShell);
        if (plan.config.max_walls == 0) return omit(Reason::Other, withoutWalls);
        if (!plan.config.frequency_khz) return omit(Reason::Lacking, withoutFrequency);
        if (!plan.traces_rays) return omit(Reason::Lacking, withoutRays);
        if (plan.profile || plan.config.motion_in_ping) return omit(Reason::Lacking, onBentPaths);
        if (!plan.laws.hasWalls()) return omit(Reason::NoneInScene, withoutShell);
        plan.add(Pass::Walls);
        plan.laws.separateReturns();
        return true;
    }
    /** Notes walls that are nearly transparent because of their thickness. */
    void note(const RenderPlan& plan, const types::Geometry& geometry, types::Notices& notices) const override {
        if (plan.config.model != Model::Physical || !plan.config.frequency_khz) return;
        const double frequency = 1000 * *plan.config.frequency_khz;
        const acoustics::Fluid water{water_density, plan.config.speedOfSound()};
        for (size_t i = 0; i < geometry.materials.size(); ++i) {
            const types::Material& material = geometry.materials[i];
            if (!material.shell || material.shell->has_air || plan.laws.walls[i].rings()) continue;
            const acoustics::Plate plate = acoustics::makePlate(*material.shell);
            if (!acoustics::isNearResonance(plate, frequency)) continue;
            const acoustics::PlateShares shares =
                acoustics::computeShares(plate, water, acoustics::getFluidBehind(*material.shell, water), frequency, 1);
            const types::Notice notice = types::warning(
                fmt::format("the wall of {} is near a half-wave resonance: {:.3g} mm are {:.2f} half wavelengths at "
                            "{:g} kHz; it reflects {:.3g} % of the sound and passes {:.3g} %",
                            material.name, 1e3 * plate.thickness, acoustics::countHalfWaves(plate, frequency),
                            *plan.config.frequency_khz, 100 * shares.reflected, 100 * shares.passed));
            if (std::ranges::count(notices, notice) == 0) notices.push_back(notice);
        }
    }
    std::string removeFrom(SonarConfig& config) const override {
        if (config.max_walls == 0) return {};
        config.max_walls = 0;
        return "thin walls";
    }
};

std::string oneImage(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("one image shows all {:g} deg", what.value);
}

/** Several images of a fan that is too wide for one. */
class Frusta final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.frusta.size() != 1) return !plan.frusta.empty();
        return leaveOut(plan, {.effect = "further slabs",
                               .reason = Reason::Other,
                               .value = plan.config.coverageDeg(),
                               .words = oneImage});
    }
};

std::string speedWords(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("motion_in_ping is false; from {:.2g} m/s on it moves echoes by more than half a bin",
                       what.value);
}

/** Sonar and objects that move while sound travels (ACOUSTICS.md 5.20). RayPaths computes the sound paths. */
class MotionInPing final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.motion_in_ping)
            return leaveOut(plan, {.effect = "motion within a ping",
                                   .reason = Reason::Approximated,
                                   .value = motionBound(plan.config, plan.grid).speed,
                                   .words = speedWords});
        plan.effect_features.emplace_back("motion_in_ping");
        return true;
    }
    std::vector<std::string> features() const override { return {"motion_in_ping"}; }
    void note(const RenderPlan& plan, const types::Geometry& /*geometry*/, types::Notices& notices) const override {
        if (!plan.config.motion_in_ping) return;
        const MotionBound bound = motionBound(plan.config, plan.grid);
        notices.push_back(
            fmt::format("motion within a ping is simulated from {:.2g} m/s or {:.2g} deg/s; below that it is less than "
                        "half a bin and half a beam",
                        bound.speed, types::degrees(bound.turn)));
    }
};

std::string noMap(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has one"; }

/** Normals from a texture of the material (ACOUSTICS.md 3.4). */
class NormalMaps final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        if (std::ranges::none_of(geometry.materials, [](const auto& material) { return material.normal_map >= 0; }))
            return leaveOut(plan, {.effect = "normal maps", .reason = Reason::NoneInScene, .words = noMap});
        plan.features.add(Feature::NormalMap);
        return true;
    }
};

std::string withoutMaps(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has one"; }
std::string byReflectivity(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "cerqueira2017 uses the reflectivity of the material only";
}
std::string mapsNeedRays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "the scene is rasterised; surface maps need `visibility: cpu`";
}

/** Strengths and materials from maps on surfaces (ACOUSTICS.md 3.13). RayEchoes looks them up. */
class SurfaceMaps final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        double maximum = 0;
        for (const types::Material& material : geometry.materials)
            maximum = std::max(maximum, static_cast<double>(material.max_map_strength));
        const auto omit = [&](Reason reason, Omitted::Words words) {
            return leaveOut(plan, {.effect = "surface maps", .reason = reason, .words = words});
        };
        if (!(maximum > 0)) return omit(Reason::NoneInScene, withoutMaps);
        if (plan.config.model != Model::Physical) return omit(Reason::Other, byReflectivity);
        if (!plan.traces_rays) return omit(Reason::Lacking, mapsNeedRays);
        plan.add(Pass::SurfaceMaps);
        plan.max_map_strength = std::max(maximum, 1.0);
        return true;
    }
};

std::string withoutDeforming(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no mesh has a skin or morph targets";
}

/** Meshes that skins and morph targets deform from ping to ping. EchoRenderer::updateShapes() poses them. */
class DeformingMeshes final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        if (std::ranges::any_of(geometry.meshes, [](const auto& mesh) { return mesh.deformation != nullptr; }))
            return true;
        return leaveOut(plan, {.effect = "deforming meshes", .reason = Reason::NoneInScene, .words = withoutDeforming});
    }
};

std::string nobody(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "nobody is connected to truth or returns at the first ping";
}

/** Whether pings record the truth, which a plan does not know. */
class TruthInPings final : public PingEffect {
public:
    void begin(const PingStart& start) override { omitted_ = !start.truth; }
    std::optional<Omitted> omissions() const override {
        if (!omitted_) return {};
        return Omitted{.effect = "truth", .reason = Reason::Other, .words = nobody};
    }

private:
    bool omitted_ = false;
};

/** The truth of a ping's bins (types::SonarTruth). The deposit of cells records it, because it counts the same
 *  energies. */
class Truth final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& /*plan*/) const override { return true; }
    std::unique_ptr<PingEffect> make(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<TruthInPings>();
    }
};

}  // namespace

const Effect& absorption() { return only<Absorption>(); }

const Effect& publishedMeans() { return only<PublishedMeans>(); }

const Effect& pulse() { return only<PulseInRange>(); }

const Effect& ringDown() { return only<RingDown>(); }

const Effect& speckle() { return only<Speckle>(); }

const Effect& thinWalls() { return only<ThinWalls>(); }

const Effect& furtherFrusta() { return only<Frusta>(); }

bool followsMotion(const SonarConfig& config) { return config.motion_in_ping; }

const Effect& motionInPing() { return only<MotionInPing>(); }

const Effect& normalMaps() { return only<NormalMaps>(); }

const Effect& surfaceMaps() { return only<SurfaceMaps>(); }

const Effect& deformingMeshes() { return only<DeformingMeshes>(); }

const Effect& truth() { return only<Truth>(); }

}  // namespace insonify::sonar
