#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** Sampling of a fan by rays: cells in azimuth and elevation of the sonar frame, with the same number of columns for
 *  each beam. No column belongs to two beams. Up to 180 deg of elevation. With conical beams, the columns of a row
 *  follow its cones. */
struct AngularView {
    /** An angle. */
    struct Direction {
        double cosine, sine;
    };

    struct Elevation : Direction {
        double angle;     ///< [rad]
        double weighted;  ///< Integral of its cosine times the elevation pattern; `sine` without a pattern.
    };

    int beams = 0;
    int beam_columns = 0;  ///< Columns of each beam [1].
    int rows = 0;          ///< Counted upwards [1].
    bool conical = false;
    bool joined = true;        ///< Each beam begins where the one before it ends.
    bool weighted = false;     ///< Whether a pattern in elevation applies.
    double column_width = 0;   ///< Width of the middle beam's columns, in bearing [rad].
    double row_height = 0;     ///< Height of the tallest row [rad].
    std::vector<int> beam_of;  ///< Beam of each column, beam after beam [1].
    /** Elevations at the lower edge, the middle and the upper edge of each row: row i has 2 i, 2 i + 1 and 2 i + 2. */
    std::vector<Elevation> elevations;
    /** Bearings of each beam's columns, likewise, from at(column) [rad]. */
    std::vector<double> bearings;
    std::vector<Direction> azimuths;  ///< Azimuths of the bearings of planar beams.

    int columns() const { return static_cast<int>(beam_of.size()); }
    /** Returns the index of a column's lower edge in `bearings` and `azimuths`; its middle and upper edge follow. */
    size_t at(int column) const { return static_cast<size_t>(2 * column + beam_of[static_cast<size_t>(column)]); }
    /** Returns the direction of the middle of a cell, unit, sonar axes [1]. */
    glm::dvec3 direction(int column, int row) const {
        const size_t middle = at(column) + 1;
        const Elevation& up = elevations[static_cast<size_t>(2 * row + 1)];
        const Direction around = conical ? computeAzimuth(bearings[middle], up) : azimuths[middle];
        return {up.cosine * around.cosine, up.cosine * around.sine, up.sine};
    }
    /** Returns the azimuth where a cone of this bearing meets an elevation. */
    static Direction computeAzimuth(double bearing, const Elevation& up);
    /** Returns the height of `count` rows from `row` [rad]. */
    double height(size_t row, size_t count) const {
        return elevations[2 * (row + count)].angle - elevations[2 * row].angle;
    }
    /** Returns the solid angle of one cell of the middle beam at elevation 0 [sr]. */
    double cell() const { return column_width * row_height; }
};

/** Returns the view of the plan's cells, which are its beams. */
AngularView makeAngularView(const RenderPlan& plan);

/** Rays that are traced together: neighbours, most of which traverse the same nodes of the tree. */
constexpr int tile_samples = 16;

/** Arrangement of the samples of a tile, by the bits of their numbers: samples that share all but the last bits form a
 *  rectangle. 4 x 4, or narrower where the whole view is narrower. */
struct TileShape {
    struct Extent {
        int columns, rows;
    };
    TileShape() = default;
    /** `beams`: number of beams in a run that begins where a tile does. */
    TileShape(const AngularView& view, const BinGrid& bins, int beams);

    Extent all{};                                  ///< Size of the tile.
    Extent at[tile_samples] = {};                  ///< Offset of each sample from the tile's first.
    Extent size[tile_samples + 1] = {{}, {1, 1}};  ///< Size of a rectangle of this number of samples, a power of 2.
    int max_merged = 1;  ///< Max samples of one triangle and one beam in one cell; a power of 2 [1].
};

}  // namespace insonify::sonar
