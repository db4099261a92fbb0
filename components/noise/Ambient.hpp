#pragma once
#include "components/noise/NoiseConfig.hpp"

namespace insonify::noise {

/** Spectrum level of the noise of the sea [dB re 1 uPa^2/Hz] at `frequency_khz` with wind [m/s] and shipping [0..1]:
 *  turbulence, ships, wind on the surface, and the thermal noise of Mellen, which is most of it above some 150 kHz.
 *  R. Coates, Underwater acoustic systems, 1990, after Wenz 1962. */
double coatesSpectrumDb(double frequency_khz, double wind_m_s, double shipping);

/** Mean intensity of the noise in a bin, relative to the source: 10^((N + 10 log10 B - DI - SL) / 10) [1]. */
double ambientIntensity(const AmbientConfig& ambient);

}  // namespace insonify::noise
