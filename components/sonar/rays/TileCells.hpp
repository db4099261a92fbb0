#pragma once
#include <span>
#include <vector>

#include "components/sonar/echo/CellDeposit.hpp"
#include "components/sonar/rays/NormalMapping.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/RayVisibility.hpp"

namespace insonify::sonar {

class BinLevels;

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

/** A tile that has been cast: where it is in the view and what it has met. */
struct CastTile {
    int first_column, first_row;
    int end_column;  ///< Samples from this column on are not the tile's: they were not cast, and are no misses.
    TileHits* hits;
};

/** A ping that is ray-traced, at the quality in force. */
struct CastPing {
    const EchoRules& rules;
    const BinLevels& levels;  ///< Of the rules' bins.
    const CastView& view;
    const RayVisibility& visibility;  ///< Placed in this ping.
    PlacedScene scene;
};

/** Asks for the planes that a tile to come needs, which are wherever its triangles are in memory. */
inline void fetchPlanes(const PlacedScene& scene, const CastTile& tile) {
    for (int i = 0; i < tile_samples; ++i) {
        if (tile.hits->command[i] == TileHits::nothing) continue;
        const PlaneRecord& plane = scene.ranges[tile.hits->command[i]].planes[tile.hits->triangle[i]];
        __builtin_prefetch(&plane.normal);
        __builtin_prefetch(&plane.point);  // in the next line of the cache, perhaps
    }
}

/** Adds the energies of tiles to sums. Neighbouring samples of one triangle in one beam may be one cell. Allocates
 *  nothing. */
void depositTiles(const EchoRules& rules, const CastView& view, const PlacedScene& scene,
                  std::span<const CastTile> tiles, const EchoSums& to);

}  // namespace insonify::sonar
