#include "components/sonar/TileShape.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {
namespace {

/** Samples of one triangle that may become one cell: so that its ranges stay within a fiftieth of a bin of the
 *  plane's. */
int mostMerged(const AngularView& view, const BinGrid& bins) {
    // Over an angle d, 1/r of a plane n.p = D leaves the straight line between its ends by d d / (8 D) at most: so much
    // is a fiftieth of a bin at the far edge, on planes that graze at 15 deg. Energies are off by d d / 24 of
    // themselves, however long the bins are.
    constexpr double widest = 0.0085;  // [rad]
    const double angle = std::min(widest, std::sqrt(8 * 0.02 * bins.bin_width / bins.range_max / 4));
    const double cell = std::max(view.column_width, view.row_height);
    int most = 1;
    while (most < tile_samples && cell * 2 * std::sqrt(most) <= angle) most *= 4;
    return most;
}

}  // namespace

TileShape::TileShape(const AngularView& view, const BinGrid& bins, int beams) {
    const int beam_columns = view.beam_columns, columns = beams * beam_columns;
    const int wide = columns >= 4 ? 4 : columns >= 2 ? 2 : 1;
    const int together = std::min(wide, beam_columns % 4 == 0 ? 4 : beam_columns % 2 == 0 ? 2 : 1);
    for (int count = 1; count < tile_samples; count *= 2) {
        // First the columns of one beam and rows by turns, then the other rows, then the other columns.
        const int across = size[count].columns, up = size[count].rows;
        const bool widens = across < together ? across <= up : up * wide >= tile_samples;
        size[2 * count] = {widens ? 2 * across : across, widens ? up : 2 * up};
        for (int i = 0; i < count; ++i)
            at[count + i] = {at[i].columns + (widens ? across : 0), at[i].rows + (widens ? 0 : up)};
    }
    all = size[tile_samples];
    max_merged = std::min(together * all.rows, mostMerged(view, bins));
}

}  // namespace insonify::sonar
