#include "components/sonar/PlanReport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/Volume.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

std::string nameOf(Effect effect) {
    static constexpr const char* names[] = {"absorption",
                                            "absorption inside a bin",
                                            "specular lobe",
                                            "seabeds by TR 9407",
                                            "measured backscatter",
                                            "spreading",
                                            "backscatter by material",
                                            "range footprints",
                                            "elevation mask",
                                            "shared columns",
                                            "near blanking",
                                            "azimuth beam pattern",
                                            "elevation beam pattern",
                                            "range point-spread",
                                            "transmit ring-down",
                                            "point targets",
                                            "volume reverberation",
                                            "coherent speckle",
                                            "multipath",
                                            "further slabs",
                                            "refraction",
                                            "motion within a ping",
                                            "normal maps",
                                            "objects",
                                            "triangles",
                                            "slabs"};
    return names[static_cast<size_t>(effect)];
}

std::string publishedWords(Effect effect) {
    switch (effect) {
        case Effect::RangeFootprints: return "published: one bin per pixel";
        case Effect::ElevationMask: return "published: the image's edge, nearer than the aperture away from ahead";
        case Effect::SharedColumns: return "published: every column belongs to one beam";
        default: return "published: bins begin at range 0";
    }
}

std::string boundedWords(const LeftOut& what, const BinGrid& grid) {
    if (what.effect == Effect::Refraction)
        return fmt::format("a gradient of {:.3g} 1/s bends by {:.2g} m at {:.4g} m < {:.2g} m",
                           2 * what.value * grid.speed_of_sound / (grid.range_max * grid.range_max), what.value,
                           grid.range_max, what.bound);
    if (what.effect == Effect::RangePointSpread)
        return fmt::format("the pulse resolves {:.2g} m, under half a bin, {:.2g} m", what.value, what.bound);
    return fmt::format("beta dR/2 = {:.1e} < {:.0e}", what.value, what.bound);
}

/** An absorption that changes by `residual` to either side of a bin's middle, in decibels. */
double decibels(double residual) { return 10 * residual / std::numbers::ln10; }

std::string approximatedWords(const LeftOut& what) {
    if (what.effect == Effect::MotionInPing) return fmt::format("below {:.2g} m/s it is under half a bin", what.value);
    return fmt::format("beta dR/2 = {:.1e}, {:.2g} dB to either side", what.value, decibels(what.value));
}

std::string reasonOf(const LeftOut& what, const BinGrid& grid) {
    switch (what.reason) {
        case Reason::NotConfigured: return "not configured";
        case Reason::NoFrequency: return "no frequency_khz; sediments follow Lambert's law by their lambert_db";
        case Reason::NoMaterialHasOne:
            return what.effect == Effect::SpecularLobe ? "no material has a reflection and a roughness_slope"
                                                       : "no material has one";
        case Reason::NoneInScene: return "the scene has none";
        case Reason::MeansOfS:
            return std::string("cerqueira2017: bins are means of S(n.d)") +
                   (what.effect == Effect::BackscatterByMaterial ? "; reflectivity scales n.d" : "");
        case Reason::Published: return publishedWords(what.effect);
        case Reason::BelowBound: return boundedWords(what, grid);
        case Reason::Approximated: return approximatedWords(what);
        case Reason::NoBounces: return "bounces is 0";
        case Reason::NoMirror: return "no surface is asked for, and no material is `mirror: true` or smooth enough";
        case Reason::NoWaterSurface: return "multipath.surface is given, and the scene has no water_surface";
        case Reason::AboveSurface: return "the sonar was above the water surface at the first ping";
        case Reason::BeyondRange:
            return fmt::format("the water surface was {:.4g} m away at the first ping, beyond {:.4g} m", what.value,
                               what.bound);
        case Reason::OneImage: return fmt::format("one image shows all {:g} deg", what.value);
        case Reason::OutOfView:
            if (what.effect == Effect::PointTargets)
                return "hidden, or out of the pattern or the range, at the first ping";
            return std::string("outside the fan or the range at the first ping") +
                   (what.effect == Effect::Triangles ? ", or on the far side of a closed mesh" : "");
    }
    return {};
}

void noteAbsorption(const RenderPlan& plan, std::vector<std::string>& notices) {
    const LeftOut* inside = plan.leftOut(Effect::AbsorptionInBin);
    if (inside && decibels(inside->value) > 0.1)
        notices.push_back(
            fmt::format("Warning: absorption changes within a bin by {:.2g} dB to either side of its "
                        "middle; it is taken in the middle",
                        decibels(inside->value)));
}

void noteRange(const SonarConfig& config, const BinGrid& grid, std::vector<std::string>& notices) {
    const double read = static_cast<double>(grid.bin_duration_us) * 1e-6 * grid.speed_of_sound;
    const double off = grid.range_max / read - grid.range_max / grid.bin_width;
    if (config.range_rounding == RangeRounding::Exact && std::abs(off) > 1e-6)
        notices.push_back(
            fmt::format("Warning: bin_duration, one way, is {} us in whole microseconds; a reader of it is off by "
                        "{:.3g} bins at the far edge",
                        grid.bin_duration_us, std::abs(off)));
    const double longer = grid.range_max / config.range - 1;
    if (std::abs(longer) > 1e-9)
        notices.push_back(fmt::format("{}range reached is {:.6g} m, {:.2g} % more than {:g} m: bins last {} us one way",
                                      longer > 0.01 ? "Warning: " : "", grid.range_max, 100 * longer, config.range,
                                      grid.bin_duration_us));
    const float far = static_cast<float>(grid.range_max);
    const double ulp = static_cast<double>(std::nextafter(far, std::numeric_limits<float>::infinity()) - far);
    if (grid.bin_width < ulp)
        notices.push_back(
            fmt::format("Warning: a bin of {:.2g} m is smaller than the {:.2g} m between neighbouring "
                        "float ranges; bins merge",
                        grid.bin_width, ulp));
}

