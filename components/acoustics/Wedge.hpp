#pragma once
#include <array>

namespace insonify::acoustics {

/** What the faces of a wedge do to sound: a rigid face reflects its pressure with +1, a soft one with -1. */
enum class WedgeFaces { Rigid, Soft };

/** Backscattering coefficients of the edge of a wedge [1]. The far field of a length L of the edge, seen at right
 *  angles, is abs(D) L / (2 pi r) of the incident pressure; in two dimensions it is D sqrt(1 / (2 pi k r)). */
struct WedgeEcho {
    double fringe;                 ///< What physical optics of the faces lacks (Ufimtsev). Finite everywhere.
    std::array<double, 2> optics;  ///< What physical optics of each face has; grows without bound where sound meets
                                   ///< the face along its normal, and is 0 where the face is not lit.

    /** Returns Keller's coefficient D: all that is diffracted. */
    double total() const { return fringe + optics[0] + optics[1]; }
};

/** Returns the coefficients of a wedge for sound that returns to where it came from, both directions projected onto the
 *  plane across the edge (Keller 1962, Ufimtsev 2014; ACOUSTICS.md 3.12).
 *  @param exterior  angle in the water between both faces [rad], pi to 2 pi
 *  @param from_first  angle in the water from the first face to the direction of the sonar [rad], 0 to `exterior` */
WedgeEcho wedgeEcho(WedgeFaces faces, double exterior, double from_first);

/** Returns the share of the sound pressure that reaches the far edge of a face along the face, whose near edge takes
 * the rest; the far edge's echo returns the same share of it [1].
 *  @param is_sheet  the face is a side of a thin sheet, along which sound passes as if it was not there
 *  @param phase_width  wave number times the face's width [rad]
 *  @param grazing  angle between the face and the direction of the sonar [rad], 0 to pi / 2 */
double grazingShare(bool is_sheet, double phase_width, double grazing);

}  // namespace insonify::acoustics
