#pragma once
#include <cmath>
#include <span>
#include <vector>

#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/rays/NormalMapping.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/RayVisibility.hpp"

namespace insonify::sonar {

class BinLevels;
class SurfaceMapping;
class WaterTruth;

struct TracedTile;

/** Arrangement of samples. */
struct TracedView {
    AngularView cells;
    TileShape shape;
};

/** Meaning of hits in this ping: commands, each with its triangles rotated into sonar axes. */
struct PlacedScene {
    std::span<const CommandRecord> commands;
    std::span<const PlacedRun> ranges;
    std::span<const ObjectRecord> objects;
    const NormalMapping& normal_maps;
    WaterView water;
    const RayPaths* paths = nullptr;       ///< Null where rays are straight.
    const SurfaceMapping* maps = nullptr;  ///< Null where surfaces have no maps.

    /** Returns the mean of a property of materials over the surface that sample `i` of a tile has hit, times the factor
     *  of its echo by maps. */
    double computeMean(std::span<const double> property, const TracedView& view, const TracedTile& tile, int i) const;
};

/** A traced tile: its place in the view and its hits. */
struct TracedTile {
    int first_column, first_row;
    int end_column;  ///< Samples from this column on are not in the tile: they were not traced, and are not misses.
    TileHits* hits;
    float* passed = nullptr;       ///< Share of each sample's energy that walls let through both ways; null: all [1].
    const float* gains = nullptr;  ///< Factor of each sample's echo by surface maps; null: 1 [1].
    const float* late = nullptr;   ///< Slant range of each sample's echo beyond that of its surface; null: none [m].
    const ApparentPlane* apparent = nullptr;  ///< Apparent surfaces behind refracting fills; null or focus 0: none.
    uint32_t path = 0;                        ///< behind_walls, rung_in_wall (Truth.hpp), or 0.

    /** Returns the mean of `passed` of `count` samples from `first` [1]. */
    double meanPassed(int first, int count) const {
        double sum = 0;
        for (int i = first; i < first + count; ++i) sum += static_cast<double>(passed[i]);
        return sum / count;
    }
    /** Returns the mean factor of `count` samples by surface maps [1]. */
    double meanGain(int first, int count) const {
        if (!gains) return 1;
        double sum = 0;
        for (int i = first; i < first + count; ++i) sum += static_cast<double>(gains[i]);
        return sum / count;
    }
    /** Returns the mean of `late` of `count` samples [m]. */
    double meanLate(int first, int count) const {
        double sum = 0;
        for (int i = first; i < first + count; ++i) sum += static_cast<double>(late[i]);
        return sum / count;
    }
    bool isApparent(int sample) const { return apparent && apparent[sample].focus > 0; }
};

/** A ray-traced ping, at the current quality. */
struct TracedPing {
    const EchoRules& rules;
    const BinLevels& levels;  ///< Intensities of the rules' bins.
    const TracedView& view;
    const RayVisibility& visibility;  ///< Placed in this ping.
    PlacedScene scene;
    const WaterTruth* water = nullptr;  ///< Echoes of the water, for addToTruth(); null: none.
};

/** A rectangle of samples of a view. */
struct SampleRectangle {
    int first_column, columns, first_row, rows;
    size_t left, right;  ///< Its edges in AngularView::bearings.
    size_t low, high;    ///< Its edges in AngularView::elevations.

