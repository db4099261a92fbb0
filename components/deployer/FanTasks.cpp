#include "components/deployer/FanTasks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <tuple>

#include "components/deployer/RecordedLog.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/sonar/tasks/SonarTask.hpp"
#include "types/Angle.hpp"
#include "types/BeamArc.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {

FanTasks FanTasks::of(const framework::DeploymentSpec& spec) {
    framework::Registry registry = coreTasks();
    const framework::Deployment deployment(spec, registry);
    FanTasks tasks;
    std::tie(tasks.sonar, tasks.receiver) = recordedTasks<sonar::SonarTask>(deployment, "sonar::SonarTask");
    const receiver::ReceiverTask& receiver = codingReceiverOf(deployment, spec.file);
    tasks.max_code = std::exp2(receiver.config->code.value_or(receiver::CodeConfig{}).bits) - 1;
    const auto* sonar = dynamic_cast<const sonar::SonarTask*>(deployment.task(tasks.sonar));
    tasks.has_beam_width = sonar->sonarConfig().beam_width_deg.has_value();
    for (const auto& task : deployment.tasks())
        if (const auto* source = dynamic_cast<const pose::TrajectoryTask*>(task.get()))
            tasks.trajectories.emplace_back(source->name() + ".pose", source->trajectory());
    return tasks;
}

std::vector<std::string> FanTasks::propertiesOf(const types::Sonar& ping, double range, double speed_of_sound,
                                                double frequency_khz) const {
    std::vector<double> bearings;
    for (const types::Angle bearing : ping.bearings) bearings.push_back(types::degrees(bearing.rad));
    std::vector<std::string> all;
    const auto set = [&](const char* property, const auto& value) {
        all.push_back(fmt::format("{}.{}={}", sonar, property, value));
    };
    set("range", range);
    set("bin_count", ping.bin_count);
    set("range_rounding", "exact");
    if (speed_of_sound > 0) set("speed_of_sound", speed_of_sound);
    if (frequency_khz > 0) set("frequency_khz", frequency_khz);
    set("bearings_deg", bearings);
    if (!has_beam_width)  // as wide as their spacing
        set("beam_width_deg", types::degrees(types::BeamArc(ping).width));
    return all;
}

void refuseWithoutTrajectory(const FanTasks& tasks, const std::string& deployment) {
    if (tasks.trajectories.empty())
        throw types::ConfigError(deployment, "tasks",
                                 "have no pose::TrajectoryTask, which states where the recording was made");
}

types::Sonar withCodesTimes(double factor, types::Sonar ping) {
    for (float& bin : ping.bins) bin = static_cast<float>(static_cast<double>(bin) * factor);
    return ping;
}

}  // namespace insonify::deployer
