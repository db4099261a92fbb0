#include "components/sonar/RenderPlan.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "components/sonar/RangeResponse.hpp"
#include "types/Angle.hpp"
#include "types/ConfigError.hpp"

namespace insonify::sonar {
namespace {

bool hasNormalMap(const types::Geometry& geometry) {
    return std::ranges::any_of(geometry.materials, [](const auto& material) { return material.normal_map >= 0; });
}

Features featuresOf(const SonarConfig& config, const RenderOptions& options, const types::Geometry& geometry,
                    const MaterialLaws& laws) {
    Features features{config.model == Model::Physical ? Feature::Physical : Feature::Cerqueira2017};
    if (config.model == Model::Cerqueira2017 && makeAbsorption(config).db_per_m > 0) features.add(Feature::Absorption);
    if (config.published && config.model == Model::Cerqueira2017) features.add(Feature::Published);
    if (config.beam_geometry == BeamGeometry::Conical) features.add(Feature::Conical);
    if (hasNormalMap(geometry)) features.add(Feature::NormalMap);
    if (options.estimator != Estimator::Footprint) features.add(Feature::Nearest);
    if (config.beam_pattern && config.beam_pattern->hasElevation()) features.add(Feature::ElevationPattern);
    if (!laws.tables.empty() || laws.hasLobes()) features.add(Feature::BackscatterLaws);
    if (!config.volume.empty()) features.add(Feature::Volume);
    if (config.hasLayers()) features.add(Feature::VolumeLayers);
    if (config.isCoherent()) features.add(Feature::Speckle);
    if (options.estimator == Estimator::NearestJitter) features.add(Feature::Jitter);
    return features;
}

void omitAbsorption(RenderPlan& plan) {
    if (!plan.config.absorption) return plan.left_out.push_back({Effect::Absorption, Reason::NotConfigured});
    if (plan.config.model == Model::Cerqueira2017) return;
    const double residual = makeAbsorption(plan.config).intensityPerMetre() * plan.grid.bin_width / 2;
    const Reason reason = residual < 1e-3 ? Reason::BelowBound : Reason::Approximated;
    plan.left_out.push_back({Effect::AbsorptionInBin, reason, residual, 1e-3});
}

void omitPhysical(RenderPlan& plan) {
    const auto omitUnless = [&](bool wanted, Effect effect, Reason reason = Reason::NoMaterialHasOne) {
        if (!wanted) plan.left_out.push_back({effect, reason});
    };
    omitUnless(plan.laws.hasLobes(), Effect::SpecularLobe);
    omitUnless(plan.laws.has_seabeds, Effect::SeabedLaw,
               plan.laws.lacks_frequency ? Reason::NoFrequency : Reason::NoMaterialHasOne);
    omitUnless(plan.laws.has_measured, Effect::MeasuredBackscatter);
}

void omitMeans(RenderPlan& plan) {
    plan.left_out.push_back({Effect::Spreading, Reason::MeansOfS});
    plan.left_out.push_back({Effect::BackscatterByMaterial, Reason::MeansOfS});
    plan.left_out.push_back({Effect::PointTargets, Reason::MeansOfS});
    if (!plan.features.has(Feature::Published)) return;
    for (Effect effect : {Effect::RangeFootprints, Effect::ElevationMask, Effect::SharedColumns, Effect::NearBlanking})
        plan.left_out.push_back({effect, Reason::Published});
}

void omitPulse(RenderPlan& plan) {
    if (plan.has(Pass::Pulse)) return;
    if (!plan.config.pulse) return plan.left_out.push_back({Effect::RangePointSpread, Reason::NotConfigured});
    const acoustics::Pulse pulse(*plan.config.pulse, plan.grid.speed_of_sound);
    plan.left_out.push_back(
        {Effect::RangePointSpread, Reason::BelowBound, pulse.resolution(), plan.grid.bin_width / 2});
}

/** What there is to reflect sound; `bounces` says which of it does (ACOUSTICS.md 5.23). */
bool hasMirrors(const RenderPlan& plan, const types::Geometry& geometry) {
    const MultipathConfig& multipath = *plan.config.multipath;
    return multipath.surface || std::ranges::any_of(geometry.materials, [&](const types::Material& material) {
               return reflectedPower(material, multipath.bounces) > 0;
           });
}

void omitMultipath(RenderPlan& plan) {
    if (plan.has(Pass::Paths)) return;
    const Reason reason = !plan.config.multipath       ? Reason::NotConfigured
                          : !plan.config.tracesPaths() ? Reason::NoBounces
                                                       : Reason::NoMirror;
    plan.left_out.push_back({Effect::Multipath, reason});
}

bool hasProfile(const SonarConfig& config) { return config.water && config.water->profile; }

/** Whether a profile puts any echo elsewhere: by bending its ray, or by another speed of sound than the sonar's. */
bool matters(const acoustics::SoundProfile& profile, const SonarConfig& config, const BinGrid& grid) {
    const double c = grid.speed_of_sound, slow = profile.slowest();
    const Bending bent = bending(config, grid, profile.steepest() * c / slow);
    const double off = std::max(c / slow - 1, 1 - c / profile.fastest()) * grid.range_max;
    return !(bent.offset < bent.tolerated) || !(off < grid.bin_width / 2);
}

std::shared_ptr<const acoustics::SoundProfile> bendingProfile(const SonarConfig& config, const BinGrid& grid) {
    if (!hasProfile(config)) return nullptr;
    auto profile =
        std::make_shared<const acoustics::SoundProfile>(acoustics::SoundProfile::read(*config.water->profile));
    return matters(*profile, config, grid) ? profile : nullptr;
}

void omitRefraction(RenderPlan& plan) {
    if (plan.profile) return;
    const bool straight = hasProfile(plan.config);
    const double gradient =
        straight ? acoustics::SoundProfile::read(*plan.config.water->profile).steepest() : speed_gradient;
    const Bending bent = bending(plan.config, plan.grid, gradient);
    if (bent.offset < bent.tolerated)
        plan.left_out.push_back({Effect::Refraction, Reason::BelowBound, bent.offset, bent.tolerated});
}

std::vector<Pass> passesOf(const RenderPlan& plan, const types::Geometry& geometry) {
    std::vector<Pass> passes{Pass::Cull, plan.casts_rays ? Pass::Rays : Pass::Surface, Pass::Deposit};
    if (plan.config.tracesPaths() && hasMirrors(plan, geometry)) passes.push_back(Pass::Paths);
    passes.push_back(Pass::Beams);
    if (plan.directivity && plan.directivity->hasAzimuth()) passes.push_back(Pass::Beamform);
    if (plan.config.pulse && !isShort(acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound), plan.grid))
        passes.push_back(Pass::Pulse);
    if (plan.config.pulse && plan.config.pulse->ring_down) passes.push_back(Pass::RingDown);
    return passes;
}

void omitEffects(const types::Geometry& geometry, RenderPlan& plan) {
    const auto omitUnless = [&](bool wanted, Effect effect) {
        if (!wanted) plan.left_out.push_back({effect, Reason::NotConfigured});
    };
    omitUnless(plan.has(Pass::Beamform), Effect::AzimuthPattern);
    omitUnless(plan.features.has(Feature::ElevationPattern), Effect::ElevationPattern);
    omitPulse(plan);
    omitUnless(plan.has(Pass::RingDown), Effect::RingDown);
    omitUnless(plan.features.has(Feature::Volume), Effect::Volume);
    omitUnless(plan.features.has(Feature::Speckle), Effect::Speckle);
    omitMultipath(plan);
    if (plan.frusta.size() == 1)
        plan.left_out.push_back({Effect::FurtherSlabs, Reason::OneImage, plan.config.coverageDeg()});
    omitRefraction(plan);
    if (!plan.config.motion_in_ping)
        plan.left_out.push_back(
            {Effect::MotionInPing, Reason::Approximated, motionBound(plan.config, plan.grid).speed});
    if (!hasNormalMap(geometry)) plan.left_out.push_back({Effect::NormalMaps, Reason::NoMaterialHasOne});
}

}  // namespace

