#pragma once
#include <string>
#include <vector>

#include "components/sonar/SonarConfig.hpp"
#include "types/Geometry.hpp"
#include "types/Plan.hpp"

namespace insonify::sonar {

/** Decides, once per scene, what is compiled and run, and gives the reason or bound for everything left out. */
types::Plan makePlan(const SonarConfig& config, const types::Geometry& geometry);

/** What a user should know of the configuration alone: range reached, water outside a law's validity... */
std::vector<std::string> configNotices(const SonarConfig& config);

}  // namespace insonify::sonar
