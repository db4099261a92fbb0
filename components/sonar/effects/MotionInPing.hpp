#pragma once
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** Velocities from which motion within a ping changes it: by half a bin at the far edge, by half the width of a beam
 *  (ACOUSTICS.md 12). */
struct MotionBound {
    double speed;  ///< [m/s]
    double turn;   ///< [rad/s]
};
MotionBound motionBound(const SonarConfig& config, const BinGrid& grid);

/** Range that a chirp adds to an echo for each metre a second at which its object recedes, f T / B [s]. 0 without a
 *  chirp or without motion within a ping. */
double dopplerCoupling(const SonarConfig& config);

}  // namespace insonify::sonar
