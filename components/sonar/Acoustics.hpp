#pragma once
#include "components/acoustics/Absorption.hpp"
#include "components/sonar/SonarConfig.hpp"

namespace insonify::sonar {

/** The configured absorption; none when the block is absent. A law needs `water`. */
acoustics::Absorption makeAbsorption(const SonarConfig& config);

}  // namespace insonify::sonar
