#pragma once
// The ways to find and sum echoes.
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::test {

/** By rays; rasterised with sums on the processor; rasterised with sums on the (software) device. */
inline std::vector<sonar::SonarConfig> everyRenderer(const sonar::SonarConfig& config) {
    std::vector<sonar::SonarConfig> all(3, config);
    all[0].visibility = sonar::Visibility::Cpu;
    all[1].visibility = all[2].visibility = sonar::Visibility::Gl;
    all[1].deposit = sonar::Deposit::Cpu;
    all[2].deposit = sonar::Deposit::Gpu;
    for (sonar::SonarConfig& each : all) each.device = each.visibility == sonar::Visibility::Gl ? "software" : "";
    return all;
}

}  // namespace insonify::test
