#pragma once
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** Gradient of the speed of sound with depth by which refraction is evaluated without a profile: a strong thermocline
 *  [1/s]. */
constexpr double speed_gradient = 0.1;

/** Offset of a ray at the far edge that a gradient [1/s] bends, and the offset that can be ignored [m]
 *  (ACOUSTICS.md 12). */
struct Bending {
    double offset, tolerated;
};
Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient = speed_gradient);

/** Returns why a sonar cannot bend its rays by its profile of the speed of sound; empty where it can, or where the bend
 *  is too small to matter.
 *  @throws types::ConfigError with all that is wrong with the profile's file */
std::string whyStraight(const SonarConfig& config);

}  // namespace insonify::sonar
