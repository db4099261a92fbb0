#include "components/sonar/TileDeposit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/sonar/Estimators.hpp"
#include "components/sonar/Scatterers.hpp"
#include "components/sonar/TruthDeposit.hpp"

namespace insonify::sonar {
namespace {

constexpr int stretch = 64;  ///< Cells at a time: their numbers stay in the nearest cache.

/** Cells, each the part of a triangle's plane that neighbouring samples see; sonar axes. */
struct Cells {
    double normal_x[stretch], normal_y[stretch], normal_z[stretch], distance[stretch];  ///< Planes, of any length [m].
    double cos_az[stretch], sin_az[stretch], cos_el[stretch], sin_el[stretch];  ///< Direction of the cell's middle.
    double width[stretch], height[stretch], lean[stretch];  ///< [rad], [rad], dazimuth / delevation of its sides [1].
    double size[stretch];                                   ///< Solid angle, in cells at elevation 0 [1].
    double strength[stretch];                               ///< Of the material [1].
    double facet_slope[stretch];                            ///< What its facet adds to a lobe's mean square slope [1].
    uint32_t material[stretch];
    double mapped[stretch];  ///< Cosine of a bent normal, or of a bent ray; 0: it is the plane's [1].
    double focus[stretch];   ///< What bent rays bring together [1].
    double near_limit[stretch], far_limit[stretch];  ///< Inverse ranges of the object [1/m].
    int beam[stretch];
};

/** What cells cover, and strength times slant range [m]. */
struct Covered {
    double pixel[stretch], centre[stretch], wide[stretch], narrow[stretch], per_wide[stretch], steepness[stretch],
        near_end[stretch], far_end[stretch], nearest[stretch], size[stretch], strength_range[stretch];

