#pragma once
#include <array>

namespace insonify::acoustics {

/** The reflection at the faces of a wedge: rigid faces reflect the pressure with +1, soft faces with -1. */
enum class WedgeFaces { Rigid, Soft };

/** Backscattering coefficients of the edge of a wedge [1]. The far field of a length L of the edge, seen at right
 *  angles, is abs(D) L / (2 pi r) of the incident pressure; in two dimensions it is D sqrt(1 / (2 pi k r)). */
struct WedgeEcho {
    double fringe;                 ///< The part that physical optics of the faces lacks (Ufimtsev). Finite everywhere.
    std::array<double, 2> optics;  ///< Physical optics of each face; unbounded where sound meets the face along its
                                   ///< normal, and 0 where the face is not lit.

    /** Returns Keller's coefficient D: the complete diffraction. */
    double total() const { return fringe + optics[0] + optics[1]; }
};

/** Returns the coefficients of a wedge for sound that returns to where it came from, both directions projected onto the
 *  plane across the edge (Keller 1962, Ufimtsev 2014; ACOUSTICS.md 3.12).
 *  @param exterior  angle in the water between both faces [rad], pi to 2 pi
 *  @param from_first  angle in the water from the first face to the direction of the sonar [rad], 0 to `exterior` */
WedgeEcho wedgeEcho(WedgeFaces faces, double exterior, double from_first);

/** Returns the share of the sound pressure that reaches the far edge of a face along the face [1]. The near edge takes
 *  the rest. The same share of the far edge's echo returns.
 *  @param is_sheet  the face is a side of a thin sheet, which does not affect sound that passes along it
 *  @param phase_width  wave number times the face's width [rad]
 *  @param grazing  angle between the face and the direction of the sonar [rad], 0 to pi / 2 */
double grazingShare(bool is_sheet, double phase_width, double grazing);

}  // namespace insonify::acoustics
