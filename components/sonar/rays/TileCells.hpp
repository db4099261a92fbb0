#pragma once
#include <span>
#include <vector>

#include "components/sonar/echo/CellDeposit.hpp"
#include "components/sonar/rays/NormalMapping.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/RayVisibility.hpp"

namespace insonify::sonar {

/** What the numbers of hits mean in this ping: commands, each with its triangles turned into sonar axes. */
struct PlacedScene {
    std::span<const CommandRecord> commands;
    std::span<const PlacedRun> ranges;
    std::span<const ObjectRecord> objects;
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

/** Adds the energies of tiles to sums. Neighbouring samples of one triangle in one beam may be one cell. Allocates
 *  nothing. */
void depositTiles(const EchoRules& rules, const CastView& view, const PlacedScene& scene,
                  std::span<const CastTile> tiles, const EchoSums& to);

}  // namespace insonify::sonar