    Footprint footprint(int i) const {
        return {pixel[i],     centre[i],   wide[i],    narrow[i],  per_wide[i],
                steepness[i], near_end[i], far_end[i], nearest[i], size[i]};
    }
};

/** The trapezoid of inverse ranges that a cell covers of a plane n.p = D: n.d / D is linear in azimuth and elevation
 *  but for the curvature of sine and cosine. Closer to edge-on than 1e-4 rad there is no echo, but still a shadow. */
INSONIFY_VECTOR_CLONES void cover(const Cells& cells, int count, double near_edge, double far_edge,
                                  Covered& __restrict covered) {
    for (int i = 0; i < count; ++i) {
        const double n_x = cells.normal_x[i], n_y = cells.normal_y[i], n_z = cells.normal_z[i];
        const double normal = sqrt(n_x * n_x + n_y * n_y + n_z * n_z), distance = cells.distance[i];
        const double ahead = n_x * cells.cos_az[i] + n_y * cells.sin_az[i];
        const double aside = n_y * cells.cos_az[i] - n_x * cells.sin_az[i];
        const double facing = ahead * cells.cos_el[i] + n_z * cells.sin_el[i];
        const bool echo = abs(facing) > 1e-4 * normal && distance * facing > 0.0;
        const double per_distance = echo ? 1.0 / distance : 0.0;
        const double inverse_range = facing * per_distance;
        // 1/r is a sinusoid of either angle, so its mean over the cell is a little less than at its middle.
        const double sag = (cells.width[i] * cells.width[i] * ahead * cells.cos_el[i] * per_distance +
                            cells.height[i] * cells.height[i] * inverse_range) *
                           (1.0 / 24.0);
        const double slope_a = aside * cells.cos_el[i] * per_distance;
        const double slope_e = (n_z * cells.cos_el[i] - ahead * cells.sin_el[i]) * per_distance;
        const double perpendicular = echo ? abs(distance) / normal : 0.0;
        const Footprint cell = trapezoidFootprint(inverse_range, inverse_range - sag, abs(slope_a) * cells.width[i],
                                                  abs(slope_e + slope_a * cells.lean[i]) * cells.height[i],
                                                  echo ? 1.0 / perpendicular : 0.0, cells.near_limit[i],
                                                  cells.far_limit[i], near_edge, far_edge, echo ? cells.size[i] : 0.0);
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
        const double cosine_range = cells.mapped[i] > 0.0 && echo ? cells.mapped[i] / inverse_range : perpendicular;
        covered.strength_range[i] = cells.strength[i] * cosine_range;
    }
}

/** The strength of what does not follow Lambert's law. */
void applyLaws(const EchoRules& rules, const Cells& cells, int count, Covered& covered) {
    for (int i = 0; i < count; ++i) {
        if (rules.laws.followsLambert(cells.material[i]) || !(covered.pixel[i] > 0)) continue;
        const double normal = sqrt(cells.normal_x[i] * cells.normal_x[i] + cells.normal_y[i] * cells.normal_y[i] +
                                   cells.normal_z[i] * cells.normal_z[i]);
        const double cosine =
            cells.mapped[i] > 0 ? cells.mapped[i] : min(abs(cells.distance[i]) * covered.pixel[i] / normal, 1.0);
        covered.strength_range[i] = rules.strength_scale / covered.pixel[i] *
                                    rules.laws.overCosine(cells.material[i], cosine, cells.facet_slope[i],
                                                          max(cells.width[i], cells.height[i]));
    }
}

/** From where and at which angle sound meets the middle of each cell. */
INSONIFY_VECTOR_CLONES void regard(const Cells& cells, int count, CellTruths<stretch>& __restrict shown) {
    for (int i = 0; i < count; ++i) {
        const double n_x = cells.normal_x[i], n_y = cells.normal_y[i], n_z = cells.normal_z[i];
        const double facing = (n_x * cells.cos_az[i] + n_y * cells.sin_az[i]) * cells.cos_el[i] + n_z * cells.sin_el[i];
        shown.sine_elevation[i] = cells.sin_el[i];
        shown.sine_grazing[i] = abs(facing) / sqrt(n_x * n_x + n_y * n_y + n_z * n_z);
    }
}

/** Whether an estimator sums the fields of scatterers. */
template <class Estimator>
constexpr bool sums_fields = Estimator::features.has(Feature::Speckle);

template <class Estimator>
Estimator makeEstimator(const EchoRules& rules, uint64_t* sums, [[maybe_unused]] const TruthSink* truth) {
    if constexpr (sums_fields<Estimator>)
        return {rules, sums};
    else
        return {rules, sums, truth};
}

/** Where in the view, and of which object, a cell is. */
struct CellPlace {
    size_t left, right;  ///< Its edges in AngularView::bearings.
    size_t low, high;    ///< In AngularView::elevations.
    int first, last;     ///< Its columns.
    uint32_t object;
};

/** Makes cells of tiles, a stretch at a time. */
template <class Estimator, bool conical, bool normal_maps>
class CellDeposit {
public:
    static constexpr Features features() {
        Features all = Estimator::features;
        if (conical) all.add(Feature::Conical);
        if (normal_maps) all.add(Feature::NormalMap);
        return all;
    }

    CellDeposit(const EchoRules& rules, const CastView& view, const PlacedScene& scene, int first_beam, uint64_t* sums,
                const TruthSink* truth)
        : rules_(rules),
          view_(view.cells),
          shape_(view.shape),
          scene_(scene),
          first_beam_(first_beam),
          sums_(sums),
          estimator_(makeEstimator<Estimator>(rules, sums, truth)) {}

    void add(const CastTile& tile) {
        for (int i = 0; i < tile_samples;) {
            const bool met = tile.hits->command[i] != TileHits::nothing;
            const int merged = met ? sameFrom(*tile.hits, i) : 1;
            if (met)
                addCell(tile, i, merged);
            else if (rules_.features.has(Feature::VolumeLayers))
                hearPast(tile, i);
            i += merged;
        }
    }
    void finish() {
        cover(cells_, count_, rules_.edges.front(), rules_.edges[static_cast<size_t>(rules_.bins.bin_count)], covered_);
        if (rules_.features.has(Feature::BackscatterLaws)) applyLaws(rules_, cells_, count_, covered_);
        if (scene_.paths && rules_.features.has(Feature::Physical))
            for (int i = 0; i < count_; ++i) covered_.strength_range[i] *= cells_.focus[i];
        if constexpr (Estimator::tells_truth) regard(cells_, count_, shown_);
        for (int i = 0; i < count_; ++i) {
            if constexpr (Estimator::tells_truth) estimator_.regard(shown_.get(i));
            const auto beam = static_cast<uint>(cells_.beam[i] - first_beam_);
            if constexpr (!sums_fields<Estimator>)
                estimator_.depositCell(covered_.footprint(i), beam, covered_.strength_range[i]);
            else if (covered_.pixel[i] > 0 && cells_.width[i] > 0)  // beyond a cone's end there is no direction
                estimator_.deposit(patchOf(i), beam);
        }
        if (rules_.features.has(Feature::VolumeLayers))
            hideVolume<LayeredVolume>();
        else if (rules_.features.has(Feature::Volume))
            hideVolume<OpenVolume>();
        count_ = 0;
    }

private:
    /** How steeply the middle of a cell goes up in the world [m for each m]. */
    double riseOf(int i) const {
        const glm::dvec3& up = scene_.water.up;
        return cells_.cos_el[i] * (up.x * cells_.cos_az[i] + up.y * cells_.sin_az[i]) + up.z * cells_.sin_el[i];
    }