void noteWater(const SonarConfig& config, const BinGrid& grid, std::vector<std::string>& notices) {
    if (grid.speed_of_sound < 1350 || grid.speed_of_sound > 1650)
        notices.push_back(
            fmt::format("Warning: speed of sound is {:g} m/s; water has 1350 to 1650", grid.speed_of_sound));
    if (config.water && !config.speed_of_sound) {
        const std::string outside = acoustics::outsideValidity(config.water->sound_speed_law, *config.water);
        if (!outside.empty())
            notices.push_back(
                fmt::format("Warning: speed of sound is extrapolated outside its law's validity: {}", outside));
    }
    if (config.absorbedKhz()) {
        const std::string outside =
            acoustics::outsideValidity(config.absorption->law, *config.absorbedKhz(), *config.water);
        if (!outside.empty())
            notices.push_back(
                fmt::format("Warning: absorption is extrapolated outside its law's validity: {}", outside));
    }
    const Bending bent = bending(config, grid);
    if (bent.offset >= bent.tolerated && !(config.water && config.water->profile))
        notices.push_back(
            fmt::format("Warning: rays are straight; a gradient of {} 1/s would bend them by {:.3g} m at "
                        "{:.4g} m",
                        speed_gradient, bent.offset, grid.range_max));
}

/** Names in quotes, at most five of them. */
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < names.size() && i < 5; ++i) text += fmt::format("{}'{}'", i ? ", " : "", names[i]);
    return names.size() > 5 ? text + ", ..." : text;
}

void noteMotion(const RenderPlan& plan, std::vector<std::string>& notices) {
    if (!plan.features.has(Feature::MotionInPing)) return;
    const MotionBound bound = motionBound(plan.config, plan.grid);
    notices.push_back(fmt::format(
        "motion within a ping is followed from {:.2g} m/s or {:.2g} deg/s on; below that it is under half a bin and "
        "half a beam",
        bound.speed, types::degrees(bound.turn)));
}

void noteMaterials(const types::Geometry& geometry, const MaterialLaws& laws, types::Plan& plan) {
    std::vector<std::string> plain, loud;
    for (size_t i = 0; i < geometry.materials.size(); ++i) {
        const types::Material& material = geometry.materials[i];
        if (!material.has_acoustics) plain.push_back(material.name);
        if (laws.records[i].law.x < 0 && laws.records[i].values.x > std::numbers::inv_pi_v<float>)
            loud.push_back(material.name);
    }
    if (!plain.empty())
        plan.notices.push_back(
            fmt::format("{} of {} materials have no acoustic values and are medium sand, -16.7 dB: {}", plain.size(),
                        geometry.materials.size(), listed(plain)));
    if (!loud.empty())
        plan.notices.push_back(
            fmt::format("Warning: a lambert_db above -4.97 dB gives back more than it gets: {}", listed(loud)));
    if (!laws.outside_validity.empty())
        plan.notices.push_back(fmt::format(
            "Warning: backscatter of seabeds is extrapolated outside its law's validity: {}", laws.outside_validity));
}

}  // namespace

std::vector<std::string> configNotices(const SonarConfig& config) {
    const BinGrid grid = makeBinGrid(config);
    std::vector<std::string> notices;
    noteRange(config, grid, notices);
    noteWater(config, grid, notices);
    return notices;
}

std::string depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot) {
    if (!plan.profile) return {};
    const double depth = -waterViewOf(snapshot).height, top = plan.profile->top(), bottom = plan.profile->bottom();
    if (depth >= top && depth <= bottom) return {};
    return fmt::format(
        "Warning: at the first ping the sonar is {:.4g} m deep, its profile of the speed of sound goes from {:g} to "
        "{:g} m; beyond them the speed is that of the nearer end",
        depth, top, bottom);
}

types::Omission describe(const LeftOut& what, const BinGrid& grid) {
    const std::string name = nameOf(what.effect);
    if (what.reason != Reason::OutOfView) return {name, reasonOf(what, grid)};
    return {fmt::format("{}{:.0f} of {:.0f} {}", what.effect == Effect::Triangles ? "at least " : "", what.value,
                        what.bound, name),
            reasonOf(what, grid)};
}

types::Plan report(const RenderPlan& plan, const types::Geometry& geometry) {
    types::Plan told;
    told.rows = plan.config.rows();
    told.columns_per_beam = plan.config.columnsPerBeam();
    told.slabs = static_cast<int>(plan.frusta.size());
    told.predicted_error = std::numeric_limits<double>::quiet_NaN();
    told.features = plan.features.names();
    for (Pass pass : plan.passes) told.passes.emplace_back(types::EnumNames<Pass>::names[static_cast<size_t>(pass)]);
    for (const LeftOut& what : plan.left_out) told.omitted.push_back(describe(what, plan.grid));
    told.notices = configNotices(plan.config);
    noteAbsorption(plan, told.notices);
    noteMotion(plan, told.notices);
    if (plan.config.model == Model::Physical) noteMaterials(geometry, plan.laws, told);
    return told;
}

}  // namespace insonify::sonar
