#include "components/acoustics/RoughSurface.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

constexpr double cut_over_wave_number = 1.0 / 3;  ///< Divides longer from shorter relief: decided here [1].
const double lowest_grazing = 0.001 * pi / 180;   ///< Smaller angles have the value of this angle [rad].

}  // namespace

double Relief::spectrum(double wave_number) const {
    const double x = wave_number * length;
    return height * height * length * length / (2 * pi) * std::pow(1 + x * x, -1.5);
}

double Relief::squareSlopeBelow(double wave_number) const {
    const double x = wave_number * length, root = std::sqrt(1 + x * x);
    return std::pow(height / length * x * x / (root + 1), 2) / root;
}

double Relief::squareHeightBelow(double wave_number) const {
    const double x = wave_number * length, root = std::sqrt(1 + x * x);
    return height * height * x * x / (root * (root + 1));
}

double Relief::squareHeightAbove(double wave_number) const {
    return height * height / std::sqrt(1 + std::pow(wave_number * length, 2));
}

RoughSurface::RoughSurface(const HalfSpace& solid, const Relief& relief, double wave_number)
    : solid_(solid), relief_(relief), wave_number_(wave_number), cut_(wave_number * cut_over_wave_number) {
    const double impedance = solid.density_ratio * solid.speed_ratio, k = wave_number;
    reflection_ = (impedance - 1) / (impedance + 1);
    const double lost = -std::expm1(-4 * k * k * relief.squareHeightAbove(cut_));
    lobe_share_ = 1 - lost;
    max_lambert_ = reflection_ * reflection_ * lost / pi;
    // Relief with a small k h reflects as a plane. Only the remaining share of the lobe's energy has slopes.
    square_slope_ = -std::expm1(-4 * k * k * relief.squareHeightBelow(cut_)) * relief.squareSlopeBelow(cut_);
}

double RoughSurface::perturbation(double grazing) const {
    const double scatterers = std::max(2 * wave_number_ * std::cos(grazing), cut_);
    return 4 * std::pow(wave_number_ * std::sin(grazing), 4) * std::norm(roughnessAmplitude(solid_, grazing)) *
           relief_.spectrum(scatterers);
}

double RoughSurface::diffuse(double grazing) const {
    const double angle = std::max(grazing, lowest_grazing), sine = std::sin(angle);
    return std::min(perturbation(angle), max_lambert_ * sine * sine);
}

RoughSurface makeRoughSurface(const MatterProperties& matter, double frequency_khz, double water_density,
                              double speed_of_sound) {
    return {{matter.density / water_density, matter.sound_speed / speed_of_sound, matter.loss},
            {matter.roughness, matter.length},
            2 * pi * 1000 * frequency_khz / speed_of_sound};
}

}  // namespace insonify::acoustics
