#pragma once
#include <span>

#include "components/receiver/ReceiverConfig.hpp"

namespace insonify::receiver {

/** Gain along a ping by which its level follows a target (ACOUSTICS.md 7.5). It begins anew with each ping, so a
 *  replayed ping gets the same gain.
 *
 *  @param means mean intensity of each bin over the beams, other gain included [1]; NaN and bins before `first` are
 *  skipped @param target level that they shall have [dB] @param bin_ms duration of a bin [ms] @param gains_db of each
 * bin [dB] */
void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db);

}  // namespace insonify::receiver
