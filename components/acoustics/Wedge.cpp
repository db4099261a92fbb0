#include "components/acoustics/Wedge.hpp"

#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

constexpr double near_pole =
    1e-3;  ///< Below this angle a series has smaller rounding errors than the difference [rad].

double cot(double angle) { return std::cos(angle) / std::sin(angle); }

/** Returns one face's part of Keller's coefficient minus that of physical optics, cot(x / n) / (2 n) - cot(x) / 2.
 *  @param past_normal  angle from the face's normal to the sonar, positive away from the face [rad] */
double faceFringe(double n, double past_normal) {
    if (std::abs(past_normal) < near_pole) return past_normal * (1 - 1 / (n * n)) / 6;
    return cot(past_normal / n) / (2 * n) - cot(past_normal) / 2;
}

}  // namespace

WedgeEcho wedgeEcho(WedgeFaces faces, double exterior, double from_first) {
    const double n = exterior / pi, sign = faces == WedgeFaces::Rigid ? 1 : -1;
    WedgeEcho echo{-cot(pi / (2 * n)) / n, {}};
    const std::array<double, 2> from_face{from_first, exterior - from_first};
    for (size_t k = 0; k < 2; ++k) {
        const double past_normal = from_face[k] - pi / 2;
        const bool is_lit = from_face[k] < pi;
        echo.fringe += sign * (is_lit ? faceFringe(n, past_normal) : cot(past_normal / n) / (2 * n));
        if (is_lit) echo.optics[k] = sign * cot(past_normal) / 2;
    }
    return echo;
}

double grazingShare(bool is_sheet, double phase_width, double grazing) {
    const double share = std::erf(std::sqrt(2 * phase_width) * std::sin(grazing / 2));
    return is_sheet ? share : (1 + share) / 2;
}

}  // namespace insonify::acoustics