    Patch patchOf(int i) const {
        const CellPlace& place = places_[i];
        const AngularView::Elevation &low = view_.elevations[place.low], &high = view_.elevations[place.high];
        const auto direction = [&](size_t side, const AngularView::Elevation& up) {
            const AngularView::Direction around =
                conical ? AngularView::azimuthOf(view_.bearings[side], up) : view_.azimuths[side];
            return glm::dvec3(up.cosine * around.cosine, up.cosine * around.sine, up.sine);
        };
        Patch patch{{cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]},
                    cells_.distance[i],
                    {cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i], cells_.sin_el[i]},
                    {direction(place.left, low), direction(place.left, high), direction(place.right, high),
                     direction(place.right, low)},
                    view_.azimuths[place.left],
                    view_.azimuths[place.right],
                    1,
                    {},
                    low.sine,
                    high.sine,
                    cells_.width[i],
                    cells_.height[i],
                    covered_.strength_range[i],
                    cells_.size[i] / (cells_.width[i] * (high.sine - low.sine)),
                    scene_.objects[place.object],
                    place.object,
                    conical};
        for (int column = place.first + 1; column <= place.last; ++column)
            if (view_.beam_of[static_cast<size_t>(column)] != view_.beam_of[static_cast<size_t>(column) - 1])
                patch.next_bearings[patch.beams++ - 1] = view_.azimuths[view_.at(column)];
        return patch;
    }

    template <class Volume>
    void hideVolume() {
        Volume volume(rules_, scene_.water.height, sums_);
        for (int i = 0; i < count_; ++i)
            if (covered_.pixel[i] > 0)
                volume.hideVolume(covered_.footprint(i), static_cast<uint>(cells_.beam[i] - first_beam_), riseOf(i),
                                  cells_.size[i]);
            else if constexpr (Volume::hears_misses)
                volume.hearLayers(static_cast<uint>(cells_.beam[i] - first_beam_), riseOf(i), rules_.bins.range_max,
                                  cells_.size[i]);
    }

    /** A sample that meets nothing hears all layers that it goes through. */
    void hearPast(const CastTile& tile, int sample) {
        const int column = tile.first_column + shape_.at[sample].columns;
        if (column >= view_.columns() || tile.first_row + shape_.at[sample].rows >= view_.rows) return;
        aim(tile, sample, 1);
        LayeredVolume volume(rules_, scene_.water.height, sums_);
        volume.hearLayers(static_cast<uint>(cells_.beam[count_] - first_beam_), riseOf(count_), rules_.bins.range_max,
                          cells_.size[count_]);
    }

    /** Samples from i on that are a rectangle of one triangle in one beam. */
    int sameFrom(const TileHits& hits, int i) const {
        const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
        const int largest = sums_fields<Estimator> ? shape_.max_patch : shape_.max_merged;
        const int most = scene_.paths ? 1 : std::min(static_cast<int>(alignment), largest);
        int run = 1;
        while (run < most && hits.triangle[i + run] == hits.triangle[i] && hits.command[i + run] == hits.command[i])
            ++run;
        return static_cast<int>(std::bit_floor(static_cast<uint32_t>(run)));
    }

