#pragma once
#include <array>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/CellDeposit.hpp"

namespace insonify::sonar {

/** A frustum's picture in memory, and the meaning of its numbers. */
struct PictureView {
    const uint32_t* pixels = nullptr;  ///< `channels` words per pixel, row by row from below.
    size_t channels = 2;               ///< Words of a pixel [1].
    std::vector<PlacedRun> ranges;     ///< Run of each draw, its triangles rotated into sonar axes.
    std::vector<uint32_t> objects;     ///< Object of each draw.
};

/** The part of one frustum that one thread deposits: the beams [first, last). */
struct PicturePart {
    const EchoRules& rules;
    const ViewFrustum& frustum;
    const ColumnShares& shares;
    const PictureView& picture;
    WaterView water;
    uint32_t first, last;        ///< Beams [1].
    std::array<int, 2> columns;  ///< First and end of the columns that these beams touch [1].
};

/** Adds the echoes of a part of a picture to sums: each beam's share of a pixel is a cell. */
void depositPicture(const PicturePart& part, const EchoSums& to);

}  // namespace insonify::sonar
