#include "components/sonar/rays/TileCells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/sonar/base/Counters.hpp"
#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Makes cells of tiles, a batch at a time. */
class TileCells {
public:
    TileCells(const EchoRules& rules, const TracedView& view, const PlacedScene& scene, const EchoSums& to)
        : conical_(rules.features.has(Feature::Conical)),
          mapped_(rules.features.has(Feature::NormalMap)),
          has_maps_(rules.has_maps),
          echoes_from_misses_(rules.echoes_from_misses && !to.behind_walls),
          curves_(!rules.features.has(Feature::Speckle) && !scene.paths),
          view_(view.cells),
          shape_(view.shape),
          scene_(scene),
          deposit_(rules, scene.water, scene.paths, to),
          cells_(deposit_.cells),
          max_merged_(scene.paths ? 1 : view.shape.max_merged) {}

    void add(const TracedTile& tile) {
        const uint32_t same = sameAsNext(*tile.hits);
        for (int i = 0; i < tile_samples;) {
            const bool is_hit = tile.hits->command[i] != TileHits::nothing;
            const int merged = is_hit && !tile.apparent ? sameFrom(same, i, getMaxMerged(*tile.hits, i)) : 1;
            if (is_hit)
                addCell(tile, i, merged);
            else if (echoes_from_misses_)
                addMiss(tile, i);
            merged_ += static_cast<uint64_t>(merged - 1);
            i += merged;
        }
    }
    void finish() {
        relateSizes(view_, cells_);
        if (mapped_ && !scene_.paths) in_map_.setCosines(scene_, 0, cells_.count, cells_);
        deposit_.flush();
    }
    uint64_t merged() const { return merged_; }  ///< Samples in the cell of another [1].

private:
    /** Returns the samples, as bits, that have hit the same triangle as the next sample. */
    static uint32_t sameAsNext(const TileHits& hits) {
        uint32_t same = 0;
        for (int i = 0; i + 1 < tile_samples; ++i)
            same |= static_cast<uint32_t>((hits.triangle[i + 1] == hits.triangle[i]) &
                                          (hits.command[i + 1] == hits.command[i]))
                    << i;
        return same;
    }

    /** Returns the max number of samples of a cell at sample i [1]: a cell blurs a normal map over its samples. */
    int getMaxMerged(const TileHits& hits, int i) const {
        constexpr int max_mapped = 2;
        const bool is_mapped =
            mapped_ && scene_.normal_maps.isMapped(static_cast<int>(scene_.commands[hits.command[i]].material));
        return is_mapped ? std::min(max_mapped, max_merged_) : max_merged_;
    }

    /** Returns the number of samples from i that are a rectangle of one triangle in one beam. */
    int sameFrom(uint32_t same, int i, int max_merged) const {
        const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
        const int maximum = std::min(static_cast<int>(alignment), max_merged);
        const int run = std::countr_one(same >> i) + 1;
        return static_cast<int>(std::bit_floor(static_cast<uint32_t>(std::min(run, maximum))));
    }

