#pragma once
#include <vector>

#include "components/study/StabilityStudy.hpp"

namespace insonify::deployer {

/** Cases of ACOUSTICS.md 11 that only whole tasks, noise or trajectories show: 18, 45 to 47, 49 to 51. */
std::vector<study::StabilityCase> taskStabilityCases();

}  // namespace insonify::deployer
