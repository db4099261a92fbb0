#pragma once
// The estimators of what a bin holds, compiled from the arithmetic that the compute shader has as well. To be included
// by what deposits on the processor alone: the compiler flags that keep products unfused are those files'.
#include <cmath>
#include <cstdint>

#include "components/sonar/BinDeposit.hpp"

// The arithmetic of many cells is done in plain loops over arrays, which the compiler turns into vector instructions;
// once for each kind of processor. No products are fused: all give the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define INSONIFY_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define INSONIFY_VECTORISED
#endif

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

/** Where the shared code of shaders/deposit.glsl finds its bins; HAVE_CERQUEIRA2017 chooses the model at compile time.
 */
struct Bins {
    const double* edges;
    uint64_t* sums;
    uint bin_count;
    double bin_width, attenuation;
    double binEdge(uint k) const { return edges[k]; }
    static uint64_t quanta(double amount) {  // by way of a signed number, for which there is an instruction
        return static_cast<uint64_t>(static_cast<int64_t>(min(amount, 1048576.0) * quanta_per_unit + 0.5));
    }
};

struct EnergyBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * bin_count + bin] += quanta(amount); }
};

#define HAVE_PHYSICAL
struct PhysicalBins : EnergyBins {
    static constexpr Features features{Feature::Physical};
#include "shaders/deposit.glsl"
};

#define HAVE_NEAREST
struct NearestBins : EnergyBins {
    static constexpr Features features{Feature::Physical, Feature::Nearest};
#include "shaders/deposit.glsl"
};
struct JitteredBins : NearestBins {
    static constexpr Features features{Feature::Physical, Feature::Nearest, Feature::Jitter};
};
#undef HAVE_NEAREST
#undef HAVE_PHYSICAL

struct MeanBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + 2 * static_cast<size_t>(beam * bin_count + bin);
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
};

#define HAVE_CERQUEIRA2017
struct CerqueiraBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017};
#include "shaders/deposit.glsl"
};
#define HAVE_PUBLISHED
struct PublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published};
#include "shaders/deposit.glsl"
};
#define HAVE_ABSORPTION
struct AbsorbingPublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published, Feature::Absorption};
#include "shaders/deposit.glsl"
};
#undef HAVE_PUBLISHED
struct AbsorbingBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Absorption};
#include "shaders/deposit.glsl"
};
#undef HAVE_ABSORPTION
#undef HAVE_CERQUEIRA2017

}  // namespace
}  // namespace insonify::sonar
