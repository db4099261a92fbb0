#include "components/sonar/rays/TileCells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "components/sonar/field/Scatterers.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

using std::abs, std::sqrt;

/** Where in the view, and of which object, a cell is. */
struct CellPlace {
    size_t left, right;  ///< Its edges in AngularView::bearings.
    size_t low, high;    ///< In AngularView::elevations.
    int first, last;     ///< Its columns.
    uint32_t object, lattice;
};

/** Where cells lie in normal maps, for NormalMapping::cosines(). */
struct PlacesInMaps {
    uint32_t command[Cells::capacity], triangle[Cells::capacity];
    float u[Cells::capacity], v[Cells::capacity], x[Cells::capacity], y[Cells::capacity], z[Cells::capacity],
        extent[Cells::capacity], normal[Cells::capacity];

    NormalMapping::Samples from(int i, int count) const {
        return {count, triangle + i, u + i, v + i, x + i, y + i, z + i, extent + i, normal + i};
    }
};
static_assert(Cells::capacity <= NormalMapping::max_samples);

/** Makes cells of tiles, a batch at a time. */
class TileCells {
public:
    TileCells(const EchoRules& rules, const CastView& view, const PlacedScene& scene, const EchoSums& to)
        : conical_(rules.features.has(Feature::Conical)),
          mapped_(rules.features.has(Feature::NormalMap)),
          hears_misses_(rules.hears_misses),
          view_(view.cells),
          shape_(view.shape),
          scene_(scene),
          deposit_(rules, scene.water, scene.paths, to),
          cells_(deposit_.cells) {
        if (rules.features.has(Feature::Speckle)) fields_.emplace(rules, to.sums);
        max_merged_ = scene.paths ? 1 : fields_ ? shape_.max_patch : shape_.max_merged;
    }

    /** Asks for the planes that the next tile needs, which are wherever its triangles are in memory. */
    void fetchFor(const CastTile& tile) const {
        for (int i = 0; i < tile_samples; ++i) {
            if (tile.hits->command[i] == TileHits::nothing) continue;
            const PlaneRecord& plane = scene_.ranges[tile.hits->command[i]].planes[tile.hits->triangle[i]];
            __builtin_prefetch(&plane.normal);
            __builtin_prefetch(&plane.point);  // in the next line of the cache, perhaps
        }
    }

    void add(const CastTile& tile) {
        const uint32_t same = sameAsNext(*tile.hits);
        for (int i = 0; i < tile_samples;) {
            const bool met = tile.hits->command[i] != TileHits::nothing;
            const int merged = met ? sameFrom(same, i) : 1;
            if (met)
                addCell(tile, i, merged);
            else if (hears_misses_)
                addMiss(tile, i);
            i += merged;
        }
    }
    void finish() {
        const double unit = view_.cell();
        for (int i = 0; i < cells_.count; ++i) cells_.size[i] /= unit;
        if (mapped_ && !scene_.paths) mapCosines(0, cells_.count);
        if (!fields_) return deposit_.flush();
        deposit_.cover();
        for (int i = 0; i < cells_.count; ++i)
            if (deposit_.covered.pixel[i] > 0 && cells_.width[i] > 0)  // beyond a cone's end there is no direction
                fields_->deposit(patchOf(i), static_cast<uint>(cells_.beam[i] - deposit_.to().first_beam));
        deposit_.finish();
    }

private:
    Patch patchOf(int i) const {
        const CellPlace& place = places_[i];
        const AngularView::Elevation &low = view_.elevations[place.low], &high = view_.elevations[place.high];
        const auto direction = [&](size_t side, const AngularView::Elevation& up) {
            const AngularView::Direction around =
                conical_ ? AngularView::azimuthOf(view_.bearings[side], up) : view_.azimuths[side];
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
                    deposit_.covered.strength_range[i],
                    cells_.size[i] / (cells_.width[i] * (high.sine - low.sine)),
                    scene_.objects[place.object],
                    place.lattice,
                    conical_};
        for (int column = place.first + 1; column <= place.last; ++column)
            if (view_.beam_of[static_cast<size_t>(column)] != view_.beam_of[static_cast<size_t>(column) - 1])
                patch.next_bearings[patch.beams++ - 1] = view_.azimuths[view_.at(column)];
        return patch;
    }

    /** Bit i: samples i and i + 1 have met the same triangle. */
    static uint32_t sameAsNext(const TileHits& hits) {
        uint32_t same = 0;
        for (int i = 0; i + 1 < tile_samples; ++i)
            same |= static_cast<uint32_t>((hits.triangle[i + 1] == hits.triangle[i]) &
                                          (hits.command[i + 1] == hits.command[i]))
                    << i;
        return same;
    }

    /** Samples from i on that are a rectangle of one triangle in one beam. */
    int sameFrom(uint32_t same, int i) const {
        const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
        const int most = std::min(static_cast<int>(alignment), max_merged_);
        const int run = std::countr_one(same >> i) + 1;
        return static_cast<int>(std::bit_floor(static_cast<uint32_t>(std::min(run, most))));
    }

