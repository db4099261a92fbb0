#pragma once
#include <cstdint>
#include <vector>

namespace insonify::sonar {

struct RenderPlan;

/** A lattice of scatterers on the surfaces, and the slant ranges in which it is used (ACOUSTICS.md 5.21). */
struct LatticeLevel {
    double range_end;   ///< It is used from the end of the level before to here [m].
    double spacing;     ///< Side of its squares, each with one scatterer, seen along the surface's main axis [m].
    double represents;  ///< Scatterers of the scene that each lattice scatterer represents; 0: very many [1].
    uint32_t number;    ///< Equal spacings have equal numbers [1].
};

/** Sampling of the field in range, of a plan that is coherent. */
struct FieldSampling {
    int samples = 1;  ///< Samples of the field in each bin: one for each resolution cell in it [1].
    int parts = 1;    ///< Range cells of each bin that are summed first: an odd number for each sample [1].
};

/** Returns the width of the beams in azimuth, between the half-power points [rad]. */
double beamWidth(const RenderPlan& plan);
/** Returns the range resolution: of the pulse, or of the bins where they determine it [m]. */
double rangeResolution(const RenderPlan& plan);
FieldSampling fieldSampling(const RenderPlan& plan);

/** Returns the lattices from the nearest range to the far edge of the last bin. Neighbouring spacings differ by the
 *  square root of 2, so that a resolution cell has the configured number of scatterers, and at most twice that. */
std::vector<LatticeLevel> scattererLattice(const RenderPlan& plan);

}  // namespace insonify::sonar
