#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/noise/NoiseConfig.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Mount.hpp"
#include "types/Snapshot.hpp"

namespace insonify::deployer {

/** What makes a deployment's pings, from the scene to the codes. */
struct ChainAt {
    std::string vehicle_task, scene_task, sonar_task, noise_task, receiver_task;
    double period = 0;         ///< Of the vehicle's poses [s].
    bool looks_abeam = false;  ///< The sonar is a sonar::SideScanTask.
    sonar::SonarConfig sonar;  ///< Of the quality that it has chosen.
    types::Snapshot snapshot;
    types::Mount mount;  ///< Of the sonar in the body.
    noise::NoiseConfig noise;
    receiver::ReceiverConfig receiver;
};

/** The chain that ends at the first receiver that gives out codes, at its ping number `ping`, from 1. Throws
 *  types::ConfigError for a deployment without a pose::TrajectoryTask, a scene::SceneTask, a sonar::SonarTask or
 *  SideScanTask, a noise::NoiseTask and such a receiver, one after the other. */
ChainAt chainAt(const std::string& file, uint64_t ping);

/** A property: `task.property.path`, its value in YAML ("null" takes it out), what is said of it. */
struct CommentedSetting {
    std::string path, value, comment;
};

/** A deployment with other properties, each with its comment, as a file in another folder: files that it reads are
 * named from there. Comments of the deployment itself are not kept. Throws types::ConfigError where the file is no
 *  deployment. @param head lines at its beginning, which become a comment */
std::string deploymentWith(const std::string& file, const std::vector<CommentedSetting>& settings,
                           const std::filesystem::path& folder, const std::vector<std::string>& head);

}  // namespace insonify::deployer
