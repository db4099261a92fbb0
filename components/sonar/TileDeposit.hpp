#pragma once
#include <span>
#include <vector>

#include "components/sonar/DepositRow.hpp"
#include "components/sonar/EchoRules.hpp"
#include "components/sonar/NormalMapping.hpp"
#include "components/sonar/RayPaths.hpp"
#include "components/sonar/RayVisibility.hpp"
#include "components/sonar/TruthTable.hpp"
#include "components/sonar/Volume.hpp"

namespace insonify::sonar {

/** What hits' numbers mean in this ping: commands, each with its triangles turned into sonar axes, and all planes. */
struct PlacedScene {
    std::span<const CommandRecord> commands;
    std::span<const PlacedRun> ranges;
    std::span<const ObjectRecord> objects;
    const std::vector<PlaneRecord>& planes;
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

/** Adds the echoes of tiles to the sums of beams, [beam - first_beam][bin][channel] in quanta, EchoRules::sumCount()
 *  numbers for each, or their fields, [..][real, imaginary] with sign, and what they hide of the volume to what follows
 *  there. Neighbouring samples of one triangle in one beam may be one cell, of fields those of up to
 *  Patch::max_beams. Allocates nothing. */
void deposit(const EchoRules& rules, const CastView& view, const PlacedScene& scene, std::span<const CastTile> tiles,
             int first_beam, uint64_t* sums);

/** The sums of deposit(), and what they are of. */
void depositAndTell(const EchoRules& rules, const CastView& view, const PlacedScene& scene,
                    std::span<const CastTile> tiles, int first_beam, uint64_t* sums, const TruthSink& truth);

/** What is compiled into the deposit of rays that has these features. */
Features compiledForRays(const Features& wanted);

}  // namespace insonify::sonar
