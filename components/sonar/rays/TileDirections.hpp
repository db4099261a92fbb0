#pragma once
#include <vector>

#include "components/sonar/rays/TileCells.hpp"

namespace insonify::sonar {

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
