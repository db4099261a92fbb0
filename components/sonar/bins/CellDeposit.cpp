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

/** The laws of a batch's cells. */
struct CellLaws {
    bool follow[Cells::capacity];         ///< Whether the cell follows a law, or Lambert's.
    int32_t table[Cells::capacity];       ///< Number of its table; -1: the diffuse part follows Lambert's law.
    double mu[Cells::capacity];           ///< Lambert's parameter [1].
    double cosine[Cells::capacity];       ///< Of the incidence [1].
    double over_cosine[Cells::capacity];  ///< sigma_b / cos(theta) [1].
};

/** The cells of a batch that have lobes: LobeView and FacetRecord as arrays. */
struct LobeCells {
    int count = 0, cell[Cells::capacity];
    double power[Cells::capacity], relief[Cells::capacity], cosine[Cells::capacity], lobe[Cells::capacity];
    double normal_x[Cells::capacity], normal_y[Cells::capacity], normal_z[Cells::capacity];
    double axis_x[Cells::capacity], axis_y[Cells::capacity], axis_z[Cells::capacity], range[Cells::capacity];
    double cos_az[Cells::capacity], sin_az[Cells::capacity], cos_el[Cells::capacity], sin_el[Cells::capacity];
    double width[Cells::capacity], height[Cells::capacity], mapped[Cells::capacity];
    float facet[12][Cells::capacity];

    void add(int i, const Cells& cells, const vec4& law, double inverse_range, double at_cosine) {
        const int k = count++;
        const FacetRecord& record = *cells.facet[i];
        const glm::dvec3 axis = turned(*cells.run[i], record.axis);
        cell[k] = i;
        power[k] = double{law.y}, relief[k] = double{law.z}, cosine[k] = at_cosine;
        normal_x[k] = cells.normal_x[i], normal_y[k] = cells.normal_y[i], normal_z[k] = cells.normal_z[i];
        axis_x[k] = axis.x, axis_y[k] = axis.y, axis_z[k] = axis.z, range[k] = 1 / inverse_range;
        cos_az[k] = cells.cos_az[i], sin_az[k] = cells.sin_az[i];
        cos_el[k] = cells.cos_el[i], sin_el[k] = cells.sin_el[i];
        width[k] = cells.width[i], height[k] = cells.height[i], mapped[k] = cells.mapped[i];
        for (int part = 0; part < 4; ++part) {
            facet[part][k] = record.axis[part];
            facet[4 + part][k] = record.first[part];
            facet[8 + part][k] = record.second[part];
        }
    }
};

/** Computes the cosine of each cell, and its section without a lobe. */
INSONIFY_VECTOR_CLONES __attribute__((flatten)) void followTables(const double* tables, const Cells& cells,
                                                                  const Covered& covered, CellLaws& __restrict laws) {
    BackscatterCode code{tables};
    for (int i = 0; i < cells.count; ++i) {
        const double normal = sqrt(cells.normal_x[i] * cells.normal_x[i] + cells.normal_y[i] * cells.normal_y[i] +
                                   cells.normal_z[i] * cells.normal_z[i]);
        const double of_plane = min(abs(cells.distance[i]) * covered.pixel[i] / normal, 1.0);
        const double cosine = cells.mapped[i] > 0 ? cells.mapped[i] : of_plane;
        const double tabulated =
            code.tabulatedBackscatter(static_cast<uint>(laws.table[i] < 0 ? 0 : laws.table[i]), cosine);
        laws.cosine[i] = cosine;
        laws.over_cosine[i] = laws.table[i] < 0 ? laws.mu[i] * cosine : tabulated;
    }
}

/** Computes the lobe's part of the section of each cell. */
INSONIFY_VECTOR_CLONES __attribute__((flatten)) void followLobes(LobeCells& __restrict cells) {
    BackscatterCode code{nullptr};
    for (int k = 0; k < cells.count; ++k) {
        const auto values = [&](int part) {
            return vec4(cells.facet[part][k], cells.facet[part + 1][k], cells.facet[part + 2][k],
                        cells.facet[part + 3][k]);
        };
        const LobeSlopes slopes = code.lobeSlopes({values(0), values(4), values(8)}, cells.relief[k],
                                                  {{cells.normal_x[k], cells.normal_y[k], cells.normal_z[k]},
                                                   {cells.axis_x[k], cells.axis_y[k], cells.axis_z[k]},
                                                   cells.range[k],
                                                   cells.cos_az[k],
                                                   cells.sin_az[k],
                                                   cells.cos_el[k],
                                                   cells.sin_el[k],
                                                   cells.width[k],
                                                   cells.height[k],
                                                   cells.mapped[k]});
        cells.lobe[k] = code.lobeOverCosine(cells.power[k], slopes, cells.cosine[k]);
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
    static constexpr double no_tables[BACKSCATTER_ENTRIES] = {};
    CellLaws laws;
    for (int i = 0; i < cells.count; ++i) {
        const MaterialRecord& record = rules_.laws.records[cells.material[i]];
        laws.follow[i] = !FOLLOWS_LAMBERT(record.law) && covered.pixel[i] > 0;
        laws.table[i] = static_cast<int32_t>(record.law.x);
        laws.mu[i] = double{record.values.x};
    }
    followTables(rules_.laws.tables.empty() ? no_tables : rules_.laws.tables.data(), cells, covered, laws);
    LobeCells lobes;
    for (int i = 0; i < cells.count; ++i) {
        const vec4& law = rules_.laws.records[cells.material[i]].law;
        if (laws.follow[i] && law.y > 0) lobes.add(i, cells, law, covered.pixel[i], laws.cosine[i]);
    }
    followLobes(lobes);
    for (int k = 0; k < lobes.count; ++k) laws.over_cosine[lobes.cell[k]] += lobes.lobe[k];
    for (int i = 0; i < cells.count; ++i) {
        covered.fade[i] = laws.follow[i] ? 0 : covered.fade[i];
        const double strength = rules_.strength_scale / covered.pixel[i] * laws.over_cosine[i];
        covered.strength_range[i] = laws.follow[i] ? strength : covered.strength_range[i];
    }
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
