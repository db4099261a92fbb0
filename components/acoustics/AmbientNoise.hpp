#pragma once
#include <cmath>

namespace insonify::acoustics {

/** Returns the spectrum level of the noise of the sea [dB re 1 uPa^2/Hz] for a wind speed [m/s] and shipping [0..1]. It
 *  sums turbulence, ships, wind on the surface, and the thermal noise of Mellen, which dominates above about 150 kHz.
 *  R. Coates, Underwater acoustic systems, 1990, after Wenz 1962. */
inline double coatesSpectrumDb(double frequency_khz, double wind_m_s, double shipping) {
    const double f = std::log10(frequency_khz);
    const double turbulence = 17 - 30 * f;
    const double ships = 40 + 20 * (shipping - 0.5) + 26 * f - 60 * std::log10(frequency_khz + 0.03);
    const double wind = 50 + 7.5 * std::sqrt(wind_m_s) + 20 * f - 40 * std::log10(frequency_khz + 0.4);
    const double thermal = -15 + 20 * f;
    const auto power = [](double decibels) { return std::pow(10.0, decibels / 10); };
    return 10 * std::log10(power(turbulence) + power(ships) + power(wind) + power(thermal));
}

}  // namespace insonify::acoustics
