#pragma once
#include <set>
#include <string>

#include "components/framework/DeploymentSpec.hpp"
#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** The deployment down to its sonars, in lockstep so that it takes no longer than it must. */
framework::DeploymentSpec pipelineOf(framework::DeploymentSpec spec, framework::Registry& registry);

/** Tasks of the deployment that write pings or read them. */
std::set<std::string> pingTasks(const framework::DeploymentSpec& spec, framework::Registry& registry);

}  // namespace insonify::deployer
