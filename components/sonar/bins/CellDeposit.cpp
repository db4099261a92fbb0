#include "components/sonar/bins/CellDeposit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "components/sonar/base/Counters.hpp"
#include "components/sonar/bins/Estimators.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

#include "shaders/plane.glsl"

/** Cells of a body are planes if their distance from its limb exceeds this number of their half lengths [1]. */
constexpr double limb_reach = 16;

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
        covered.limb[i] = covered.fade[i] = 0;
        covered.size[i] = cell.size;
        const double mapped = seen.perpendicular > 0.0 ? cells.mapped[i] : 0.0;
        const double cosine_range = mapped > 0.0 ? mapped / cell.pixel : seen.perpendicular;
        covered.strength_range[i] = cells.strength[i] * cosine_range;
    }
}

/** Returns the estimator with the features of a plan. */
const EstimatorEntry& estimator(const Features& features) {
    Features known;
    for (const EstimatorEntry& entry : estimators()) known = known | entry.features;
    for (const EstimatorEntry& entry : estimators())
        if (entry.features == (features & known)) return entry;
    throw std::logic_error("no estimator has the features of the plan");
}

/** Returns the first cell before the first beam, or with a plane, a direction or a strength that is not finite. */
int firstWrong(const Cells& cells, int first_beam) {
    for (int i = 0; i < cells.count; ++i) {
        const double all = cells.normal_x[i] + cells.normal_y[i] + cells.normal_z[i] + cells.distance[i] +
                           cells.cos_az[i] + cells.sin_az[i] + cells.cos_el[i] + cells.sin_el[i] + cells.strength[i];
        if (!std::isfinite(all) || cells.beam[i] < first_beam) return i;
    }
    return cells.count;
}

}  // namespace

PlacedRun placedRun(const ObjectRecord& object, const CommandRecord& command, const EchoRules& rules,
                    const PlaneRecord* planes, const FacetRecord* facets, const CurveRecord* curves) {
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
                  curves,
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
    INSONIFY_CHECK(cells.count <= Cells::capacity, cells.count);
    INSONIFY_CHECK(cells.of_bodies_count <= cells.count, cells.of_bodies_count, cells.count);
    INSONIFY_CHECK(firstWrong(cells, to_.first_beam) == cells.count, firstWrong(cells, to_.first_beam), cells.count);
    const double near_edge = rules_.edges.front(), far_edge = rules_.edges[static_cast<size_t>(rules_.bins.bin_count)];
    coverAll(cells, near_edge, far_edge, covered);
    bendCells(near_edge, far_edge);
    if (rules_.features.has(Feature::BackscatterLaws)) applyLaws();
    if (rules_.has_maps)
        for (int i = 0; i < cells.count; ++i) covered.strength_range[i] *= cells.gain[i];
    if (bent_ && rules_.features.has(Feature::Physical))
        for (int i = 0; i < cells.count; ++i) covered.strength_range[i] *= cells.focus[i];
}

double CellDeposit::curvature(const Cells::OfBody& of_body, double cosine) const {
    const int i = of_body.cell;
    const vec4& bend = of_body.curve->bend;
    const glm::dvec3 ray(cells.cos_el[i] * cells.cos_az[i], cells.cos_el[i] * cells.sin_az[i], cells.sin_el[i]);
    const double along = glm::dot(turned(*cells.run[i], bend), ray);
    return static_cast<double>(bend.w) + along * along / max(1 - cosine * cosine, MIN_SINE_SQUARE);
}

void CellDeposit::bendCells(double near_edge, double far_edge) {
    for (int k = 0; k < cells.of_bodies_count; ++k) {
        const int i = cells.of_bodies[k].cell;
        if (!(covered.size[i] > 0)) continue;
        const double inverse = covered.pixel[i], perpendicular = 1 / covered.nearest[i];
        const double curvature = this->curvature(cells.of_bodies[k], inverse * perpendicular);
        const double reach = max(inverse - limb_reach * 0.5 * (covered.wide[i] + covered.narrow[i]), 0.0);
        // Whether the limb, sqrt(curvature / (2 perpendicular + curvature / inverse^2)), is nearer than the reach.
        if (curvature * inverse * inverse > reach * reach * (2 * perpendicular * inverse * inverse + curvature))
            bendCell(i, curvature, near_edge, far_edge);
    }
}

void CellDeposit::bendCell(int i, double curvature, double near_edge, double far_edge) {
    Footprint cell = getFootprint(covered, i);
    const double level = cell.pixel - cells.normal_z[i] * cells.sin_el[i] / cells.distance[i];
    const double sag =
        (cells.width[i] * cells.width[i] * level + cells.height[i] * cells.height[i] * cell.pixel) * (1.0 / 24);
    const double length = bend(cell, {curvature, 1 / cell.nearest, cells.width[i], cells.height[i], cells.cos_el[i],
                                      sag, cells.near_limit[i], cells.far_limit[i], near_edge, far_edge});
    covered.centre[i] = cell.centre;
    covered.wide[i] = cell.wide;
    covered.narrow[i] = cell.narrow;
    covered.per_wide[i] = cell.per_wide;
    covered.steepness[i] = cell.steepness;
    covered.near_end[i] = cell.near_end;
    covered.far_end[i] = cell.far_end;
    covered.nearest[i] = cell.nearest;
    covered.limb[i] = cell.limb;
    if (cells.mapped[i] > 0) return;
    covered.fade[i] = cell.fade;
    covered.strength_range[i] = cells.strength[i] * length;
}

/** Sets the strength of cells that do not follow Lambert's law. */
void CellDeposit::applyLaws() {
    for (int i = 0; i < cells.count; ++i) {
        if (rules_.laws.followsLambert(cells.material[i]) || !(covered.pixel[i] > 0)) continue;
        const double normal = sqrt(cells.normal_x[i] * cells.normal_x[i] + cells.normal_y[i] * cells.normal_y[i] +
                                   cells.normal_z[i] * cells.normal_z[i]);
        const double cosine =
            cells.mapped[i] > 0 ? cells.mapped[i] : min(abs(cells.distance[i]) * covered.pixel[i] / normal, 1.0);
        covered.fade[i] = 0;
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
    : rules_(rules), water_(water), bent_(bent), to_(to), estimator_(estimator(rules.features)) {
    INSONIFY_CHECK(to.sums && to.first_beam >= 0, to.first_beam);
}

void CellDeposit::finish() {
    for (size_t i = 0; i < rules_.own.size() && !to_.behind_walls; ++i)
        rules_.own[i]->addCells(
            {rules_, water_, cells, covered, to_.first_beam, to_.sums + rules_.ownOffset(i), rules_.sumCount()});
    count(Counter::Cells, static_cast<uint64_t>(cells.count));
    cells.clear();
}

void CellDeposit::flush() {
    if (cells.count == 0) return;
    cover();
    estimator_.sum(rules_, cells, covered, to_);
    finish();
}

}  // namespace insonify::sonar
