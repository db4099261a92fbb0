#include "components/acoustics/HalfSpace.hpp"

#include <cmath>

namespace insonify::acoustics {

HalfSpace halfSpaceOf(const Seabed& seabed) { return {seabed.density_ratio, seabed.speed_ratio, seabed.loss}; }

std::complex<double> waveNumberRatio(const HalfSpace& half_space) {
    return std::complex<double>(1, half_space.loss) / half_space.speed_ratio;
}

std::complex<double> halfSpaceReflection(const HalfSpace& half_space, double grazing) {
    const std::complex<double> kappa = waveNumberRatio(half_space);
    const double cosine = std::cos(grazing);
    const std::complex<double> below =
        std::sqrt(kappa * kappa - cosine * cosine);  // sine in the half-space, times kappa
    const std::complex<double> above = half_space.density_ratio * std::sin(grazing);
    return (above - below) / (above + below);
}

/** Equations 50 to 52. */
std::complex<double> roughnessAmplitude(const HalfSpace& half_space, double grazing) {
    const double rho = half_space.density_ratio, sine = std::sin(grazing), cosine = std::cos(grazing);
    const std::complex<double> kappa = waveNumberRatio(half_space);
    const std::complex<double> p = std::sqrt(kappa * kappa - cosine * cosine);
    return ((rho - 1) * (rho - 1) * cosine * cosine + rho * rho - kappa * kappa) /
           ((rho * sine + p) * (rho * sine + p));
}

}  // namespace insonify::acoustics