    void addCell(const CastTile& tile, int sample, int merged) {
        const PlacedRun& run = scene_.ranges[tile.hits->command[sample]];
        const PlaneRecord& plane = scene_.planes[run.first_triangle + tile.hits->triangle[sample]];
        const glm::dvec3 n(plane.normal), p(plane.point);
        const auto turned = [&](const double* row) { return row[0] * n.x + row[1] * n.y + row[2] * n.z; };
        const double x = turned(run.normal_x), y = turned(run.normal_y), z = turned(run.normal_z);
        const int i = count_;
        cells_.normal_x[i] = x;
        cells_.normal_y[i] = y;
        cells_.normal_z[i] = z;
        cells_.distance[i] = n.x * (p.x - run.eye[0]) + n.y * (p.y - run.eye[1]) + n.z * (p.z - run.eye[2]) +
                             static_cast<double>(plane.normal.w);
        cells_.strength[i] = run.strength;
        cells_.facet_slope[i] = static_cast<double>(plane.point.w);
        cells_.material[i] = run.material;
        cells_.near_limit[i] = run.near_limit;
        cells_.far_limit[i] = run.far_limit;
        aim(tile, sample, merged);
        if constexpr (sums_fields<Estimator>) places_[i].object = scene_.commands[tile.hits->command[sample]].object;
        if (normal_maps) cells_.mapped[i] = mappedCosine(tile, sample, merged);
        if (scene_.paths)
            bend(static_cast<double>(tile.hits->range[sample]),
                 scene_.paths->drift(scene_.commands[tile.hits->command[sample]].object));
        if constexpr (Estimator::tells_truth) {
            shown_.object[i] = scene_.commands[tile.hits->command[sample]].object;
            shown_.hits[i] = static_cast<uint32_t>(merged);
        }
        if (++count_ == stretch) finish();
    }

    /** Puts the plane that the cell seems to be of, at about a range [m], in the place of the true one. */
    void bend(double range, const Drift* drift) {
        const int i = count_;
        const glm::dvec3 ray(cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i],
                             cells_.sin_el[i]);
        const ApparentPlane plane = scene_.paths->apparent({cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]},
                                                           cells_.distance[i], ray, range, drift);
        cells_.normal_x[i] = plane.normal.x;
        cells_.normal_y[i] = plane.normal.y;
        cells_.normal_z[i] = plane.normal.z;
        cells_.distance[i] = 1;
        cells_.focus[i] = plane.focus;
        if (!normal_maps || !(cells_.mapped[i] > 0)) cells_.mapped[i] = plane.cosine;
        cells_.near_limit[i] = scene_.paths->nearLimit(cells_.near_limit[i]);
        cells_.far_limit[i] = 0;  // bent rays may take any way round
    }

    /** Of the middle of the cell that aim() has just put down; 0 where its material has no map. */
    double mappedCosine(const CastTile& tile, int sample, int merged) const {
        const CommandRecord& command = scene_.commands[tile.hits->command[sample]];
        if (!scene_.normal_maps.isMapped(static_cast<int>(command.material))) return 0;
        const int i = count_;
        float u = 0, v = 0;
        for (int k = sample; k < sample + merged; ++k) u += tile.hits->u[k], v += tile.hits->v[k];
        const auto per_sample = 1 / static_cast<float>(merged);
        const glm::dvec3 ray(cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i],
                             cells_.sin_el[i]);
        const glm::dvec3 normal(cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]);
        const double range = std::abs(cells_.distance[i]) / std::max(std::abs(glm::dot(normal, ray)), 1e-6);
        return static_cast<double>(scene_.normal_maps.cosine(
            scene_.objects[command.object],
            {command.object, tile.hits->triangle[sample], static_cast<int>(command.material), u * per_sample,
             v * per_sample, glm::vec3(ray), static_cast<float>(range * std::max(cells_.width[i], cells_.height[i]))}));
    }

    /** Direction, extent and solid angle of a cell of `merged` samples. */
    void aim(const CastTile& tile, int sample, int merged) {
        const AngularView& view = view_;
        const int column = tile.first_column + shape_.at[sample].columns, i = count_;
        const int across = shape_.size[merged].columns, last = column + across - 1;
        const size_t left = view.at(column), right = view.at(last) + 2;
        const size_t middle = across > 1 ? view.at(column + across / 2) : left + 1;
        const size_t low = 2 * static_cast<size_t>(tile.first_row + shape_.at[sample].rows);
        const auto up = static_cast<size_t>(shape_.size[merged].rows);
        cells_.beam[i] = view.beam_of[static_cast<size_t>(column)];
        const AngularView::Elevation& elevation = view.elevations[low + up];
        cells_.cos_el[i] = elevation.cosine;
        cells_.sin_el[i] = elevation.sine;
        cells_.height[i] = view.height(low / 2, up);
        if (conical) {
            const double at = elevation.angle;
            const double azimuth = coneAzimuth(view.bearings[middle], at);
            cells_.cos_az[i] = std::cos(azimuth);
            cells_.sin_az[i] = std::sin(azimuth);
            cells_.width[i] = coneAzimuth(view.bearings[right], at) - coneAzimuth(view.bearings[left], at);
            cells_.lean[i] = std::abs(azimuth) < 1.5 ? std::tan(azimuth) * elevation.sine / elevation.cosine : 0;
        } else {
            cells_.cos_az[i] = view.azimuths[middle].cosine;
            cells_.sin_az[i] = view.azimuths[middle].sine;
            cells_.width[i] = view.bearings[right] - view.bearings[left];
            cells_.lean[i] = 0;
        }
        if constexpr (sums_fields<Estimator>) places_[i] = {left, right, low, low + 2 * up, column, last, 0};
        cells_.size[i] =
            cells_.width[i] * (view.elevations[low + 2 * up].weighted - view.elevations[low].weighted) / view.cell();
    }

    const EchoRules& rules_;
    const AngularView& view_;
    const TileShape& shape_;
    const PlacedScene& scene_;
    int first_beam_;
    uint64_t* sums_;
    Estimator estimator_;
    int count_ = 0;
    Cells cells_{};
    Covered covered_{};
    CellTruths<Estimator::tells_truth ? stretch : 1> shown_{};
    CellPlace places_[sums_fields<Estimator> ? stretch : 1] = {};
};

