#pragma once
#include <cstdint>

#include "components/sonar/HeadConfig.hpp"

namespace insonify::sonar {

/** Where the head of a scanning sonar looks, ping by ping. A sector scan goes from left to right and back, without
 *  a doubled ping where it turns; a continuous one goes on to starboard. Bearings are computed from the number of
 *  steps, so they do not drift. */
class HeadScan {
public:
    explicit HeadScan(const HeadConfig& config);
    /** Bearing of the ping at hand [deg], positive to port; in [left - 360, left] when continuous. */
    double bearingDeg() const;
    void advance();
    /** Until it looks where it looked before, in the same direction of turn [1]. */
    int pingsPerTurn() const;
    const HeadConfig& config() const { return config_; }
    void restart() { ping_ = 0; }

private:
    HeadConfig config_;
    int64_t steps_;     ///< From the left limit to the last position before the right one [1].
    int64_t ping_ = 0;  ///< Since the start.
};

/** Shortest time in which the head makes a step [s]; 0 when its speed is not limited. */
double stepDuration(const HeadConfig& config);

}  // namespace insonify::sonar
