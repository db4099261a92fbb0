#pragma once
#include <vector>

#include "components/sonar/AngularView.hpp"
#include "components/sonar/RenderPlan.hpp"

namespace insonify::sonar {

/** Rays that are cast together: neighbours, so that most of them take the same way through the tree. */
constexpr int tile_samples = 16;
/** Bins that are filled together; lists of bins end in as many more. */
constexpr int bins_at_once = 4;

/** How the samples of a tile lie: as the bits of their numbers say, so that those that share all but the last bits are
 * a rectangle. 4 x 4, but narrower where the whole view is. */
struct TileShape {
    struct Extent {
        int columns, rows;
    };
    /** `beam_columns`: of each beam; `columns`: of a run of beams that begins where a tile does. */
    TileShape(int beam_columns, int columns);

    Extent all{};                                  ///< Of the tile.
    Extent at[tile_samples] = {};                  ///< Of each sample from the tile's first.
    Extent size[tile_samples + 1] = {{}, {1, 1}};  ///< Of so many samples, a power of 2.
    int most_merged = 1;                           ///< Samples that are surely of one beam, a power of 2 [1].
};

/** What the echo of any ping needs to know, fixed for the life of a renderer but for its quality. */
struct EchoRules {
    AngularView view;
    BinGrid bins;
    Features features;
    double attenuation = 0;       ///< Amplitude, one way, in `cerqueira2017` [Np/m].
    double strength_scale = 1;    ///< strengthScale.
    int most_merged = 1;          ///< Samples of one triangle that may become one cell, a power of 2 [1].
    std::vector<double> edges;    ///< inverseEdges, and a few of 0.
    std::vector<double> middles;  ///< Slant ranges of the bins' middles, and a few of 0 [m].

    size_t channels() const { return features.has(Feature::Cerqueira2017) ? 2 : 1; }
    size_t sumCount() const { return (static_cast<size_t>(bins.bin_count) + bins_at_once) * channels(); }
};

/** Without the view, which goes with the quality. */
EchoRules makeEchoRules(const RenderPlan& plan);

/** Samples of one triangle that may become one cell: 1, 4 or 16, so that the cell's ranges stay within a twentieth of a
 *  bin of the plane's (ACOUSTICS.md 4.4).
 */
int mostMerged(const AngularView& view, const BinGrid& bins);

}  // namespace insonify::sonar
