#pragma once
#include <complex>
#include <vector>

#include "types/geometry/Geometry.hpp"

namespace insonify::acoustics {

/** A homogeneous fluid. */
struct Fluid {
    double density, sound_speed;  ///< [kg/m^3], [m/s]
};

/** A plate of a homogeneous solid or fluid. */
struct Plate {
    double thickness;        ///< [m]
    double density;          ///< [kg/m^3]
    double sound_speed;      ///< Speed of longitudinal waves [m/s].
    double shear_speed = 0;  ///< Speed of shear waves [m/s]; 0: a fluid.
    double loss = 0;         ///< Imaginary over real part of both wave numbers [1].
};

/** Reflection and transmission coefficients of the sound pressure, referred to the faces of a plate. */
struct PlateResponse {
    std::complex<double> reflected, transmitted;
};

/** Returns the response of an infinite plate between two fluids to a plane wave from the first (Brekhovskikh 1980;
 *  ACOUSTICS.md 3.10).
 *  @param frequency [Hz], above 0
 *  @param cos_incidence cosine of the angle to the plate's normal in the first fluid, 0 to 1 [1] */
PlateResponse plateResponse(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                            double cos_incidence);

/** Shares of the energy of a plane wave that a plate reflects and passes on [1]. */
struct PlateShares {
    double reflected, passed;
};

/** Returns the shares of the energy for the arguments of plateResponse(). */
PlateShares computeShares(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                          double cos_incidence);

/** Returns how many halves of a wavelength a plate is thick at a frequency [Hz]. Near a whole number from 1 on it is
 *  nearly transparent between equal fluids [1]. */
inline double countHalfWaves(const Plate& plate, double frequency) {
    return 2 * plate.thickness * frequency / plate.sound_speed;
}
/** Returns whether a plate is within a tenth of a half-wave resonance. */
bool isNearResonance(const Plate& plate, double frequency);

/** Returns the plate of a shell, and the fluid behind it in this water. */
Plate makePlate(const types::Shell& shell);
Fluid getFluidBehind(const types::Shell& shell, const Fluid& water);

/** Energies of the returns from a plate at normal incidence, relative to the energy of the pulse [1]. The pulse is
 *  shorter than the time of sound across the plate and back; return k is late by k times that time. The loss is that of
 *  one frequency. The last return contains all that would follow. */
struct PlateReturns {
    std::vector<double> reflected;  ///< The sum is the mean of |R|^2 over a resonance's width.
    std::vector<double> passed;     ///< Passed out and back through the plate; the sum is the mean of |T T'|^2.
    /** Passed once through the plate; the sum is the mean of |T|^2 times the ratio of the fluids' impedances. */
    std::vector<double> passed_once;
};

/** Returns the reverberation of a plate (ACOUSTICS.md 3.10): at most `max_count` returns in each vector. Stops when the
 *  remaining returns together are 30 dB weaker than all. */
PlateReturns plateReturns(const Plate& plate, const Fluid& before, const Fluid& behind, double frequency,
                          size_t max_count);

}  // namespace insonify::acoustics