    void addCell(const TracedTile& tile, int sample, int merged) {
        const PlacedRun& run = scene_.ranges[tile.hits->command[sample]];
        const CommandRecord& command = scene_.commands[tile.hits->command[sample]];
        const uint32_t object = command.object;
        const int i = cells_.count;
        cells_.setPlane(i, run, tile.hits->triangle[sample]);
        look(tile, sample, merged);
        if (tile.passed) cells_.size[i] *= tile.meanPassed(sample, merged);
        if (has_maps_) cells_.gain[i] = tile.meanGain(sample, merged);
        if (tile.isApparent(sample)) putApparent(cells_, i, tile.apparent[sample]);
        if (tile.late) moveAway(cells_, i, tile.meanLate(sample, merged));
        if (!tile.isApparent(sample) && run.curves && curves_)
            cells_.setCurve(i, run.curves[tile.hits->triangle[sample]]);
        if (mapped_) placeInMap(i, *tile.hits, sample, merged);
        if (mapped_ && scene_.paths) in_map_.setCosines(scene_, i, i + 1, cells_);
        if (scene_.paths) {
            Drift own;
            bend(static_cast<double>(tile.hits->range[sample]),
                 scene_.paths->findDrift(object, tile.hits->triangle[sample], own));
        }
        if (deposit_.to().truth) {
            cells_.object[i] = Cells::getObject(object | tile.path, tile.hits->triangle[sample]);
            cells_.hits[i] = static_cast<uint32_t>(merged);
        }
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Adds a miss: only effects process it. */
    void addMiss(const TracedTile& tile, int sample) {
        const int column = tile.first_column + shape_.at[sample].columns, i = cells_.count;
        if (column >= tile.end_column || tile.first_row + shape_.at[sample].rows >= view_.rows) return;
        cells_.setMiss(i);
        cells_.gain[i] = 1;
        in_map_.placeMiss(i);
        look(tile, sample, 1);
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Replaces the true plane by the apparent plane of the cell, at about a range [m]. */
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
        cells_.far_limit[i] = 0;  // bent rays may arrive from any side
    }

    /** Records the mean place of the samples of cell i in their triangle. */
    void placeInMap(int i, const TileHits& hits, int sample, int merged) {
        float u = 0, v = 0;
        for (int k = sample; k < sample + merged; ++k) u += hits.u[k], v += hits.v[k];
        const auto per_sample = 1 / static_cast<float>(merged);
        in_map_.place(i, hits.command[sample], hits.triangle[sample], u * per_sample, v * per_sample);
    }

    /** Sets the look direction of the current cell, with `merged` samples. */
    void look(const TracedTile& tile, int sample, int merged) {
        const TileShape::Extent at = shape_.at[sample], size = shape_.size[merged];
        setLookDirection(view_, conical_,
                         {view_, tile.first_column + at.columns, size.columns, tile.first_row + at.rows, size.rows},
                         cells_.count, cells_);
    }

    bool conical_, mapped_;
    bool has_maps_;  ///< Surface maps, in addition to normal maps.
    bool echoes_from_misses_;
    bool curves_;  ///< Whether smooth bodies curve within a cell: not with fields or bent rays.
    const AngularView& view_;
    const TileShape& shape_;
    const PlacedScene& scene_;
    CellDeposit deposit_;
    Cells& cells_;
    int max_merged_;  ///< Max samples of one cell [1].
    MappedCells in_map_;
    uint64_t merged_ = 0;
};

}  // namespace

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositTiles(const EchoRules& rules, const TracedView& view,
                                                                  const PlacedScene& scene,
                                                                  std::span<const TracedTile> tiles,
                                                                  const EchoSums& to) {
    TileCells cells(rules, view, scene, to);
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (i + 2 < tiles.size()) fetchPlanes(scene, tiles[i + 2]);
        cells.add(tiles[i]);
    }
    cells.finish();
    count(Counter::SamplesMerged, cells.merged());
}

INSONIFY_VECTOR_CLONES void MappedCells::setCosines(const PlacedScene& scene, int first, int end, Cells& cells) {
    for (int i = first; i < end; ++i) {
        const double x = cells.cos_el[i] * cells.cos_az[i], y = cells.cos_el[i] * cells.sin_az[i], z = cells.sin_el[i];
        const double nx = cells.normal_x[i], ny = cells.normal_y[i], nz = cells.normal_z[i];
        const double facing = std::abs(nx * x + ny * y + nz * z), larger = facing > 1e-6 ? facing : 1e-6;
        // Along the plane, a step across the ray is longer by the part of it that is along the normal.
        const double aside = (ny * cells.cos_az[i] - nx * cells.sin_az[i]) / larger,
                     above = (nz * cells.cos_el[i] - (nx * cells.cos_az[i] + ny * cells.sin_az[i]) * cells.sin_el[i]) /
                             larger;
        const double across = cells.width[i] * cells.cos_el[i] * std::sqrt(1 + aside * aside),
                     up = cells.height[i] * std::sqrt(1 + above * above);
        x_[i] = static_cast<float>(x);
        y_[i] = static_cast<float>(y);
        z_[i] = static_cast<float>(z);
        extent_[i] = static_cast<float>(std::abs(cells.distance[i]) / larger * (across > up ? across : up));
        normal_[i] = static_cast<float>(std::sqrt(nx * nx + ny * ny + nz * nz));
    }
    for (int i = first, next; i < end; i = next) {
        for (next = i + 1; next < end && command_[next] == command_[i];) ++next;
        if (command_[i] == TileHits::nothing) continue;
        const CommandRecord& command = scene.commands[command_[i]];
        const auto material = static_cast<int>(command.material);
        if (!scene.normal_maps.isMapped(material)) continue;
        scene.normal_maps.cosines(
            scene.objects[command.object], command.object, material,
            {next - i, triangle_ + i, u_ + i, v_ + i, x_ + i, y_ + i, z_ + i, extent_ + i, normal_ + i},
            cells.mapped + i);
    }
}

