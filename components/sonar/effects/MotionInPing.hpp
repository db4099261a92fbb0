#pragma once
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** Velocities above which motion within a ping changes it: by half a bin at the far edge, or by half the width of a
 *  beam (ACOUSTICS.md 12). */
struct MotionBound {
    double speed;  ///< [m/s]
    double turn;   ///< [rad/s]
};
MotionBound motionBound(const SonarConfig& config, const BinGrid& grid);

/** Returns the range that a chirp adds to an echo per m/s at which its object recedes, f T / B [s]. 0 without a chirp
 *  or without motion within a ping. */
double dopplerCoupling(const SonarConfig& config);

}  // namespace insonify::sonar
