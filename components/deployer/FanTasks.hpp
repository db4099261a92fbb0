#pragma once
#include <string>
#include <utility>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"
#include "components/pose/Trajectory.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** The tasks of a deployment that correspond to a recorded forward-looking sonar; without a deployment, default
 *  names. */
struct FanTasks {
    std::string sonar = "sonar", receiver = "receiver";
    double max_code = 0;  ///< The receiver's max code.
    bool has_beam_width = false;
    std::vector<std::pair<std::string, pose::Trajectory>> trajectories{};  ///< By the stream of their poses.

    /** Throws types::ConfigError for a deployment without a forward-looking sonar whose receiver outputs codes. */
    static FanTasks of(const framework::DeploymentSpec& spec);
    /** Returns properties, as `--set` takes them, that give the sonar's pings the shape of this ping.
     *  @param range the end of the last bin [m]
     *  @param speed_of_sound [m/s], 0: unknown
     *  @param frequency_khz 0: unknown */
    std::vector<std::string> propertiesOf(const types::Sonar& ping, double range, double speed_of_sound,
                                          double frequency_khz) const;
};

/** Throws types::ConfigError when the recording has no poses and the deployment has no trajectories. */
void refuseWithoutTrajectory(const FanTasks& tasks, const std::string& deployment);

/** Returns the ping with its codes multiplied by `factor`: from the device's max code to the receiver's. */
types::Sonar withCodesTimes(double factor, types::Sonar ping);

}  // namespace insonify::deployer
