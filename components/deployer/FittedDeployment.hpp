#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "components/noise/Noise.hpp"
#include "components/receiver/Receiver.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::deployer {

/** The chain that makes a deployment's pings, from the scene to the codes. */
struct ChainAt {
    std::string vehicle_task, scene_task, sonar_task, noise_task, receiver_task;
    double period = 0;         ///< Period of the vehicle's poses [s].
    bool looks_abeam = false;  ///< The sonar is a sonar::SideScanTask.
    sonar::SonarConfig sonar;  ///< With the quality that the sonar has chosen.
    types::Snapshot snapshot;
    types::Mount mount;  ///< The sonar's pose in the body.
    noise::NoiseConfig noise;
    receiver::ReceiverConfig receiver;
};

/** Returns the chain up to the first receiver that outputs codes, at the receiver's ping number `ping`, from 1. Throws
 *  types::ConfigError unless the deployment has, one after the other, a pose::TrajectoryTask, a scene::SceneTask, a
 *  sonar::SonarTask or SideScanTask, a noise::NoiseTask and a receiver that outputs codes.
 *  @param settings properties that differ from the file's, as `--set` takes them */
ChainAt chainAt(const std::string& file, uint64_t ping, const std::vector<std::string>& settings);

/** A property: `task.property.path`, its value in YAML ("null" removes it), and its comment. */
struct CommentedSetting {
    std::string path, value, comment;
};

/** Returns a deployment with other properties, each with its comment, as a file for another folder: paths are relative
 *  to that folder. Comments of the original are not kept. Throws types::ConfigError where `file` is not a deployment.
 *  @param head lines of the comment at the beginning */
std::string deploymentWith(const std::string& file, const std::vector<CommentedSetting>& settings,
                           const std::filesystem::path& folder, const std::vector<std::string>& head);

}  // namespace insonify::deployer
