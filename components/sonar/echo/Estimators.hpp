#pragma once
// What estimators of bins share: the arithmetic that the compute shader has as well, compiled for the processor.
// Include it only in files that deposit on the processor, which are compiled without fused products.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "components/sonar/echo/Cells.hpp"
#include "components/sonar/echo/EchoRules.hpp"
#include "components/sonar/echo/Interface.hpp"
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
inline double inverseRange(double place) { return place; }
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
    uint binOf(double place) const { return min(uint(1.0 / (place * bin_width)), bin_count - 1u); }
    static uint64_t quanta(double amount) {  // by way of a signed number, for which there is an instruction
        return static_cast<uint64_t>(static_cast<int64_t>(min(amount, 1048576.0) * quanta_per_unit + 0.5));
    }
};

/** What cell i covers. */
inline Footprint footprintOf(const Covered& c, int i) {
    return {c.pixel[i],    c.centre[i],  c.wide[i],    c.narrow[i], c.per_wide[i], c.steepness[i],
            c.near_end[i], c.far_end[i], c.nearest[i], c.limb[i],   c.fade[i],     c.size[i]};
}

}  // namespace
}  // namespace insonify::sonar
