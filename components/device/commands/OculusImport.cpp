#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "components/deployer/FanTasks.hpp"
#include "components/deployer/RecordedLog.hpp"
#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/commands/OculusLog.hpp"
#include "types/ConfigError.hpp"

namespace insonify::device {
namespace {

using framework::DeploymentSpec;

/** Returns what the recording states of its tasks, for the metadata of a log without a deployment. */
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

/** Returns properties that give the deployment's pings the shape and the law of this ping. */
std::vector<std::string> propertiesOf(const deployer::FanTasks& tasks, const OculusPing& ping) {
    std::vector<std::string> all =
        tasks.propertiesOf(sonarOf(ping, {}),  // the beams of sonarOf are in order
                           ping.range_resolution * ping.bin_count, ping.speed_of_sound, ping.frequency_hz / 1e3);
    all.push_back(tasks.receiver + ".code.law=sqrt");
    all.push_back(fmt::format("{}.code.gamma={}", tasks.receiver, ping.gamma));
    return all;
}

}  // namespace

deployer::Imported importOculus(const std::filesystem::path& recording, std::optional<DeploymentSpec> spec,
                                const std::filesystem::path& to) {
    OculusPings source(recording);
    auto recorded = source.next();
    if (!recorded) {
        const std::string why = source.diagnostic().empty() ? "" : ": " + source.diagnostic();
        throw types::ConfigError(recording.string(), "",
                                 "holds no ping of an Oculus, and is no recording of an ARIS or a Gemini and no XTF or "
                                 "JSF file of a side-scan" +
                                     why);
    }
    const OculusPing first = pingOf(recorded->ping);
    const int bits = first.bits > 8 ? 16 : 8;
    deployer::FanTasks tasks{.max_code = std::exp2(bits) - 1};
    if (spec) {
        tasks = deployer::FanTasks::of(*spec);
        refuseWithoutTrajectory(tasks, spec->file);
    }
    deployer::RecordedLog log(recording, std::move(spec), fanText(bits, first.gamma), to);
    deployer::Imported imported;
    imported.stream = tasks.receiver + ".ping";

    constexpr double start_of_captures = 1;  // 0 is not a valid time
    const double begin = recorded->time, start = begin > 0 ? begin : start_of_captures;
    for (; recorded; recorded = source.next(), ++imported.pings) {
        const OculusPing ping = pingOf(recorded->ping);
        const double elapsed = recorded->time - begin;
        const types::Time time = types::Time::fromSeconds(start + elapsed);
        log.set(propertiesOf(tasks, ping), time);
        for (const auto& [stream, trajectory] : tasks.trajectories) {
            types::Pose pose = trajectory.at(elapsed);
            pose.time = time;
            log.write(stream, pose);
        }
        log.write(imported.stream, deployer::withCodesTimes(tasks.max_code / ping.maxCode(), sonarOf(ping, time)),
                  {{"insonify_frequency_khz", fmt::format("{}", ping.frequency_hz / 1e3)}});
    }
    log.close();
    imported.properties = log.properties();
    imported.changes = log.changes();
    if (!source.diagnostic().empty()) imported.notices.push_back(source.diagnostic());
    return imported;
}

}  // namespace insonify::device
