#include "components/acoustics/SeabedBackscatter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "components/acoustics/Validity.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

constexpr double degree = pi / 180;
constexpr double min_grazing = 0.001 * degree;
constexpr double min_kirchhoff = 40 * degree;

/** 1 far below 0, 0 far above: equation 57. */
double blend(double x) { return 1 / (1 + std::exp(x)); }

/** q_c of Kirchhoff's approximation: equations 36 and 39 [1]. */
double structureOf(double alpha, double roughness, double wave_number) {
    const double c_h2 = 2 * pi * roughness * std::tgamma(2 - alpha) * std::pow(2, -2 * alpha) /
                        (alpha * (1 - alpha) * std::tgamma(1 + alpha));
    return c_h2 * std::pow(2, 1 - 2 * alpha) * std::pow(wave_number, 2 * (1 - alpha));
}

/** Equation 40. */
double closedFormA(double alpha) {
    const double ratio = 8 * alpha * alpha * std::tgamma(1 / (2 * alpha) + 0.5) /
                         (std::tgamma(0.5) * std::tgamma(1 / alpha) * std::tgamma(1 / (2 * alpha)));
    return std::pow(ratio, 2 * alpha);
}

double closedFormB(double alpha, double a) {
    return std::pow(a, 0.5 - 1 / (2 * alpha)) * std::tgamma(1 / alpha) / (2 * alpha);
}

/** Returns s, the rms slope of the relief that the wave finds smooth: equation 42 [1]. */
double slopeOf(double alpha, double roughness, double wave_number) {
    const double square = std::pow(2 * pi * roughness, 1 / alpha) / (2 * (1 - alpha)) *
                          std::pow(wave_number * wave_number / alpha, (1 - alpha) / alpha);
    return std::sqrt(square);
}

/** Returns the factor that the printed equations 36 to 40 lack compared with the report's own table 3, 3.6 dB:
 *  ACOUSTICS.md 3.5. */
double kirchhoffLevel(double alpha) { return std::pow(2, 2 * (1 - alpha) / alpha); }

}  // namespace

SeabedBackscatter::SeabedBackscatter(const Seabed& seabed, double frequency_khz, double speed_of_sound)
    : seabed_(seabed),
      wave_number_(2 * pi * 1e3 * frequency_khz / (100 * speed_of_sound)),
      alpha_(seabed.roughness_slope / 2 - 1),
      slope_(slopeOf(alpha_, seabed.roughness, wave_number_)),
      structure_(structureOf(alpha_, seabed.roughness, wave_number_)),
      a_(closedFormA(alpha_)),
      b_(closedFormB(alpha_, a_)),
      normal_reflection_(std::norm(halfSpaceReflection(halfSpaceOf(seabed), pi / 2))) {}

double SeabedBackscatter::crossSection(double grazing) const {
    const double angle = std::max(grazing, min_grazing);
    return roughInterface(angle) + volume(angle);
}

/** Equations 57 to 64. */
double SeabedBackscatter::roughInterface(double grazing) const {
    constexpr double steepest = 7 * degree, over = 0.5 * degree;
    const double c4 = std::pow(1000, 1 / (1 + alpha_)) * std::pow(a_ * structure_ * structure_, 1 / alpha_);
    const double near_vertical = blend((std::cos(grazing) - std::pow(1 / c4 + 4, -0.25)) / 0.0125);
    const double gentle = blend((std::atan(slope_) - steepest) / over);
    const double moderate = near_vertical * kirchhoff(grazing) + (1 - near_vertical) * compositeRoughness(grazing);
    return gentle * moderate + (1 - gentle) * largeRoughness(grazing);
}

/** Equations 35 to 40. */
double SeabedBackscatter::kirchhoff(double grazing) const {
    if (grazing < min_kirchhoff) return 0;
    const double spread = std::pow(std::abs(std::cos(grazing)), 4 * alpha_) +
                          a_ * structure_ * structure_ * std::pow(std::sin(grazing), 4);
    return kirchhoffLevel(alpha_) * b_ * structure_ * normal_reflection_ /
           (8 * pi * std::pow(spread, (1 + alpha_) / (2 * alpha_)));
}