std::vector<std::string> Features::names() const {
    std::vector<std::string> all;
    for (int i = 0; i < feature_count; ++i)
        if (has(static_cast<Feature>(i))) all.emplace_back(types::EnumNames<Feature>::names[i]);
    return all;
}

std::vector<std::string> Features::defines() const {
    std::vector<std::string> all = names();
    for (std::string& name : all) {
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        name.insert(0, "HAVE_");
    }
    return all;
}

void RenderPlan::setQuality(int rows, int columns_per_beam) {
    config.quality.rows = rows;
    config.quality.columns_per_beam = columns_per_beam;
    sampled = directivity ? sampledConfig(config, *directivity, casts_rays) : config;
    cells = directivity ? azimuthCells(sampled, beams, *directivity, casts_rays) : beams;
    if (!casts_rays) frusta = makeFrusta(sampled, cells, options);
}

double reflectedPower(const types::Material& material, int bounces) {
    constexpr double min_reflection = 0.5, steepest = 0.3;
    const double reflection = std::abs(static_cast<double>(material.reflection));
    if (material.mirror && bounces > 0) return reflection > 0 ? reflection * reflection : 1;
    const bool smooth = material.roughness_slope && static_cast<double>(*material.roughness_slope) < steepest;
    return bounces > 1 && smooth && reflection > min_reflection ? reflection * reflection : 0;
}