/** Calls use.operator()<Deposit>() with the CellDeposit of an estimator for the fan and the materials of a plan. */
template <class Estimator, class Use>
void withCellsOf(const Features& features, const Use& use) {
    const bool conical = features.has(Feature::Conical), mapped = features.has(Feature::NormalMap);
    if (conical && mapped)
        use.template operator()<CellDeposit<Estimator, true, true>>();
    else if (conical)
        use.template operator()<CellDeposit<Estimator, true, false>>();
    else if (mapped)
        use.template operator()<CellDeposit<Estimator, false, true>>();
    else
        use.template operator()<CellDeposit<Estimator, false, false>>();
}

/** The same with the estimator of energies that has the features of a plan. */
template <template <class> class Telling, class Use>
void withCells(const Features& features, const Use& use) {
    withEstimator<Features{Feature::Published, Feature::Nearest}>(
        features, [&]<class Deposited>() { withCellsOf<Telling<Deposited>>(features, use); });
}

void depositFields(const EchoRules& rules, const CastView& view, const PlacedScene& scene,
                   std::span<const CastTile> tiles, int first_beam, uint64_t* sums) {
    withCellsOf<Scatterers>(rules.features, [&]<class Deposit>() {
        Deposit cells(rules, view, scene, first_beam, sums, nullptr);
        for (const CastTile& tile : tiles) cells.add(tile);
        cells.finish();
    });
}

}  // namespace

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void deposit(const EchoRules& rules, const CastView& view,
                                                             const PlacedScene& scene, std::span<const CastTile> tiles,
                                                             int first_beam, uint64_t* sums) {
    if (rules.features.has(Feature::Speckle)) return depositFields(rules, view, scene, tiles, first_beam, sums);
    withCells<Untold>(rules.features, [&]<class Deposit>() {
        Deposit cells(rules, view, scene, first_beam, sums, nullptr);
        for (const CastTile& tile : tiles) cells.add(tile);
        cells.finish();
    });
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositAndTell(const EchoRules& rules, const CastView& view,
                                                                    const PlacedScene& scene,
                                                                    std::span<const CastTile> tiles, int first_beam,
                                                                    uint64_t* sums, const TruthSink& truth) {
    withCells<Told>(rules.features, [&]<class Deposit>() {
        Deposit cells(rules, view, scene, first_beam, sums, &truth);
        for (const CastTile& tile : tiles) cells.add(tile);
        cells.finish();
    });
}

Features compiledForRays(const Features& wanted) {
    Features compiled;
    const auto take = [&]<class Deposit>() { compiled = Deposit::features(); };
    if (wanted.has(Feature::Speckle))
        withCellsOf<Scatterers>(wanted, take);
    else
        withCells<Untold>(wanted, take);
    return compiled;
}

}  // namespace insonify::sonar