double SeabedBackscatter::compositeRoughness(double grazing) const {
    return shadowing(grazing) * overSlopes([&](double angle) { return perturbation(angle); }, grazing);
}

/** First order of small perturbations: equations 7 and 50 to 52. */
double SeabedBackscatter::perturbation(double grazing) const {
    const double k = wave_number_, sine = std::sin(grazing), cosine = std::cos(grazing);
    const std::complex<double> y = roughnessAmplitude(halfSpaceOf(seabed_), grazing);
    const double scatterers = std::sqrt(4 * k * k * cosine * cosine + k * k / 100);
    const double spectrum = seabed_.roughness * std::pow(scatterers, -seabed_.roughness_slope);
    return 4 * std::pow(k * sine, 4) * std::norm(y) * spectrum;
}

/** Returns the share of the seabed that is visible at low grazing angles: equations 43 to 45. */
double SeabedBackscatter::shadowing(double grazing) const {
    const double t = std::tan(grazing) / slope_;
    if (t > 2) return 1;
    const double q = (std::exp(-t * t) / std::sqrt(pi) - t * std::erfc(t)) / (4 * t);
    return -std::expm1(-2 * q) / (2 * q);
}

/** Returns the mean over slopes of the seabed, by three points: equations 46 to 49. */
double SeabedBackscatter::overSlopes(const std::function<double(double)>& section, double grazing) const {
    constexpr double outer = 0.295410, middle = 1.181636, node = 1.224745;
    const auto at = [&](double angle) { return section(std::clamp(angle, 0.0, pi / 2)); };
    return (outer * (at(grazing - node * slope_) + at(grazing + node * slope_)) + middle * at(grazing)) / std::sqrt(pi);
}

/** Empirical, for gravel and rock: equations 53 to 56, whose angles are in degrees. */
double SeabedBackscatter::largeRoughness(double grazing) const {
    constexpr double slow_bottom_deg = 2.5613;
    const double nu = seabed_.speed_ratio, rho = seabed_.density_ratio, s = slope_;
    const double critical = nu >= 1.001 ? std::acos(1 / nu) / degree : slow_bottom_deg;
    const double angle = grazing / degree, slope_deg = s / degree;
    const double impedance = (1 - 2 / rho) / (nu * nu) + 1;
    const double level =
        0.04682 * std::pow(s, 1.25) * std::pow(nu, 3.25) * impedance * impedance / (1 + 3.54 * slope_deg / critical);
    const double divisor = 1 + 0.81 * critical * critical / (angle * angle);
    const double from_vertical = (angle - 90) * (angle - 90) / (2.6 * slope_deg * slope_deg);
    return level * std::pow(std::sin(pi / divisor), 0.7263 * std::pow(s, -1.0 / 3)) +
           0.0260 * normal_reflection_ / (s * s * std::pow(1 + from_vertical, 1.9) * divisor);
}

double SeabedBackscatter::volume(double grazing) const {
    return shadowing(grazing) * overSlopes([&](double angle) { return volumeOfAPlane(angle); }, grazing);
}

/** Equations 65 and 66. */
double SeabedBackscatter::volumeOfAPlane(double grazing) const {
    const HalfSpace half_space = halfSpaceOf(seabed_);
    const std::complex<double> kappa = waveNumberRatio(half_space), r = halfSpaceReflection(half_space, grazing);
    const std::complex<double> p = std::sqrt(kappa * kappa - std::pow(std::cos(grazing), 2));
    return 5 * seabed_.loss * seabed_.volume * std::norm(1.0 - r * r) * std::pow(std::sin(grazing), 2) /
           (seabed_.speed_ratio * std::numbers::ln10 * std::norm(p) * p.imag());
}

std::string outsideSeabedModel(double frequency_khz, double speed_of_sound) {
    return outside({{"kHz", frequency_khz, 10, 100}, {"m/s", speed_of_sound, 1400, 1600}});
}

}  // namespace insonify::acoustics
