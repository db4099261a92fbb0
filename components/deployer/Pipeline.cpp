#include "components/deployer/Pipeline.hpp"

#include <stdexcept>
#include <vector>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Simulation.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Port.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {
namespace {

using framework::Deployment;
using framework::DeploymentSpec;

bool anyCarriesPings(const auto& ports) {
    for (const auto* port : ports)
        if (port->typeName() == types::Sonar::type_name) return true;
    return false;
}

std::set<std::string> upstreamOfSonars(const Deployment& deployment) {
    std::set<std::string> names;
    for (const auto& task : deployment.tasks())
        if (anyCarriesPings(task->outputs()) && !anyCarriesPings(task->inputs())) names.insert(task->name());
    return upstream(std::move(names), deployment);
}

receiver::ReceiverTask* codingReceiver(const Deployment& deployment) {
    for (const auto& task : deployment.tasks()) {
        auto* found = dynamic_cast<receiver::ReceiverTask*>(task.get());
        if (found && found->config->output == receiver::Output::Code) return found;
    }
    return nullptr;
}

}  // namespace

std::vector<std::string> pinnedRays(const DeploymentSpec& spec) {
    std::vector<std::string> assignments;
    for (const framework::TaskSpec& task : spec.tasks) {
        const auto toText = [&](const char* key) {
            const YAML::Node value = framework::child(task.properties, key);
            return value.IsDefined() && value.IsScalar() ? value.Scalar() : "";
        };
        const std::string visibility = toText("visibility");
        const bool is_drawn =
            toText("deposit") == "gpu" || framework::child(task.properties, "published").as<bool>(false);
        if (task.type.starts_with("sonar::") && !is_drawn && (visibility.empty() || visibility == "auto"))
            assignments.push_back(task.name + ".visibility=cpu");
    }
    return assignments;
}

receiver::ReceiverTask& findCodingReceiver(const Deployment& deployment, const std::string& file) {
    if (auto* found = codingReceiver(deployment)) return *found;
    throw types::ConfigError(file, "tasks",
                             "has no receiver that outputs codes, as instruments do: set output: code for one");
}

std::set<std::string> upstream(std::set<std::string> names, const Deployment& deployment) {
    for (size_t before = 0; before != names.size();) {
        before = names.size();
        for (const framework::Connection& connection : deployment.connections())
            if (names.contains(connection.to->owner().name())) names.insert(connection.from->owner().name());
    }
    return names;
}

DeploymentSpec restrictedTo(DeploymentSpec spec, const std::set<std::string>& kept) {
    const auto keeps = [&](const std::string& port) { return kept.contains(framework::splitPort(port).first); };
    std::vector<framework::TaskSpec> tasks;  // a new list: assigning a YAML node would change its other references
    for (const auto& task : spec.tasks)
        if (kept.contains(task.name)) tasks.push_back(task);
    std::vector<framework::ConnectionSpec> connections;
    for (const auto& connection : spec.connections)
        if (keeps(connection.from) && keeps(connection.to)) connections.push_back(connection);
    spec.tasks.swap(tasks);
    spec.connections.swap(connections);
    spec.lockstep = true;
    return spec;
}

DeploymentSpec pipeline(DeploymentSpec spec, framework::Registry& registry) {
    return restrictedTo(spec, upstreamOfSonars(Deployment(spec, registry)));
}

std::set<std::string> pingTasks(const DeploymentSpec& spec, framework::Registry& registry) {
    std::set<std::string> names;
    const Deployment deployment(spec, registry);
    for (const auto& task : deployment.tasks())
        if (anyCarriesPings(task->outputs()) || anyCarriesPings(task->inputs())) names.insert(task->name());
    return names;
}

DeploymentSpec specWith(const std::string& file, const std::vector<std::string>& settings) {
    DeploymentSpec spec = DeploymentSpec::load(deploymentIn(file));
    for (const std::string& setting : settings) spec.set(setting);
    return spec;
}

SonarAt sonarAt(const std::string& file, uint64_t ping, const std::vector<std::string>& settings) {
    framework::Registry registry = coreTasks();
    Deployment deployment(pipeline(specWith(file, settings), registry), registry);
    deployment.configure();
    const framework::RunResult result = deployment.run({.samples = ping}, stopOnSignals());
    if (result.failed()) throw std::runtime_error(result.failures.front());
    for (const auto& task : deployment.tasks()) {
        auto* sonar = dynamic_cast<sonar::PingTask*>(task.get());
        types::SnapshotPtr snapshot;
        if (!sonar || !sonar->plan() || sonar->snapshot.read(snapshot) == framework::FlowStatus::NoData) continue;
        SonarAt found{sonar->sonarConfig(), *snapshot};
        found.config.quality = {};
        found.config.quality.rows = sonar->plan()->rows;
        found.config.quality.columns_per_beam = sonar->plan()->columns_per_beam;
        return found;
    }
    throw types::ConfigError(file, "tasks", "has no sonar that got a snapshot: nothing to study");
}

PingsAt codedPingsAt(const std::string& file, uint64_t ping, size_t count, const std::vector<std::string>& settings) {
    framework::Registry registry = coreTasks();
    const DeploymentSpec spec = specWith(file, settings);
    const Deployment whole(spec, registry);
    const std::set<std::string> kept = upstream({findCodingReceiver(whole, file).name()}, whole);
    Deployment deployment(restrictedTo(spec, kept), registry);
    receiver::ReceiverTask& receiver = findCodingReceiver(deployment, file);
    PingReader reader("reader");
    receiver.ping.connectTo(reader.ping, framework::ConnPolicy::circularBuffer(count));
    deployment.configure();
    const framework::RunResult result = deployment.run({.samples = ping + count - 1}, stopOnSignals());
    if (result.failed()) throw std::runtime_error(result.failures.front());
    PingsAt found{.pings = {}, .code = receiver.config->code.value_or(receiver::CodeConfig{})};
    for (types::SonarPtr received; reader.ping.readNew(received);) found.pings.push_back(*received);
    if (found.pings.empty())
        throw types::ConfigError(file, "tasks." + receiver.name(), "wrote no ping: nothing to study");
    return found;
}

}  // namespace insonify::deployer