    void addCell(const CastTile& tile, int sample, int merged) {
        const PlacedRun& run = scene_.ranges[tile.hits->command[sample]];
        const CommandRecord& command = scene_.commands[tile.hits->command[sample]];
        const uint32_t object = command.object;
        const int i = cells_.count;
        cells_.setPlane(i, run, tile.hits->triangle[sample]);
        aim(tile, sample, merged);
        if (fields_) places_[i].object = object, places_[i].lattice = command.lattice;
        if (mapped_) placeInMap(i, *tile.hits, sample, merged);
        if (mapped_ && scene_.paths) mapCosines(i, i + 1);
        if (scene_.paths) bend(static_cast<double>(tile.hits->range[sample]), scene_.paths->drift(object));
        if (deposit_.to().truth) {
            cells_.object[i] = object;
            cells_.hits[i] = static_cast<uint32_t>(merged);
        }
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Adds a sample that meets nothing: effects alone hear it. */
    void addMiss(const CastTile& tile, int sample) {
        const int column = tile.first_column + shape_.at[sample].columns, i = cells_.count;
        if (column >= tile.end_column || tile.first_row + shape_.at[sample].rows >= view_.rows) return;
        cells_.setMiss(i);
        in_map_.command[i] = TileHits::nothing;
        aim(tile, sample, 1);
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Puts the plane that the cell seems to be of, at about a range [m], in the place of the true one. */
    void bend(double range, const Drift* drift) {
        const int i = cells_.count;
        const glm::dvec3 ray(cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i],
                             cells_.sin_el[i]);
        const ApparentPlane plane = scene_.paths->apparent({cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]},
                                                           cells_.distance[i], ray, range, drift);
        cells_.normal_x[i] = plane.normal.x;
        cells_.normal_y[i] = plane.normal.y;
        cells_.normal_z[i] = plane.normal.z;
        cells_.distance[i] = 1;
        cells_.focus[i] = plane.focus;
        if (!mapped_ || !(cells_.mapped[i] > 0)) cells_.mapped[i] = plane.cosine;
        cells_.near_limit[i] = scene_.paths->nearLimit(cells_.near_limit[i]);
        cells_.far_limit[i] = 0;  // bent rays may take any way round
    }

    /** Writes down where the samples of cell i lie in their triangle, in the mean. */
    void placeInMap(int i, const TileHits& hits, int sample, int merged) {
        float u = 0, v = 0;
        for (int k = sample; k < sample + merged; ++k) u += hits.u[k], v += hits.v[k];
        const auto per_sample = 1 / static_cast<float>(merged);
        in_map_.command[i] = hits.command[sample];
        in_map_.triangle[i] = hits.triangle[sample];
        in_map_.u[i] = u * per_sample;
        in_map_.v[i] = v * per_sample;
    }

    /** Sets the cosines of cells from `first` to before `end` whose materials have maps. */
    void mapCosines(int first, int end) {
        for (int i = first; i < end; ++i) {
            const double x = cells_.cos_el[i] * cells_.cos_az[i], y = cells_.cos_el[i] * cells_.sin_az[i],
                         z = cells_.sin_el[i];
            const double nx = cells_.normal_x[i], ny = cells_.normal_y[i], nz = cells_.normal_z[i];
            const double facing = abs(nx * x + ny * y + nz * z), larger = facing > 1e-6 ? facing : 1e-6;
            const double extent = cells_.width[i] > cells_.height[i] ? cells_.width[i] : cells_.height[i];
            in_map_.x[i] = static_cast<float>(x);
            in_map_.y[i] = static_cast<float>(y);
            in_map_.z[i] = static_cast<float>(z);
            in_map_.extent[i] = static_cast<float>(abs(cells_.distance[i]) / larger * extent);
            in_map_.normal[i] = static_cast<float>(sqrt(nx * nx + ny * ny + nz * nz));
        }
        for (int i = first, next; i < end; i = next) {
            const uint32_t number = in_map_.command[i];
            for (next = i + 1; next < end && in_map_.command[next] == number;) ++next;
            if (number == TileHits::nothing) continue;
            const CommandRecord& command = scene_.commands[number];
            if (!scene_.normal_maps.isMapped(static_cast<int>(command.material))) continue;
            scene_.normal_maps.cosines(scene_.objects[command.object], command.object,
                                       static_cast<int>(command.material), in_map_.from(i, next - i),
                                       cells_.mapped + i);
        }
    }

    /** Direction, extent and solid angle [sr], which finish() makes relative, of a cell of `merged` samples. */
    void aim(const CastTile& tile, int sample, int merged) {
        const AngularView& view = view_;
        const int column = tile.first_column + shape_.at[sample].columns, i = cells_.count;
        const int across = shape_.size[merged].columns, last = column + across - 1;
        const size_t left = view.at(column), right = view.at(last) + 2;
        const size_t middle = view.at(column + across / 2) + (across == 1);
        const size_t low = 2 * static_cast<size_t>(tile.first_row + shape_.at[sample].rows);
        const auto up = static_cast<size_t>(shape_.size[merged].rows);
        cells_.beam[i] = view.beam_of[static_cast<size_t>(column)];
        const AngularView::Elevation& elevation = view.elevations[low + up];
        cells_.cos_el[i] = elevation.cosine;
        cells_.sin_el[i] = elevation.sine;
        cells_.height[i] = view.height(low / 2, up);
        if (conical_) {
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
        if (fields_) places_[i] = {left, right, low, low + 2 * up, column, last, 0, 0};
        cells_.size[i] = cells_.width[i] * (view.elevations[low + 2 * up].weighted - view.elevations[low].weighted);
    }

    bool conical_, mapped_, hears_misses_;
    int max_merged_;  ///< Samples of one cell.
    const AngularView& view_;
    const TileShape& shape_;
    const PlacedScene& scene_;
    CellDeposit deposit_;
    Cells& cells_;
    std::optional<Scatterers> fields_;  ///< None where energies are summed.
    CellPlace places_[Cells::capacity];
    PlacesInMaps in_map_;
};

}  // namespace

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositTiles(const EchoRules& rules, const CastView& view,
                                                                  const PlacedScene& scene,
                                                                  std::span<const CastTile> tiles, const EchoSums& to) {
    TileCells cells(rules, view, scene, to);
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (i + 2 < tiles.size()) cells.fetchFor(tiles[i + 2]);
        cells.add(tiles[i]);
    }
    cells.finish();
}

}  // namespace insonify::sonar
