#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>

#include "components/deployer/Pipeline.hpp"
#include "components/deployer/Tasks.hpp"
#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/commands/OculusLog.hpp"
#include "components/log/Writer.hpp"
#include "components/logger/PropertyLog.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/sonar/SonarTask.hpp"
#include "types/Angle.hpp"
#include "types/BeamArc.hpp"
#include "types/ConfigError.hpp"

namespace insonify::device {
namespace {

using framework::Deployment;
using framework::DeploymentSpec;

/** The tasks of the deployment that take part. */
struct Chain {
    std::string sonar, receiver;
    double largest_code = 0;
    bool has_beam_width = false;
};

Chain chainOf(const DeploymentSpec& spec) {
    framework::Registry registry = deployer::coreTasks();
    const Deployment deployment(spec, registry);
    const receiver::ReceiverTask& receiver = deployer::codingReceiverOf(deployment, spec.file);
    const int bits = receiver.config->code.value_or(receiver::CodeConfig{}).bits;
    for (const std::string& name : deployer::upstreamOf({receiver.name()}, deployment))
        if (const auto* sonar = dynamic_cast<const sonar::SonarTask*>(deployment.task(name)))
            return {name, receiver.name(), std::exp2(bits) - 1, sonar->sonarConfig().beam_width_deg.has_value()};
    throw types::ConfigError(spec.file, "tasks." + receiver.name(),
                             "hears no sonar::SonarTask, whose fans are recorded");
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

bool sameShape(const OculusPing& a, const OculusPing& b) {
    return a.bin_count == b.bin_count && a.bearings == b.bearings && a.range_resolution == b.range_resolution &&
           a.speed_of_sound == b.speed_of_sound;
}

/** The trajectories of a deployment, by the streams of their poses. */
std::vector<std::pair<std::string, pose::Trajectory>> trajectoriesOf(const Deployment& deployment) {
    std::vector<std::pair<std::string, pose::Trajectory>> all;
    for (const auto& task : deployment.tasks())
        if (const auto* source = dynamic_cast<const pose::TrajectoryTask*>(task.get()))
            all.emplace_back(source->name() + ".pose", source->trajectory());
    if (all.empty())
        throw types::ConfigError(deployment.spec().file, "tasks",
                                 "have no pose::TrajectoryTask, which tells where the recording was made");
    return all;
}

/** The log that is being made. */
class ImportedLog {
public:
    ImportedLog(const Deployment& deployment, const log::Metadata& metadata, const std::filesystem::path& to,
                const std::string& stream)
        : trajectories_(trajectoriesOf(deployment)), log_(log::createLog(to)) {
        for (const auto& [name, trajectory] : trajectories_)
            poses_.push_back(log_->addStream<types::Pose>(name, metadata));
        pings_ = log_->addStream<types::Sonar>(stream, metadata);
    }
    /** @param elapsed since the first ping [s] */
    void add(const types::Sonar& ping, double elapsed) {
        for (size_t i = 0; i < poses_.size(); ++i) {
            types::Pose pose = trajectories_[i].second.at(elapsed);
            pose.time = ping.time;
            log_->write(poses_[i], ping.time, pose);
        }
        log_->write(pings_, ping.time, ping);
    }
    void close() { log_->close(); }

private:
    std::vector<std::pair<std::string, pose::Trajectory>> trajectories_;
    std::unique_ptr<log::Writer> log_;
    std::vector<size_t> poses_;
    size_t pings_ = 0;
};

log::Metadata metadataOf(framework::Deployment& deployment) {
    return {{"insonify_deployment", deployment.environment().deployment_text},
            {"insonify_seed", std::to_string(deployment.environment().seed)}};
}

/** The properties of all tasks, as the logger writes them beside a log. */
void writeProperties(Deployment& deployment, const std::filesystem::path& to, types::Time first) {
    logger::PropertyLog properties(to.parent_path() / "properties.0.log");
    properties.record(deployment.environment().records(), first, metadataOf(deployment));
    properties.close();
}

/** Codes by the receiver's largest in place of the device's. */
types::Sonar scaled(types::Sonar ping, double factor) {
    for (float& bin : ping.bins) bin = static_cast<float>(static_cast<double>(bin) * factor);
    return ping;
}

}  // namespace

deployer::Imported importOculus(const std::filesystem::path& recording, DeploymentSpec spec,
                                const std::filesystem::path& to) {
    OculusPings source(recording);
    auto recorded = source.next();
    if (!recorded) {
        const std::string why = source.diagnostic().empty() ? "" : ": " + source.diagnostic();
        throw types::ConfigError(recording.string(), "", "holds no ping of an Oculus" + why);
    }
    const OculusPing first = pingOf(recorded->ping);
    const Chain chain = chainOf(spec);
    deployer::Imported imported{.stream = chain.receiver + ".ping", .properties = propertiesOf(chain, first)};
    for (const std::string& property : imported.properties) spec.set(property);
    framework::Registry registry = deployer::coreTasks();
    Deployment deployment(std::move(spec), registry);
    ImportedLog log(deployment, metadataOf(deployment), to, imported.stream);

    constexpr double start_of_captures = 1;  // 0 is no time
    const double begin = recorded->time, start = begin > 0 ? begin : start_of_captures;
    for (; recorded; recorded = source.next()) {
        const OculusPing ping = pingOf(recorded->ping);
        if (!sameShape(ping, first)) {
            ++imported.other_shape;
            continue;
        }
        const double elapsed = recorded->time - begin;
        log.add(
            scaled(sonarOf(ping, types::Time::fromSeconds(start + elapsed)), chain.largest_code / ping.largestCode()),
            elapsed);
        ++imported.pings;
    }
    log.close();
    writeProperties(deployment, to, types::Time::fromSeconds(start));
    imported.diagnostic = source.diagnostic();
    return imported;
}

}  // namespace insonify::device
