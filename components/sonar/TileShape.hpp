#pragma once
#include "components/sonar/AngularView.hpp"
#include "components/sonar/BinGrid.hpp"

namespace insonify::sonar {

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
