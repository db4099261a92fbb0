#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/DeploymentSpec.hpp"
#include "components/framework/Registry.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** The deployment down to its sonars, in lockstep so that it takes no longer than it must. */
framework::DeploymentSpec pipelineOf(framework::DeploymentSpec spec, framework::Registry& registry);

/** The deployment with these tasks alone, in lockstep. */
framework::DeploymentSpec restrictedTo(framework::DeploymentSpec spec, const std::set<std::string>& kept);

/** Tasks of the deployment that write pings or read them. */
std::set<std::string> pingTasks(const framework::DeploymentSpec& spec, framework::Registry& registry);

/** These tasks and all from which they hear, directly or not. */
std::set<std::string> upstreamOf(std::set<std::string> names, const framework::Deployment& deployment);

/** Returns assignments (`--set`) that make pings independent of whether a machine has a graphics card: sonars that
 *  would choose between rays and pictures cast rays. A `visibility` that is written stays. Sonars that need pictures
 *  (`published`, `deposit: gpu`) draw on every machine. */
std::vector<std::string> pinnedRays(const framework::DeploymentSpec& spec);

/** The first receiver that gives out codes. Throws types::ConfigError where there is none. */
receiver::ReceiverTask& codingReceiverOf(const framework::Deployment& deployment, const std::string& file);

/** A sonar as it is configured, of the quality that it has chosen, and what it renders in one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** The first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError where there is none. */
SonarAt sonarAt(const std::string& file, uint64_t ping);

/** Pings that a receiver gave out as codes, and by what law. */
struct PingsAt {
    std::vector<types::Sonar> pings;
    receiver::CodeConfig code;
};
/** At most `count` pings from number `ping` on, as the first receiver that gives out codes has them. Throws
 *  types::ConfigError where there is none. @param settings properties that differ from the file's, as `--set` takes
 *  them */
PingsAt codedPingsAt(const std::string& file, uint64_t ping, size_t count,
                     const std::vector<std::string>& settings = {});

}  // namespace insonify::deployer