const LeftOut* RenderPlan::leftOut(Effect effect) const {
    const auto found = std::ranges::find(left_out, effect, &LeftOut::effect);
    return found == left_out.end() ? nullptr : &*found;
}

Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient) {
    const double r = grid.range_max;
    return {gradient * r * r / (2 * grid.speed_of_sound),
            std::max(grid.bin_width, 0.1 * r * types::radians(config.beam_height_deg))};
}

double dopplerCoupling(const SonarConfig& config) {
    if (!config.motion_in_ping || !config.pulse || !config.pulse->chirp_us) return 0;
    return 1e-6 * *config.pulse->chirp_us * config.frequency_khz.value() / config.pulse->bandwidth_khz.value();
}

MotionBound motionBound(const SonarConfig& config, const BinGrid& grid) {
    const double flight = 2 * grid.range_max / grid.speed_of_sound;
    const double seconds = std::max(flight, dopplerCoupling(config));
    return {grid.bin_width / (2 * seconds), types::radians(config.beamWidthDeg()) / (2 * flight)};
}

std::string whyStraight(const SonarConfig& config) {
    const bool drawn = hasProfile(config) && !config.castsRays();
    if (!bendingProfile(config, makeBinGrid(config)) || !drawn) return {};
    return "bends what a sonar hears of this range, which rays alone show; visibility may be auto or cpu, without "
           "published: true and deposit: gpu, in a build with rays";
}

RenderPlan makeRenderPlan(const SonarConfig& config, const types::Geometry& geometry, const RenderOptions& options) {
    RenderPlan plan;
    plan.config = config;
    plan.options = options;
    plan.casts_rays = !options.needImages() && config.castsRays();
    plan.grid = makeBinGrid(config);
    plan.laws = makeMaterialLaws(config, geometry);
    if (plan.casts_rays)
        plan.profile = bendingProfile(config, plan.grid);
    else if (const std::string why = whyStraight(config); !why.empty())
        throw types::ConfigError("", "water.profile", why);
    plan.features = featuresOf(config, options, geometry, plan.laws);
    if (plan.profile) plan.features.add(Feature::Refraction);
    if (config.motion_in_ping) plan.features.add(Feature::MotionInPing);
    plan.beams = makeBeams(config);
    if (config.beam_pattern) plan.directivity.emplace(config);
    plan.passes = passesOf(plan, geometry);
    plan.setQuality(config.rows(), config.columnsPerBeam());
    omitAbsorption(plan);
    if (config.model == Model::Physical)
        omitPhysical(plan);
    else
        omitMeans(plan);
    omitEffects(geometry, plan);
    return plan;
}

acoustics::Absorption makeAbsorption(const SonarConfig& config) {
    if (!config.absorption) return {};
    const AbsorptionConfig& absorption = *config.absorption;
    if (absorption.db_per_m) return {*absorption.db_per_m};
    return {acoustics::absorptionDbPerM(absorption.law, config.absorbedKhz().value(), config.water.value())};
}

}  // namespace insonify::sonar
