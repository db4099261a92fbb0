#pragma once
#include <cstdint>

#include "components/noise/NoiseConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::noise {

/** Gives `noisy` everything of `clean` and its bins with noise: first the speckle factor, then the additive part.
 *
 *  The variate of a bin depends on (seed, ping, beam, bin) alone, where the ping is known by its time in microseconds:
 *  a replayed log gets the noise of the run that it came from. Bins are taken as linear intensities; NaN stays NaN,
 *  and nothing that was not negative becomes negative. Allocates nothing once `noisy` has held a ping of this shape.
 *  @return how many gaussian factors were below 0 and clamped. */
uint64_t addNoise(const NoiseConfig& config, const types::Sonar& clean, types::Sonar& noisy);

}  // namespace insonify::noise
