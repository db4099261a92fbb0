#pragma once
#include <memory>

#include "types/Sonar.hpp"

namespace insonify::receiver {

/** A ping of bins of 0.1 m, all of one intensity, in beams of 2 deg. */
inline types::Sonar pingOf(uint32_t beams, uint32_t bins, float value = 1, int64_t time = 1000000) {
    types::Sonar ping;
    ping.time.microseconds = time;
    ping.bin_duration.microseconds = 100;
    ping.speed_of_sound = 1000;
    ping.beam_width = types::Angle::fromDeg(2);
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bearings.assign(beams, types::Angle{0});
    ping.bins.assign(size_t{beams} * bins, value);
    return ping;
}

inline types::SonarPtr shared(const types::Sonar& ping) { return std::make_shared<const types::Sonar>(ping); }

}  // namespace insonify::receiver
