#pragma once
#include <string>
#include <utility>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"
#include "components/pose/Trajectory.hpp"
#include "types/Sonar.hpp"

namespace insonify::deployer {

/** The tasks of a deployment in whose place a forward-looking sonar was recorded; without a deployment their names. */
struct FanTasks {
    std::string sonar = "sonar", receiver = "receiver";
    double largest_code = 0;  ///< Of the receiver.
    bool has_beam_width = false;
    std::vector<std::pair<std::string, pose::Trajectory>> trajectories{};  ///< By the streams of their poses.

    /** Throws types::ConfigError for a deployment without a forward-looking sonar whose receiver gives out codes. */
    static FanTasks of(const framework::DeploymentSpec& spec);
    /** Properties with which the sonar's pings have the shape of this one, as `--set` takes them.
     *  @param range the end of the last bin [m] @param speed_of_sound [m/s], 0: unknown @param frequency_khz 0: unknown
     */
    std::vector<std::string> propertiesOf(const types::Sonar& ping, double range, double speed_of_sound,
                                          double frequency_khz) const;
};

/** Throws types::ConfigError for a deployment without trajectories, for a recording that has no poses. */
void refuseWithoutTrajectory(const FanTasks& tasks, const std::string& deployment);

/** The ping with codes by the receiver's largest in place of the device's. */
types::Sonar withCodesTimes(double factor, types::Sonar ping);

}  // namespace insonify::deployer
