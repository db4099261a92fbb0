#pragma once
#include <vector>

#include "components/sonar/fan/BinGrid.hpp"

namespace insonify::sonar {

struct RenderPlan;

/** A lattice of scatterers on the surfaces, and the slant ranges in which it stands for them (ACOUSTICS.md 5.21). */
struct LatticeLevel {
    double range_end;   ///< It is in force from the end of the one before to here [m].
    double spacing;     ///< One scatterer in each square of it, seen along the surface's main axis [m].
    double stands_for;  ///< Scatterers of the scene for each of the lattice; 0: very many [1].
    uint32_t number;    ///< The same spacing has the same number [1].
};

/** How finely the field of a plan that is coherent is summed in range. */
struct FieldSampling {
    int samples = 1;  ///< Of the field in each bin: one for each resolution cell in it [1].
    int parts = 1;    ///< Range cells of each bin that are summed first: an odd number for each sample [1].
};

/** Of the beams in azimuth, between the half-power points [rad]. */
double beamWidthOf(const RenderPlan& plan);
/** Of the pulse, or of the bins where these are what resolution there is [m]. */
double rangeResolutionOf(const RenderPlan& plan);
FieldSampling fieldSamplingOf(const RenderPlan& plan);
/** The range cells in which a plan's echoes are summed: its bins, or parts of these. */
BinGrid summedGrid(const RenderPlan& plan);

/** From the nearest to the far edge of the last bin. Neighbouring spacings differ by the square root of 2, so that the
 *  scatterers of a resolution cell are as many as are asked for, and at most twice as many. */
std::vector<LatticeLevel> scattererLattice(const RenderPlan& plan);

}  // namespace insonify::sonar
