#pragma once
#include "components/sonar/rays/TileCells.hpp"

namespace insonify::sonar {

/** Adds the fields of tiles to sums, [range cell][real, imaginary] with sign. All samples of a tile that hit the same
 *  triangle are one patch of scatterers. Allocates nothing. */
void depositPatches(const EchoRules& rules, const TracedView& view, const PlacedScene& scene,
                    std::span<const TracedTile> tiles, const EchoSums& to);

}  // namespace insonify::sonar
