#include "components/acoustics/AmbientNoise.hpp"

#include <cmath>

namespace insonify::acoustics {
namespace {

double powerOf(double decibels) { return std::pow(10.0, decibels / 10); }

}  // namespace

double coatesSpectrumDb(double frequency_khz, double wind_m_s, double shipping) {
    const double f = std::log10(frequency_khz);
    const double turbulence = 17 - 30 * f;
    const double ships = 40 + 20 * (shipping - 0.5) + 26 * f - 60 * std::log10(frequency_khz + 0.03);
    const double wind = 50 + 7.5 * std::sqrt(wind_m_s) + 20 * f - 40 * std::log10(frequency_khz + 0.4);
    const double thermal = -15 + 20 * f;
    return 10 * std::log10(powerOf(turbulence) + powerOf(ships) + powerOf(wind) + powerOf(thermal));
}

}  // namespace insonify::acoustics