    SampleRectangle() = default;
    SampleRectangle(const AngularView& view, int column, int across, int row, int up)
        : first_column(column),
          columns(across),
          first_row(row),
          rows(up),
          left(view.at(column)),
          right(view.at(column + across - 1) + 2),
          low(2 * static_cast<size_t>(row)),
          high(low + 2 * static_cast<size_t>(up)) {}
    /** Returns its middle in AngularView::bearings. */
    size_t across(const AngularView& view) const {
        return view.at(first_column + columns / 2) + static_cast<size_t>(columns % 2);
    }
    /** Returns its middle in AngularView::elevations. */
    size_t up() const { return (low + high) / 2; }
};

/** Sets beam, direction and extent of cell i, and its solid angle [sr], which relateSizes() makes relative. */
inline void setLookDirection(const AngularView& view, bool conical, const SampleRectangle& all, int i, Cells& cells) {
    const AngularView::Elevation &up = view.elevations[all.up()], &low = view.elevations[all.low],
                                 &high = view.elevations[all.high];
    const size_t middle = all.across(view);
    cells.beam[i] = view.beam_of[static_cast<size_t>(all.first_column)];
    cells.cos_el[i] = up.cosine;
    cells.sin_el[i] = up.sine;
    cells.height[i] = high.angle - low.angle;
    if (conical) {
        const double azimuth = coneAzimuth(view.bearings[middle], up.angle);
        cells.cos_az[i] = std::cos(azimuth);
        cells.sin_az[i] = std::sin(azimuth);
        cells.width[i] =
            coneAzimuth(view.bearings[all.right], up.angle) - coneAzimuth(view.bearings[all.left], up.angle);
        cells.lean[i] = std::abs(azimuth) < 1.5 ? std::tan(azimuth) * up.sine / up.cosine : 0;
    } else {
        cells.cos_az[i] = view.azimuths[middle].cosine;
        cells.sin_az[i] = view.azimuths[middle].sine;
        cells.width[i] = view.bearings[all.right] - view.bearings[all.left];
        cells.lean[i] = 0;
    }
    cells.size[i] = cells.width[i] * (high.weighted - low.weighted);
}

/** Makes the solid angles of a batch relative to a sample of the middle beam. */
inline void relateSizes(const AngularView& view, Cells& cells) {
    const double unit = view.cell();
    for (int i = 0; i < cells.count; ++i) cells.size[i] /= unit;
}

/** Prefetches the planes of a later tile; they are scattered in memory like its triangles. */
inline void fetchPlanes(const PlacedScene& scene, const TracedTile& tile) {
    for (int i = 0; i < tile_samples; ++i) {
        if (tile.hits->command[i] == TileHits::nothing) continue;
        const PlaneRecord& plane = scene.ranges[tile.hits->command[i]].planes[tile.hits->triangle[i]];
        __builtin_prefetch(&plane.normal);
        __builtin_prefetch(&plane.point);  // in the next line of the cache, perhaps
    }
}

/** Moves the plane of cell i away by a slant range [m], along its direction. */
inline void moveAway(Cells& cells, int i, double late) {
    const double facing =
        (cells.normal_x[i] * cells.cos_az[i] + cells.normal_y[i] * cells.sin_az[i]) * cells.cos_el[i] +
        cells.normal_z[i] * cells.sin_el[i];
    const double range = cells.distance[i] / facing, moved = std::max(range + late, 1e-3);
    cells.distance[i] *= moved / range;
    const auto limit = [&](double inverse) { return inverse > 0 ? 1 / std::max(1 / inverse + late, 1e-3) : 0; };
    cells.near_limit[i] = std::max(cells.near_limit[i], limit(cells.near_limit[i]));
    cells.far_limit[i] = std::min(cells.far_limit[i], limit(cells.far_limit[i]));
}

/** Replaces the plane of cell i by its apparent plane after refraction. */
inline void putApparent(Cells& cells, int i, const ApparentPlane& plane) {
    cells.normal_x[i] = plane.normal.x;
    cells.normal_y[i] = plane.normal.y;
    cells.normal_z[i] = plane.normal.z;
    cells.distance[i] = 1;
    cells.size[i] *= plane.focus;
    cells.mapped[i] = plane.cosine;
    cells.near_limit[i] = 1e3;
    cells.far_limit[i] = 0;
}

/** Adds the energies of tiles to sums. Neighbouring samples of one triangle in one beam may be one cell. Allocates
 *  nothing. */
void depositTiles(const EchoRules& rules, const TracedView& view, const PlacedScene& scene,
                  std::span<const TracedTile> tiles, const EchoSums& to);

/** Adds the fields of tiles to sums, [range cell][real, imaginary] with sign. All samples of a tile that hit the same
 *  triangle are one patch of scatterers. Allocates nothing. */
void depositPatches(const EchoRules& rules, const TracedView& view, const PlacedScene& scene,
                    std::span<const TracedTile> tiles, const EchoSums& to);

/** Places of a batch's cells in normal maps. Their cosines are computed together. */
class MappedCells {
public:
    /** Records the place of cell i: the hits' command, its triangle within the object's mesh, and barycentric
     *  coordinates of the triangle's second and third corner [1]. */
    void place(int i, uint32_t command, uint32_t triangle, float u, float v) {
        command_[i] = command;
        triangle_[i] = triangle;
        u_[i] = u;
        v_[i] = v;
    }
    /** Records that cell i hits nothing. */
    void placeMiss(int i) { command_[i] = TileHits::nothing; }

    /** Sets Cells::mapped of the cells from `first` to before `end` whose materials have maps. */
    void setCosines(const PlacedScene& scene, int first, int end, Cells& cells);

private:
    static_assert(Cells::capacity <= NormalMapping::max_samples);

    uint32_t command_[Cells::capacity], triangle_[Cells::capacity];
    float u_[Cells::capacity], v_[Cells::capacity];
    float x_[Cells::capacity], y_[Cells::capacity], z_[Cells::capacity];  ///< As in NormalMapping::Samples.
    float extent_[Cells::capacity], normal_[Cells::capacity];             ///< As in NormalMapping::Samples.
};

/** Directions of the rays of tiles, from tables for the columns and the rows of tiles. */
class TileDirections {
public:
    TileDirections() = default;
    /** `strip_columns`: the columns of a strip; tiles of one strip have no columns of the next. */
    TileDirections(const TracedView& view, int strip_columns);

    /** Returns the rays of the tile that begins at a column and a row; rays outside of the strip and of the view are
     *  not active. */
    TileRays rays(const AngularView& view, int column, int row) const;

private:
    /** The angles of a tile's samples in one direction. */
    struct Angles {
        alignas(64) double cosine[tile_samples], sine[tile_samples];
        int at[tile_samples];  ///< Column or row in the view.
        uint32_t active = 0;   ///< Bit i: sample i is inside of the strip, or of the view.
    };
    static TileRays product(const Angles& across, const Angles& up);

    TileShape::Extent tile_{1, 1};
    int strip_columns_ = 1;
    size_t tiles_across_ = 1;  ///< Tiles in a strip.
    std::vector<Angles> columns_, rows_;
};

}  // namespace insonify::sonar
