#pragma once
#include <complex>
#include <vector>

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
