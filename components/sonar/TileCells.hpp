#pragma once
#include <span>
#include <vector>

#include "components/sonar/CellDeposit.hpp"
#include "components/sonar/NormalMapping.hpp"
#include "components/sonar/RayPaths.hpp"
#include "components/sonar/RayVisibility.hpp"

namespace insonify::sonar {

/** What the numbers of hits mean in this ping: commands, each with its triangles turned into sonar axes, and planes. */
struct PlacedScene {
    std::span<const CommandRecord> commands;
    std::span<const PlacedRun> ranges;
    std::span<const ObjectRecord> objects;
    const std::vector<PlaneRecord>& planes;
    std::span<const FacetRecord> facets;  ///< Of the same triangles; empty where no material has a lobe.
    const NormalMapping& normal_maps;
    WaterView water;
    const RayPaths* paths = nullptr;  ///< Null where rays are straight.
};

/** How samples lie. */
struct CastView {
    AngularView cells;
    TileShape shape;
};

/** A tile that has been cast: where it lies in the view and what it met. */
struct CastTile {
    int first_column, first_row;
    const TileHits* hits;
};

/** Adds the echoes of tiles to sums: energies, or fields as [bin][real, imaginary] with sign. Neighbouring samples of one
 *  triangle in one beam may be one cell; with fields also samples of up to Patch::max_beams beams that join. Allocates
 *  nothing. */
void depositTiles(const EchoRules& rules, const CastView& view, const PlacedScene& scene,
                  std::span<const CastTile> tiles, const EchoSums& to);

}  // namespace insonify::sonar
