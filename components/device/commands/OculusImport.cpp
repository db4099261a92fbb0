#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "components/deployer/RecordedLog.hpp"
#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/commands/OculusLog.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/sonar/SonarTask.hpp"
#include "types/Angle.hpp"
#include "types/BeamArc.hpp"
#include "types/ConfigError.hpp"

namespace insonify::device {
namespace {

using framework::Deployment;
using framework::DeploymentSpec;

/** The tasks that take part: those of a deployment, or what the recording states without one. */
struct Chain {
    std::string sonar = "sonar", receiver = "receiver";
    double largest_code = 0;
    bool has_beam_width = false;
    std::vector<std::pair<std::string, pose::Trajectory>> trajectories{};  ///< By the streams of their poses.
};

Chain chainOf(const DeploymentSpec& spec) {
    framework::Registry registry = deployer::coreTasks();
    const Deployment deployment(spec, registry);
    Chain chain;
    std::tie(chain.sonar, chain.receiver) = deployer::recordedTasksOf<sonar::SonarTask>(deployment, "sonar::SonarTask");
    const receiver::ReceiverTask& receiver = deployer::codingReceiverOf(deployment, spec.file);
    chain.largest_code = std::exp2(receiver.config->code.value_or(receiver::CodeConfig{}).bits) - 1;
    const auto* sonar = dynamic_cast<const sonar::SonarTask*>(deployment.task(chain.sonar));
    chain.has_beam_width = sonar->sonarConfig().beam_width_deg.has_value();
    for (const auto& task : deployment.tasks())
        if (const auto* source = dynamic_cast<const pose::TrajectoryTask*>(task.get()))
            chain.trajectories.emplace_back(source->name() + ".pose", source->trajectory());
    if (chain.trajectories.empty())
        throw types::ConfigError(spec.file, "tasks",
                                 "have no pose::TrajectoryTask, which states where the recording was made");
    return chain;
}

/** What the recording states of its tasks, for the metadata of a log without a deployment. */
std::string fanText(int bits, double gamma) {
    return fmt::format(
        "# A sonar as its recording states it.\n"
        "tasks:\n"
        "  sonar: {{type: sonar::SonarTask}}\n"
        "  receiver:\n"
        "    type: receiver::ReceiverTask\n"
        "    properties: {{output: code, code: {{bits: {}, law: sqrt, gamma: {}}}}}\n"
        "connections:\n"
        "  - {{from: sonar.ping, to: receiver.intensity}}\n",
        bits, gamma);
}

/** Properties with which the deployment's pings have the shape and the law of this one. */
std::vector<std::string> propertiesOf(const Chain& chain, const OculusPing& ping) {
    const types::Sonar logged = sonarOf(ping, {});  // its beams are in order
    std::vector<double> bearings;
    for (const types::Angle bearing : logged.bearings) bearings.push_back(types::degrees(bearing.rad));
    std::vector<std::string> all;
    const auto set = [&](const std::string& task, const char* property, const auto& value) {
        all.push_back(fmt::format("{}.{}={}", task, property, value));
    };
    set(chain.sonar, "range", ping.range_resolution * ping.bin_count);
    set(chain.sonar, "bin_count", ping.bin_count);
    set(chain.sonar, "range_rounding", "exact");
    if (ping.speed_of_sound > 0) set(chain.sonar, "speed_of_sound", ping.speed_of_sound);
    if (ping.frequency_hz > 0) set(chain.sonar, "frequency_khz", ping.frequency_hz / 1e3);
    set(chain.sonar, "bearings_deg", bearings);
    if (!chain.has_beam_width)  // as wide as they are apart
        set(chain.sonar, "beam_width_deg", types::degrees(types::BeamArc(logged).width));
    set(chain.receiver, "code.law", "sqrt");
    set(chain.receiver, "code.gamma", ping.gamma);
    return all;
}

/** Codes by the receiver's largest in place of the device's. */
types::Sonar scaled(types::Sonar ping, double factor) {
    for (float& bin : ping.bins) bin = static_cast<float>(static_cast<double>(bin) * factor);
    return ping;
}

}  // namespace

deployer::Imported importOculus(const std::filesystem::path& recording, std::optional<DeploymentSpec> spec,
                                const std::filesystem::path& to) {
    OculusPings source(recording);
    auto recorded = source.next();
    if (!recorded) {
        const std::string why = source.diagnostic().empty() ? "" : ": " + source.diagnostic();
        throw types::ConfigError(recording.string(), "",
                                 "holds no ping of an Oculus, and is no XTF or JSF file of a side-scan" + why);
    }
    const OculusPing first = pingOf(recorded->ping);
    const int bits = first.bits > 8 ? 16 : 8;
    const Chain chain = spec ? chainOf(*spec) : Chain{.largest_code = std::exp2(bits) - 1};
    deployer::RecordedLog log(recording, std::move(spec), fanText(bits, first.gamma), to);
    deployer::Imported imported;
    imported.stream = chain.receiver + ".ping";

    constexpr double start_of_captures = 1;  // 0 is no time
    const double begin = recorded->time, start = begin > 0 ? begin : start_of_captures;
    for (; recorded; recorded = source.next(), ++imported.pings) {
        const OculusPing ping = pingOf(recorded->ping);
        const double elapsed = recorded->time - begin;
        const types::Time time = types::Time::fromSeconds(start + elapsed);
        log.set(propertiesOf(chain, ping), time);
        for (const auto& [stream, trajectory] : chain.trajectories) {
            types::Pose pose = trajectory.at(elapsed);
            pose.time = time;
            log.write(stream, pose);
        }
        log.write(imported.stream, scaled(sonarOf(ping, time), chain.largest_code / ping.largestCode()),
                  {{"insonify_frequency_khz", fmt::format("{}", ping.frequency_hz / 1e3)}});
    }
    log.close();
    imported.properties = log.properties();
    imported.changes = log.changes();
    if (!source.diagnostic().empty()) imported.notices.push_back(source.diagnostic());
    return imported;
}

}  // namespace insonify::device
