#pragma once
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** From where on motion within a ping is heard: half a bin at the far edge, half the width of a beam (ACOUSTICS.md 12).
 */
struct MotionBound {
    double speed;  ///< [m/s]
    double turn;   ///< [rad/s]
};
MotionBound motionBound(const SonarConfig& config, const BinGrid& grid);

/** What a chirp adds to the range of an echo for each metre a second at which it recedes, f T / B; 0: nothing [s]. */
double dopplerCoupling(const SonarConfig& config);

}  // namespace insonify::sonar
