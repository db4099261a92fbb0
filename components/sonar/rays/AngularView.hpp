#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** How rays sample a fan: cells in azimuth and elevation of the sonar frame, in as many columns for each beam, none of
 *  which belongs to two. Up to 180 deg of elevation. With conical beams, the columns of a row follow its cones. */
struct AngularView {
    /** An angle. */
    struct Direction {
        double cosine, sine;
    };

    struct Elevation : Direction {
        double angle;     ///< [rad]
        double weighted;  ///< Integral of its cosine times the elevation pattern from some angle on; `sine` without a
                          ///< pattern.
    };

    int beams = 0;
    int beam_columns = 0;  ///< Of each beam [1].
    int rows = 0;          ///< From below upwards [1].
    bool conical = false;
    bool joined = true;        ///< Each beam begins where the one before it ends.
    bool weighted = false;     ///< By a pattern in elevation.
    double column_width = 0;   ///< Of the middle beam's columns, in bearing [rad].
    double row_height = 0;     ///< Of the tallest row [rad].
    std::vector<int> beam_of;  ///< Of each column, beam after beam [1].
    /** At the lower edge, the middle and the upper edge of each row: row i has 2 i, 2 i + 1 and 2 i + 2. */
    std::vector<Elevation> elevations;
    /** The same of each beam's columns, from at(column) on: bearings [rad]. */
    std::vector<double> bearings;
    std::vector<Direction> azimuths;  ///< Of the bearings, those of planar beams.

    int columns() const { return static_cast<int>(beam_of.size()); }
    /** Of a column's lower edge, in `bearings` and `azimuths`; its middle and upper edge follow. */
    size_t at(int column) const { return static_cast<size_t>(2 * column + beam_of[static_cast<size_t>(column)]); }
    /** Unit, sonar axes, of the middle of a cell [1]. */
    glm::dvec3 direction(int column, int row) const {
        const size_t middle = at(column) + 1;
        const Elevation& up = elevations[static_cast<size_t>(2 * row + 1)];
        const Direction around = conical ? azimuthOf(bearings[middle], up) : azimuths[middle];
        return {up.cosine * around.cosine, up.cosine * around.sine, up.sine};
    }
    /** Where a cone of that bearing meets an elevation. */
    static Direction azimuthOf(double bearing, const Elevation& up);
    /** Of `count` rows from `row` on [rad]. */
    double height(size_t row, size_t count) const {
        return elevations[2 * (row + count)].angle - elevations[2 * row].angle;
    }
    /** Solid angle of one cell of the middle beam at elevation 0 [sr]. */
    double cell() const { return column_width * row_height; }
};

/** Of the plan's cells, which are the beams of the view. */
AngularView makeAngularView(const RenderPlan& plan);

/** Rays that are cast together: neighbours, so that most of them take the same way through the tree. */
constexpr int tile_samples = 16;

/** How the samples of a tile lie: as the bits of their numbers say, so that those that share all but the last bits are
 *  a rectangle. 4 x 4, but narrower where the whole view is. */
struct TileShape {
    struct Extent {
        int columns, rows;
    };
    TileShape() = default;
    /** `beams`: of a run of beams that begins where a tile does. */
    TileShape(const AngularView& view, const BinGrid& bins, int beams);

    Extent all{};                                  ///< Of the tile.
    Extent at[tile_samples] = {};                  ///< Of each sample from the tile's first.
    Extent size[tile_samples + 1] = {{}, {1, 1}};  ///< Of so many samples, a power of 2.
    int max_merged = 1;  ///< Samples of one triangle that may become one cell, and are of one beam; a power of 2 [1].
};

}  // namespace insonify::sonar
