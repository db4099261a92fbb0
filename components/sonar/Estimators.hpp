#pragma once
// The estimators of what a bin holds, compiled from the arithmetic that the compute shader has as well. To be included
// by what deposits on the processor alone: the compiler flags that keep products unfused are those files'.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "components/sonar/EchoRules.hpp"
#include "components/sonar/Interface.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

using std::abs, std::exp, std::sqrt;
// By value, so that they become instructions and not branches that nobody can predict.
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline uint min(uint a, uint b) { return a < b ? a : b; }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"  // each includer has its own way to footprints
#include "shaders/footprint.glsl"
using real = double;
#include "shaders/trapezoid.glsl"
#pragma GCC diagnostic pop

/** Where the shared code of shaders/deposit.glsl finds its bins; HAVE_<FEATURE> chooses at compile time what it does.
 */
struct Bins {
    explicit Bins(const EchoRules& rules, uint64_t* all_sums = nullptr)
        : edges(rules.edges.data()),
          middles(rules.middles.data()),
          sums(all_sums),
          bin_count(static_cast<uint>(rules.bins.bin_count)),
          beam_sums(rules.sumCount()),
          bin_width(rules.bins.bin_width),
          attenuation(rules.attenuation) {}

    const double *edges, *middles;
    uint64_t* sums;
    uint bin_count;
    size_t beam_sums;  ///< Numbers of a beam.
    double bin_width, attenuation;
    double binEdge(uint k) const { return edges[k]; }
    static uint64_t quanta(double amount) {  // by way of a signed number, for which there is an instruction
        return static_cast<uint64_t>(static_cast<int64_t>(min(amount, 1048576.0) * quanta_per_unit + 0.5));
    }
};

/** Several numbers at a time. */
using Lanes = double __attribute__((vector_size(bins_at_once * sizeof(double))));

inline Lanes min(Lanes a, double b) { return a < b ? a : Lanes{} + b; }
inline Lanes max(Lanes a, double b) { return a > b ? a : Lanes{} + b; }
inline Lanes abs(Lanes a) { return a < 0.0 ? -a : a; }
inline Lanes load(const double* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

/** Energies of footprints: what deposit.glsl does with HAVE_PHYSICAL, several bins at once. */
struct PhysicalBins : Bins {
    static constexpr Features features{Feature::Physical};
    using Bins::Bins;

    void depositCell(const Footprint& cell, uint beam, double strength_range) {
        if (!(cell.near_end > cell.far_end && strength_range >= 0.0)) return;
        uint bin = min(uint(1.0 / (cell.near_end * bin_width)), bin_count - 1u);
        while (bin > 0u && edges[bin] < cell.near_end) --bin;
        while (edges[bin + 1u] >= cell.near_end) ++bin;
        uint64_t* of_beam = sums + beam * beam_sums;
        for (; edges[bin] > cell.far_end; bin += bins_at_once) addBins(cell, strength_range, bin, of_beam);
    }

private:
    using real = Lanes;
#include "shaders/trapezoid.glsl"

    void addBins(const Footprint& cell, double strength_range, uint first, uint64_t* of_beam) {
        const Lanes above = max(min(load(edges + first), cell.near_end), cell.far_end);
        const Lanes below = max(min(load(edges + first + 1), cell.near_end), cell.far_end);
        const Lanes to_above = trapezoidShare(cell, above - cell.centre);
        const Lanes share =
            (above < cell.nearest ? to_above : Lanes{} + 0.5) - trapezoidShare(cell, below - cell.centre);
        const Lanes amounts = partEnergy(cell, strength_range, share, load(middles + first), above, below);
        for (int i = 0; i < bins_at_once; ++i) of_beam[first + i] += quanta(amounts[i]);
    }
};

#define HAVE_PHYSICAL
#define HAVE_NEAREST
struct NearestBins : Bins {
    static constexpr Features features{Feature::Physical, Feature::Nearest};
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * beam_sums + bin] += quanta(amount); }
#include "shaders/deposit.glsl"
};
struct JitteredBins : NearestBins {
    static constexpr Features features{Feature::Physical, Feature::Nearest, Feature::Jitter};
    using NearestBins::NearestBins;
};
#undef HAVE_NEAREST
#undef HAVE_PHYSICAL

struct MeanBins : Bins {
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + beam * beam_sums + 2 * size_t{bin};
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
};

#define HAVE_CERQUEIRA2017
struct CerqueiraBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_PUBLISHED
struct PublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_ABSORPTION
struct AbsorbingPublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_PUBLISHED
struct AbsorbingBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_ABSORPTION
#undef HAVE_CERQUEIRA2017

/** Where shaders/volume.glsl adds what cells hide of the volume, or let hear of its layers. */
struct VolumeChanges {
    VolumeChanges(const EchoRules& rules, double height, uint64_t* all_sums)
        : changes(all_sums + rules.volumeOffset()),
          beam_sums(rules.sumCount()),
          bin_count(static_cast<uint>(rules.bins.bin_count)),
          bin_width(rules.bins.bin_width),
          numbers(rules.layers.data()),
          layer_count(static_cast<uint>(rules.layers.size() / 3)),
          sonar_height(height) {}

    void addVolume(uint beam, uint bin, double amount) const {
        changes[beam * beam_sums + bin] +=
            static_cast<uint64_t>(static_cast<int64_t>(amount * quanta_per_unit + (amount < 0 ? -0.5 : 0.5)));
    }
    double layerNumber(uint i) const { return numbers[i]; }

    uint64_t* changes;
    size_t beam_sums;
    uint bin_count;
    double bin_width;
    const double* numbers;
    uint layer_count;
    double sonar_height;
};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // layers alone ask how steep a ray is
struct OpenVolume : VolumeChanges {
    static constexpr bool hears_misses = false;
    using VolumeChanges::VolumeChanges;
#include "shaders/volume.glsl"
};
#pragma GCC diagnostic pop
#define HAVE_VOLUME_LAYERS
struct LayeredVolume : VolumeChanges {
    static constexpr bool hears_misses = true;
    using VolumeChanges::VolumeChanges;
#include "shaders/volume.glsl"
};
#undef HAVE_VOLUME_LAYERS

using AllEstimators = std::tuple<PhysicalBins, NearestBins, JitteredBins, CerqueiraBins, AbsorbingBins, PublishedBins,
                                 AbsorbingPublishedBins>;

/** Features that any of some estimators has. */
template <class... Estimator>
constexpr Features featuresOfAny(std::type_identity<std::tuple<Estimator...>>) {
    return (Features{} | ... | Estimator::features);
}

/** Calls use.operator()<Estimator>() with the one that has the features of a plan, among those without `unwanted`
 *  features. */
template <Features unwanted, class Use>
void withEstimator(const Features& features, const Use& use) {
    constexpr std::type_identity<AllEstimators> all;
    const Features wanted = features & featuresOfAny(all);
    [&]<class... Estimator>(std::type_identity<std::tuple<Estimator...>>) {
        const auto offer = [&]<class Offered>() {
            if constexpr ((Offered::features & unwanted) == Features{})
                if (Offered::features == wanted) use.template operator()<Offered>();
        };
        (offer.template operator()<Estimator>(), ...);
    }(all);
}

}  // namespace
}  // namespace insonify::sonar
