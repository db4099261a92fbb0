#pragma once
#include <complex>

#include "components/acoustics/Seabed.hpp"

namespace insonify::acoustics {

/** A fluid that fills the space below a plane. The ratios are to the water above [1]. */
struct HalfSpace {
    double density_ratio = 1, speed_ratio = 1;
    double loss = 0;  ///< delta: imaginary over real part of the wave number [1].
};
HalfSpace halfSpaceOf(const Seabed& seabed);

/** Returns kappa = (1 + i delta) / nu: the wave number in the half-space over that in the water [1]. */
std::complex<double> waveNumberRatio(const HalfSpace& half_space);
/** Returns Rayleigh's reflection coefficient of the sound pressure at a grazing angle [rad], with loss. A fast
 *  half-space reflects totally below its critical angle arccos(1 / nu). ACOUSTICS.md 3.7. */
std::complex<double> halfSpaceReflection(const HalfSpace& half_space, double grazing);
/** Returns Y at a grazing angle [rad]: a slightly rough surface of spectrum W [m^4] scatters
 *  4 k^4 sin^4 |Y|^2 W(2 k cos) back (Kuo 1964; ACOUSTICS.md 3.5). */
std::complex<double> roughnessAmplitude(const HalfSpace& half_space, double grazing);

}  // namespace insonify::acoustics
