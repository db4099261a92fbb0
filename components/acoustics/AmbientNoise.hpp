#pragma once

namespace insonify::acoustics {

/** Spectrum level of the noise of the sea [dB re 1 uPa^2/Hz] at `frequency_khz` with wind [m/s] and shipping [0..1]:
 *  turbulence, ships, wind on the surface, and the thermal noise of Mellen, which is most of it above some 150 kHz.
 *  R. Coates, Underwater acoustic systems, 1990, after Wenz 1962. */
double coatesSpectrumDb(double frequency_khz, double wind_m_s, double shipping);

}  // namespace insonify::acoustics
