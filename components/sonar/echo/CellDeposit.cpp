#include "components/sonar/echo/CellDeposit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "components/sonar/echo/Estimators.hpp"
#include "components/sonar/effects/Effect.hpp"

namespace insonify::sonar {
namespace {

#include "shaders/plane.glsl"

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void coverAll(const Cells& cells, double near_edge, double far_edge,
                                                              Covered& __restrict covered) {
    const int count = cells.count;
    for (int i = 0; i < count; ++i) {
        const PlaneFootprint seen =
            planeFootprint(cells.normal_x[i], cells.normal_y[i], cells.normal_z[i], cells.distance[i], cells.cos_az[i],
                           cells.sin_az[i], cells.cos_el[i], cells.sin_el[i], cells.width[i], cells.height[i],
                           cells.lean[i], cells.size[i], cells.near_limit[i], cells.far_limit[i], near_edge, far_edge);
        const Footprint& cell = seen.footprint;
        covered.pixel[i] = cell.pixel;
        covered.centre[i] = cell.centre;
        covered.wide[i] = cell.wide;
        covered.narrow[i] = cell.narrow;
        covered.per_wide[i] = cell.per_wide;
        covered.steepness[i] = cell.steepness;
        covered.near_end[i] = cell.near_end;
        covered.far_end[i] = cell.far_end;
        covered.nearest[i] = cell.nearest;
        covered.size[i] = cell.size;
        const double mapped = seen.perpendicular > 0.0 ? cells.mapped[i] : 0.0;
        const double cosine_range = mapped > 0.0 ? mapped / cell.pixel : seen.perpendicular;
        covered.strength_range[i] = cells.strength[i] * cosine_range;
    }
}

/** The estimator that has the features of a plan. */
const EstimatorEntry& estimatorOf(const Features& features) {
    Features known;
    for (const auto& all : {physicalEstimators(), nearestEstimators(), meanEstimators()})
        for (const EstimatorEntry& entry : all) known = known | entry.features;
    for (const auto& all : {physicalEstimators(), nearestEstimators(), meanEstimators()})
        for (const EstimatorEntry& entry : all)
            if (entry.features == (features & known)) return entry;
    throw std::logic_error("no estimator has the features of the plan");
}

}  // namespace

PlacedRun placedRun(const ObjectRecord& object, const CommandRecord& command, const EchoRules& rules,
                    const PlaneRecord* planes, const FacetRecord* facets) {
    const vec4& values = rules.laws.records[command.material].values;
    const double strength = double{rules.features.has(Feature::Cerqueira2017) ? values.y : values.x};
    PlacedRun run{{},
                  {},
                  {},
                  {},
                  object.extent.x,
                  object.extent.y,
                  strength * rules.strength_scale,
                  planes,
                  facets,
                  command.material};
    for (int i = 0; i < 3; ++i) {
        run.normal_x[i] = double{object.normal_x[i]};
        run.normal_y[i] = double{object.normal_y[i]};
        run.normal_z[i] = double{object.normal_z[i]};
        run.eye[i] = double{object.eye[i]} + double{object.eye_rest[i]};
    }
    return run;
}

void CellDeposit::cover() {
    coverAll(cells, rules_.edges.front(), rules_.edges[static_cast<size_t>(rules_.bins.bin_count)], covered);
    if (rules_.features.has(Feature::BackscatterLaws)) applyLaws();
    if (bent_ && rules_.features.has(Feature::Physical))
        for (int i = 0; i < cells.count; ++i) covered.strength_range[i] *= cells.focus[i];
}

/** The strength of what does not follow Lambert's law. */
void CellDeposit::applyLaws() {
    for (int i = 0; i < cells.count; ++i) {
        if (rules_.laws.followsLambert(cells.material[i]) || !(covered.pixel[i] > 0)) continue;
        const double normal = sqrt(cells.normal_x[i] * cells.normal_x[i] + cells.normal_y[i] * cells.normal_y[i] +
                                   cells.normal_z[i] * cells.normal_z[i]);
        const double cosine =
            cells.mapped[i] > 0 ? cells.mapped[i] : min(abs(cells.distance[i]) * covered.pixel[i] / normal, 1.0);
        covered.strength_range[i] =
            rules_.strength_scale / covered.pixel[i] * rules_.laws.overCosine(cells.material[i], cosine, lobeSlopes(i));
    }
}

LobeSlopes CellDeposit::lobeSlopes(int i) const {
    if (cells.facet[i] == nullptr || !rules_.laws.hasLobe(cells.material[i])) return {};
    return rules_.laws.lobeSlopes(cells.material[i], {*cells.facet[i],
                                                      {cells.normal_x[i], cells.normal_y[i], cells.normal_z[i]},
                                                      turned(*cells.run[i], cells.facet[i]->axis),
                                                      1 / covered.pixel[i],
                                                      cells.cos_az[i],
                                                      cells.sin_az[i],
                                                      cells.cos_el[i],
                                                      cells.sin_el[i],
                                                      cells.width[i],
                                                      cells.height[i],
                                                      cells.mapped[i]});
}

CellDeposit::CellDeposit(const EchoRules& rules, const WaterView& water, bool bent, const EchoSums& to)
    : rules_(rules), water_(water), bent_(bent), to_(to), estimator_(estimatorOf(rules.features)) {}

void CellDeposit::finish() {
    for (size_t i = 0; i < rules_.own.size(); ++i)
        rules_.own[i]->addCells(
            {rules_, water_, cells, covered, to_.first_beam, to_.sums + rules_.ownOffset(i), rules_.sumCount()});
    cells.count = 0;
}

void CellDeposit::flush() {
    if (cells.count == 0) return;
    cover();
    estimator_.sum(rules_, cells, covered, to_);
    finish();
}

}  // namespace insonify::sonar
