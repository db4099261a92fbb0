#pragma once
#include <complex>

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
    double shear_speed = 0;  ///< 0: a fluid [m/s].
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

}  // namespace insonify::acoustics
