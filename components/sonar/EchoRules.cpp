#include "components/sonar/EchoRules.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BinDeposit.hpp"

namespace insonify::sonar {

TileShape::TileShape(int beam_columns, int columns) {
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
    most_merged = together * all.rows;
}

EchoRules makeEchoRules(const RenderPlan& plan) {
    EchoRules rules;
    rules.features = plan.features;
    rules.bins = plan.grid;
    rules.attenuation = makeAbsorption(plan.config).amplitudeNepersPerMetre();
    rules.edges = inverseEdges(rules.bins);
    for (int k = 0; k < rules.bins.bin_count; ++k) rules.middles.push_back(rules.bins.centre(k));
    rules.edges.resize(rules.edges.size() + bins_at_once);
    rules.middles.resize(rules.middles.size() + bins_at_once);
    return rules;
}

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

}  // namespace insonify::sonar
