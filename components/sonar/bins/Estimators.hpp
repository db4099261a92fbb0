#pragma once
// Common parts of the estimators of bins: the arithmetic of the compute shader, compiled for the processor.
// Include it only in files that deposit on the processor, which are compiled without fused products.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/bins/Cells.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

using std::abs, std::exp, std::sqrt;
// By value, so that they become instructions and not unpredictable branches.
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline uint min(uint a, uint b) { return a < b ? a : b; }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"  // each includer makes its own footprints
inline double inverseRange(double place) { return place; }
#include "shaders/footprint.glsl"
using real = double;
#include "shaders/trapezoid.glsl"
#pragma GCC diagnostic pop

/** Bins for the shared code of shaders/deposit.glsl; HAVE_<FEATURE> chooses its operations at compile time. */
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
    size_t beam_sums;  ///< Sums of a beam.
    double bin_width, attenuation;
    double binEdge(uint k) const { return edges[k]; }
    uint binOf(double place) const { return min(uint(1.0 / (place * bin_width)), bin_count - 1u); }
    static uint64_t quanta(double amount) {  // via a signed number, for which there is an instruction
        return static_cast<uint64_t>(static_cast<int64_t>(min(amount, 1048576.0) * quanta_per_unit + 0.5));
    }
};

/** Returns the coverage of cell i. */
inline Footprint footprintOf(const Covered& c, int i) {
    return {c.pixel[i],    c.centre[i],  c.wide[i],    c.narrow[i], c.per_wide[i], c.steepness[i],
            c.near_end[i], c.far_end[i], c.nearest[i], c.limb[i],   c.fade[i],     c.size[i]};
}

}  // namespace
}  // namespace insonify::sonar
