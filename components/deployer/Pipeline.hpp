#pragma once
#include <set>
#include <string>

#include "components/framework/Deployment.hpp"
#include "components/framework/DeploymentSpec.hpp"
#include "components/framework/Registry.hpp"
#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::deployer {

/** The deployment down to its sonars, in lockstep so that it takes no longer than it must. */
framework::DeploymentSpec pipelineOf(framework::DeploymentSpec spec, framework::Registry& registry);

/** Tasks of the deployment that write pings or read them. */
std::set<std::string> pingTasks(const framework::DeploymentSpec& spec, framework::Registry& registry);

/** These tasks and all from which they hear, directly or not. */
std::set<std::string> upstreamOf(std::set<std::string> names, const framework::Deployment& deployment);

/** A sonar as it is configured, of the quality that it has chosen, and what it renders in one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** The first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError where there is none. */
SonarAt sonarAt(const std::string& file, uint64_t ping);

}  // namespace insonify::deployer
