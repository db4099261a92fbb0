#pragma once
#include <span>

#include "components/receiver/ReceiverConfig.hpp"

namespace insonify::receiver {

/** Computes the gain along a ping that brings its level to a target (ACOUSTICS.md 7.5). The gain starts anew with each
 *  ping, so a replayed ping gets the same gain.
 *
 *  @param means mean intensity of each bin over the beams, other gain included [1]
 *  @param first bins before this, and bins of NaN, are skipped
 *  @param target level of the means with the gain [dB]
 *  @param bin_ms time in which the echoes of a bin are received: two-way [ms]
 *  @param gains_db output, gain of each bin [dB] */
void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db);

}  // namespace insonify::receiver
