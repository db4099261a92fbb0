#pragma once
// Common parts of the estimators of bins: the arithmetic of the compute shader, compiled for the processor.
// Include it only in files that deposit on the processor, which are compiled without fused products.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/bins/Cells.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "types/geometry/VectorMath.hpp"

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
    uint findBin(double place) const { return min(uint(1.0 / (place * bin_width)), bin_count - 1u); }
    static uint64_t quanta(double amount) {  // via a signed number, for which there is an instruction
        return static_cast<uint64_t>(static_cast<int64_t>(min(amount, 1048576.0) * quanta_per_unit + 0.5));
    }
};

/** Returns the coverage of cell i. */
inline Footprint getFootprint(const Covered& c, int i) {
    return {c.pixel[i],    c.centre[i],  c.wide[i],    c.narrow[i], c.per_wide[i], c.steepness[i],
            c.near_end[i], c.far_end[i], c.nearest[i], c.limb[i],   c.fade[i],     c.size[i]};
}

}  // namespace

// The cells of bodies with a limb. Include it only in files that deposit on the processor.
namespace {

/** A cell on a curved body (ACOUSTICS.md 4.7). */
struct BentCell {
    double curvature;              ///< Curvature of the body along the ray, above 0 [1/m].
    double perpendicular;          ///< Distance of the body's tangent plane in the cell's middle [m].
    double width, height, cos_el;  ///< Width and height of the cell [rad], and cosine of its middle's elevation [1].
    double sag;                    ///< Difference of 1/r in the middle and its mean over the plane [1/m].
    double near_limit, far_limit;  ///< Inverse ranges of the object [1/m].
    double near_edge, far_edge;    ///< Inverse ranges of the bins [1/m].
};

/** Replaces the cell's plane by the sphere that touches it in the cell's middle.
 *  @param cell  of the plane, with an echo
 *  @returns the length L of the sphere's echo, which varies with inverse range g as L g (g^2 - limb^2); it replaces the
 *          plane's perpendicular distance [m] */
inline double bend(Footprint& cell, const BentCell& at) {
    const double range = 1 / cell.pixel, length = at.perpendicular + 0.5 * at.curvature * range * range;
    const double per_length = 1 / length, flatness = at.perpendicular * per_length;
    const double square = 0.5 * at.curvature * per_length, limb = sqrt(square);
    const double nearest = 0.5 * (sqrt(2 * at.curvature * length + 1) + 1) * per_length;
    const double corners = (at.width * at.width * at.cos_el * at.cos_el + at.height * at.height) * (1.0 / 12);
    const double centre = cell.pixel - flatness * at.sag + square * range * (1 - corners);
    cell.centre = min(centre, nearest + square / nearest);
    cell.wide *= flatness;
    cell.narrow *= flatness;
    cell.per_wide = 1 / cell.wide;
    cell.steepness = 0.5 * cell.per_wide / cell.narrow;
    const double half_length = 0.5 * (cell.wide + cell.narrow);
    cell.near_end = min(min(inverseAt(limb, cell.centre + half_length), nearest), min(at.near_limit, at.near_edge));
    cell.far_end = max(max(inverseAt(limb, cell.centre - half_length), at.far_limit), at.far_edge);
    cell.nearest = nearest;
    cell.limb = cell.fade = limb;
    return length;
}

}  // namespace

}  // namespace insonify::sonar
