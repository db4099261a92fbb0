#include "components/sonar/plan/RenderPlan.hpp"

#include <algorithm>

#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::sonar {
namespace {

/** Returns the features that the configuration requires; effects add the rest. */
Features findFeatures(const SonarConfig& config, const RenderOptions& options) {
    Features features{config.model == Model::Physical ? Feature::Physical : Feature::Cerqueira2017};
    if (config.beam_geometry == BeamGeometry::Conical) features.add(Feature::Conical);
    if (options.estimator != Estimator::Footprint) features.add(Feature::Nearest);
    if (options.estimator == Estimator::NearestJitter) features.add(Feature::Jitter);
    return features;
}

}  // namespace

std::vector<std::string> Features::names() const {
    std::vector<std::string> all;
    for (int i = 0; i < feature_count; ++i)
        if (has(static_cast<Feature>(i))) all.emplace_back(types::EnumNames<Feature>::names[i]);
    return all;
}

bool RenderPlan::hasFeature(std::string_view name) const { return std::ranges::count(featureNames(), name) > 0; }

std::vector<std::string> RenderPlan::featureNames() const {
    std::vector<std::string> all = features.names();
    all.insert(all.end(), effect_features.begin(), effect_features.end());
    return all;
}

std::vector<std::string> RenderPlan::defines() const {
    std::vector<std::string> all = featureNames();
    for (std::string& name : all) {
        for (char& c : name) c = types::raised(c);
        name.insert(0, "HAVE_");
    }
    return all;
}

void RenderPlan::setQuality(int rows, int columns_per_beam) {
    config.quality.rows = rows;
    config.quality.columns_per_beam = columns_per_beam;
    sampled = directivity ? sampledConfig(config, *directivity, traces_rays) : config;
    cells = directivity ? azimuthCells(config, sampled, beams, *directivity, traces_rays) : beams;
    if (!traces_rays) frusta = makeFrusta(sampled, cells, options);
}

const Omitted* RenderPlan::findOmitted(std::string_view effect) const {
    const auto found = std::ranges::find(omitted, effect, &Omitted::effect);
    return found == omitted.end() ? nullptr : &*found;
}

RenderPlan makeRenderPlan(const SonarConfig& config, const types::Geometry& geometry, const RenderOptions& options) {
    RenderPlan plan;
    plan.config = config;
    plan.options = options;
    plan.traces_rays = !options.needImages() && config.tracesRays();
    plan.grid = makeBinGrid(config);
    plan.laws = makeMaterialLaws(config, geometry);
    plan.features = findFeatures(config, options);
    plan.passes = {Pass::Cull, plan.traces_rays ? Pass::Rays : Pass::Surface, Pass::Deposit, Pass::Beams};
    plan.beams = makeBeams(config);
    if (config.beam_pattern) plan.directivity.emplace(config);
    plan.setQuality(config.rows(), config.columnsPerBeam());
    for (const Effect* effect : effects())
        calling(*effect, [&] {
            if (effect->plan(geometry, plan)) plan.effects.push_back(effect);
        });
    const int parts = fieldSampling(plan).parts;
    plan.summed = plan.grid;
    plan.summed.bin_count *= parts;
    plan.summed.bin_width /= parts;
    return plan;
}

Reach reach(const RenderPlan& plan) {
    const double half_elevation = types::radians(plan.sampled.beam_height_deg) / 2;
    double half_azimuth = plan.cells.farthestAside();
    if (plan.features.has(Feature::Conical)) half_azimuth = coneAzimuth(half_azimuth, half_elevation);
    return {plan.grid.range_max, half_azimuth, half_elevation};
}

types::ReturnRules makeReturnRules(const SonarConfig& config) {
    types::ReturnRules rules;
    rules.spreads = config.model == Model::Physical;
    rules.range_min = config.range_min;
    if (rules.spreads)
        for (const Effect* effect : effects()) effect->addTo(rules, config);
    return rules;
}

acoustics::Absorption makeAbsorption(const SonarConfig& config) {
    if (!config.absorption) return {};
    const AbsorptionConfig& absorption = *config.absorption;
    if (absorption.db_per_m) return {*absorption.db_per_m};
    return {acoustics::absorptionDbPerM(absorption.law, config.absorbedKhz().value(), config.water.value())};
}

}  // namespace insonify::sonar