TileDirections::TileDirections(const TracedView& view, int strip_columns)
    : tile_(view.shape.all),
      strip_columns_(strip_columns),
      tiles_across_(static_cast<size_t>((strip_columns + tile_.columns - 1) / tile_.columns)) {
    const AngularView& cells = view.cells;
    for (int strip = 0; strip < cells.columns(); strip += strip_columns) {
        const int end = std::min(strip + strip_columns, cells.columns());
        for (int first = strip; first < strip + strip_columns; first += tile_.columns) {
            Angles& angles = columns_.emplace_back();
            for (int i = 0; i < tile_samples; ++i) {
                const int column = first + view.shape.at[i].columns;
                angles.at[i] = std::min(column, end - 1);
                angles.active |= static_cast<uint32_t>(column < end) << i;
                const AngularView::Direction& azimuth = cells.azimuths[cells.at(angles.at[i]) + 1];
                angles.cosine[i] = azimuth.cosine;
                angles.sine[i] = azimuth.sine;
            }
        }
    }
    for (int first = 0; first < cells.rows; first += tile_.rows) {
        Angles& angles = rows_.emplace_back();
        for (int i = 0; i < tile_samples; ++i) {
            const int row = first + view.shape.at[i].rows;
            angles.at[i] = std::min(row, cells.rows - 1);
            angles.active |= static_cast<uint32_t>(row < cells.rows) << i;
            const AngularView::Elevation& elevation = cells.elevations[static_cast<size_t>(2 * angles.at[i] + 1)];
            angles.cosine[i] = elevation.cosine;
            angles.sine[i] = elevation.sine;
        }
    }
}

INSONIFY_VECTOR_CLONES TileRays TileDirections::product(const Angles& across, const Angles& up) {
    TileRays rays;
    for (int i = 0; i < tile_samples; ++i) {
        rays.x[i] = static_cast<float>(up.cosine[i] * across.cosine[i]);
        rays.y[i] = static_cast<float>(up.cosine[i] * across.sine[i]);
        rays.z[i] = static_cast<float>(up.sine[i]);
    }
    return rays;
}

TileRays TileDirections::rays(const AngularView& view, int column, int row) const {
    INSONIFY_CHECK(row >= 0 && static_cast<size_t>(row / tile_.rows) < rows_.size(), row, tile_.rows, rows_.size());
    INSONIFY_CHECK(column >= 0 && static_cast<size_t>(column / strip_columns_ + 1) * tiles_across_ <= columns_.size(),
                   column, strip_columns_, columns_.size());
    const auto tile = static_cast<size_t>(column % strip_columns_ / tile_.columns);
    const Angles& across = columns_[static_cast<size_t>(column / strip_columns_) * tiles_across_ + tile];
    const Angles& up = rows_[static_cast<size_t>(row / tile_.rows)];
    TileRays rays = product(across, up);
    rays.active = across.active & up.active;
    const glm::vec3 first(rays.x[0], rays.y[0], rays.z[0]);
    INSONIFY_CHECK(std::abs(glm::length(first) - 1) < 1e-5f, first);
    if (!view.conical) return rays;
    for (int i = 0; i < tile_samples; ++i) {
        const glm::vec3 ray(view.direction(across.at[i], up.at[i]));
        rays.x[i] = ray.x;
        rays.y[i] = ray.y;
        rays.z[i] = ray.z;
    }
    return rays;
}

}  // namespace insonify::sonar
