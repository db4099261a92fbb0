#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {

/** Returns the deployment reduced to its sonars and their inputs, in lockstep, so that it runs at full speed. */
framework::DeploymentSpec pipeline(framework::DeploymentSpec spec, framework::Registry& registry);

/** Returns the deployment with only these tasks, in lockstep. */
framework::DeploymentSpec restrictedTo(framework::DeploymentSpec spec, const std::set<std::string>& kept);

/** Returns the tasks of the deployment that write or read pings. */
std::set<std::string> pingTasks(const framework::DeploymentSpec& spec, framework::Registry& registry);

/** Loads a deployment with properties that differ from the file's, as `--set` takes them. */
framework::DeploymentSpec specWith(const std::string& file, const std::vector<std::string>& settings);

/** Returns these tasks and all tasks that their inputs come from, directly or not. */
std::set<std::string> upstream(std::set<std::string> names, const framework::Deployment& deployment);

/** Returns assignments (`--set`) that make pings independent of whether a machine has a graphics card: sonars that
 *  would choose between ray tracing and rasterisation trace rays. A `visibility` other than `auto` stays. Sonars that
 *  need rasterisation (`published`, `deposit: gpu`) rasterise on every machine. */
std::vector<std::string> pinnedRays(const framework::DeploymentSpec& spec);

/** Returns the first receiver that outputs codes. Throws types::ConfigError where there is none. */
receiver::ReceiverTask& findCodingReceiver(const framework::Deployment& deployment, const std::string& file);

/** A configured sonar, with the quality that it has chosen, and its input of one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** Returns the first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError where there is
 *  none.
 *  @param settings properties that differ from the file's, as `--set` takes them */
SonarAt sonarAt(const std::string& file, uint64_t ping, const std::vector<std::string>& settings = {});

/** Pings that a receiver output as codes, and the law of the codes. */
struct PingsAt {
    std::vector<types::Sonar> pings;
    receiver::CodeConfig code;
};
/** Returns at most `count` pings from number `ping` on, from the first receiver that outputs codes. Throws
 *  types::ConfigError where there is no such receiver.
 *  @param settings see sonarAt() */
PingsAt codedPingsAt(const std::string& file, uint64_t ping, size_t count,
                     const std::vector<std::string>& settings = {});

}  // namespace insonify::deployer
