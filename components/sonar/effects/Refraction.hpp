#pragma once
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::sonar {

/** Gradient of the speed of sound with depth by which refraction is evaluated without a profile: a strong thermocline
 *  [1/s]. */
constexpr double speed_gradient = 0.1;

/** Offset of a ray that a gradient [1/s] bends, at the far edge, and the offset that can be ignored [m]
 *  (ACOUSTICS.md 12). */
struct Bending {
    double offset, tolerated;
};
Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient = speed_gradient);

/** Returns why a sonar cannot bend its rays by its sound speed profile; empty where it can, or where the bend is
 *  negligible.
 *  @throws types::ConfigError with all errors of the profile's file */
std::string whyStraight(const SonarConfig& config);

}  // namespace insonify::sonar
