#pragma once
#include "components/noise/NoiseConfig.hpp"

namespace insonify::noise {

/** Mean intensity of the noise in a bin, relative to the source: 10^((N + 10 log10 B - DI - SL) / 10) [1]. */
double ambientIntensity(const AmbientConfig& ambient);

}  // namespace insonify::noise
