#pragma once
#include <span>
#include <vector>

#include "components/sonar/AngularView.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/DepositRow.hpp"
#include "components/sonar/Interface.hpp"
#include "components/sonar/NormalMapping.hpp"
#include "components/sonar/RayVisibility.hpp"

namespace insonify::sonar {

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
    Model model = Model::Physical;
    bool normal_maps = false;     ///< Whether any material has one.
    double attenuation = 0;       ///< Amplitude, one way, in `cerqueira2017` [Np/m].
    double strength_scale = 1;    ///< strengthScale.
    int most_merged = 1;          ///< Samples of one triangle that may become one cell, a power of 2 [1].
    std::vector<double> edges;    ///< inverseEdges, and a few of 0.
    std::vector<double> middles;  ///< Slant ranges of the bins' middles, and a few of 0 [m].

    size_t channels() const { return model == Model::Cerqueira2017 ? 2 : 1; }
    size_t sumCount() const { return (static_cast<size_t>(bins.bin_count) + 8) * channels(); }
};

EchoRules makeEchoRules(const SonarConfig& config, const types::Geometry& geometry);

/** Samples of one triangle that may become one cell: so that its ranges stay within a twentieth of a bin of the
 * plane's.
 */
int mostMerged(const AngularView& view, const BinGrid& bins);

/** What hits' numbers mean in this ping: commands, each with its triangles turned into sonar axes, and all planes. */
struct PlacedScene {
    std::span<const CommandRecord> commands;
    std::span<const PlacedRun> runs;
    std::span<const ObjectRecord> objects;
    const std::vector<PlaneRecord>& planes;
    const NormalMapping& normal_maps;
};

/** A tile that has been cast: where it lies in the view and what it met. */
struct CastTile {
    int first_column, first_row;
    TileHits hits;
};

/** Adds the echoes of tiles to the sums of beams, [beam - first_beam][bin][channel] in quanta, EchoRules::sumCount()
 *  numbers for each. Neighbouring samples of one triangle in one beam are one cell. Allocates nothing. */
void deposit(const EchoRules& rules, const TileShape& shape, const PlacedScene& scene, std::span<const CastTile> tiles,
             int first_beam, uint64_t* sums);

}  // namespace insonify::sonar
