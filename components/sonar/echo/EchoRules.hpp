#pragma once
#include <cstdint>
#include <vector>

#include "components/sonar/field/ScattererLattice.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

class PingEffect;
class PingEffects;

/** Bins that the processor fills together; lists of bins end in as many more. */
constexpr int bins_at_once = 4;

/** Sums are counted in quanta of 2^-40 of a whole cell of unit strength: exact, so the order of summation is free. */
constexpr double quanta_per_unit = 1099511627776.0;

/** What the arithmetic of an echo reads, the same for rays and pictures, on the processor and on a card. */
struct EchoRules {
    Features features;
    BinGrid bins;                 ///< In which echoes are summed: the ping's, or with fields finer ones.
    double attenuation = 0;       ///< Amplitude, one way, in `cerqueira2017` [Np/m].
    double strength_scale = 1;    ///< Strengths are deposited times this: strengthScale.
    std::vector<double> edges;    ///< Inverse ranges of the bins' edges from the near blanking on, then 0 [1/m].
    std::vector<double> middles;  ///< Slant ranges of the bins' middles, then 0 [m].

    double elevation_reach = 0;            ///< Sine of the elevation at which the table of the pattern ends [1].
    std::vector<double> elevation_powers;  ///< Two-way pattern over it (shaders/elevation.glsl); empty without one [1].
    MaterialLaws laws;
    std::vector<LatticeLevel> lattice;  ///< Of the scatterers; empty where energies are summed.
    double turns_per_metre = 0;         ///< Phase of an echo for each metre of its slant range, two way [1/m].
    std::vector<double> layers;  ///< Three each: low and high above the water surface [m], share of the strongest [1].
    bool has_maps = false;       ///< Cells have factors by surface maps.
    bool looks_down = false;     ///< The sonar's x axis points down, so that elevations are above its y-z plane.
    bool hears_misses = false;   ///< Whether effects hear cells that meet nothing.
    std::vector<const PingEffect*> own;  ///< Effects with sums of their own, which come after the channels.

    size_t channels() const { return features.has(Feature::Cerqueira2017) || features.has(Feature::Speckle) ? 2 : 1; }
    /** Bins from one beam's first to the next one's. */
    size_t beamStride() const { return static_cast<size_t>(bins.bin_count) + bins_at_once; }
    /** Numbers of a beam: [bin][channel], then for each effect with sums of its own one for each bin. */
    size_t sumCount() const { return beamStride() * (channels() + own.size()); }
    /** Where in them those of such an effect begin. */
    size_t ownOffset(size_t effect) const { return beamStride() * (channels() + effect); }
};

/** Rules for the plan's quality; the effects outlive them. */
EchoRules makeEchoRules(const RenderPlan& plan, const PingEffects& effects);
/** The same with energies in the plan's bins, whatever it sums. */
EchoRules makeEnergyRules(RenderPlan plan, const PingEffects& effects);

/** The power of 2, at most 1, by which strengths must be scaled so that no sum of quanta overflows: 1 but for
 *  materials, images or bins that are extreme together. */
double strengthScale(const RenderPlan& plan);

}  // namespace insonify::sonar
