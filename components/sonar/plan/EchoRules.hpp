#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"

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

class PingEffect;
class PingEffects;

/** Bins that the processor fills together; lists of bins have this number of extra entries at the end. */
constexpr int bins_at_once = 4;

/** Sums are counted in quanta of 2^-40 of a whole cell of unit strength: exact, so the order of summation is free. */
constexpr double quanta_per_unit = 1099511627776.0;

/** Parameters of the arithmetic of an echo, the same for rays and pictures, on the processor and on a card. */
struct EchoRules {
    Features features;
    BinGrid bins;                 ///< Bins in which echoes are summed: the ping's, or with fields finer bins.
    double attenuation = 0;       ///< Amplitude, one way, in `cerqueira2017` [Np/m].
    double strength_scale = 1;    ///< Factor of deposited strengths: strengthScale.
    std::vector<double> edges;    ///< Inverse ranges of the bins' edges from the near blanking, then 0 [1/m].
    std::vector<double> middles;  ///< Slant ranges of the bins' middles, then 0 [m].

    double elevation_reach = 0;  ///< Sine of the elevation where the table of the pattern ends [1].
    /** Two-way pattern over it (shaders/elevation.glsl), of pictures; empty without one. Between its steps it is within
     *  1e-3 of the axis of beams from 0.25 deg on [1]. */
    std::vector<double> elevation_powers;
    MaterialLaws laws;
    std::vector<LatticeLevel> lattice;  ///< Lattices of the scatterers; empty where energies are summed.
    double turns_per_metre = 0;         ///< Phase of an echo for each metre of its slant range, two way [1/m].
    std::vector<double>
        layers;  ///< Three values each: low and high above the water surface [m], share of the strongest [1].
    bool has_maps = false;            ///< Cells have factors by surface maps.
    bool looks_down = false;          ///< The sonar's x axis points down, so that elevations are above its y-z plane.
    bool echoes_from_misses = false;  ///< Whether effects process cells that are misses.
    std::vector<const PingEffect*> own;  ///< Effects with their own sums, which follow the channels.
    EchoSelection* selection = nullptr;  ///< RenderOptions::selection.

    size_t channels() const { return features.has(Feature::Cerqueira2017) || features.has(Feature::Speckle) ? 2 : 1; }
    /** Returns the number of bins from one beam's first to the next beam's first. */
    size_t beamStride() const { return static_cast<size_t>(bins.bin_count) + bins_at_once; }
    /** Returns the number of values of a beam: [bin][channel], then one per bin for each effect with its own sums. */
    size_t sumCount() const { return beamStride() * (channels() + own.size()); }
    /** Returns the index of the first of an effect's own sums in the values of a beam. */
    size_t ownOffset(size_t effect) const { return beamStride() * (channels() + effect); }
};

/** Returns the rules for the plan's quality; the effects outlive them. */
EchoRules makeEchoRules(const RenderPlan& plan, const PingEffects& effects);
/** Returns the same with energies in the plan's bins, even if the plan sums fields. */
EchoRules makeEnergyRules(RenderPlan plan, const PingEffects& effects);

/** Returns the power of 2, at most 1, by which strengths must be scaled so that no sum of quanta overflows. It is 1
 *  except for materials, images or bins that are extreme together. */
double strengthScale(const RenderPlan& plan);

}  // namespace insonify::sonar
