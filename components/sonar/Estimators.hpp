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

struct PhysicalBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * bin_count + bin] += quanta(amount); }
#include "shaders/deposit.glsl"
};

struct NearestBins : PhysicalBins {
#define HAVE_NEAREST
#include "shaders/deposit.glsl"
#undef HAVE_NEAREST
};

struct CerqueiraBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + 2 * static_cast<size_t>(beam * bin_count + bin);
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
#define HAVE_CERQUEIRA2017
#include "shaders/deposit.glsl"
};

struct PublishedBins : CerqueiraBins {
#define HAVE_PUBLISHED
#include "shaders/deposit.glsl"
#undef HAVE_PUBLISHED
#undef HAVE_CERQUEIRA2017
};

}  // namespace
}  // namespace insonify::sonar
