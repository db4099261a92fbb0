#pragma once
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"

namespace insonify::sonar {

/** Gradient of the speed of sound with depth that refraction is judged by without a profile, a strong thermocline
 *  [1/s]. */
constexpr double speed_gradient = 0.1;

/** How far a ray is bent at the far edge by a gradient [1/s], and what of it can be ignored [m] (ACOUSTICS.md 12). */
struct Bending {
    double offset, tolerated;
};
Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient = speed_gradient);

/** Why a sonar cannot bend its rays as its profile of the speed of sound would have them; empty where it can, or where
 *  these are too straight for it to matter.
 *  @throws types::ConfigError with all that is wrong with the profile's file */
std::string whyStraight(const SonarConfig& config);

}  // namespace insonify::sonar
