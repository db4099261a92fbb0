// insonify replay LOG DEPLOYMENT
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <set>

#include "components/deployer/Commands.hpp"
#include "components/deployer/RunOptions.hpp"
#include "components/pocolog/Reader.hpp"

namespace insonify::deployer {
namespace {

using framework::DeploymentSpec;
using framework::splitPort;

/** Tasks of the deployment that have a stream in the log. */
std::set<std::string> loggedTasks(const pocolog::Reader& log, DeploymentSpec& spec) {
    std::set<std::string> names;
    for (const pocolog::Stream& stream : log.streams())
        if (const std::string task = splitPort(stream.name).first; spec.task(task)) names.insert(task);
    return names;
}

/** A name that no task has. */
std::string freeName(DeploymentSpec& spec) {
    std::string name = "replay";
    while (spec.task(name)) name += "_";
    return name;
}

framework::TaskSpec replayTask(const std::string& name, const std::filesystem::path& log) {
    framework::TaskSpec task;
    task.name = name;
    task.type = "replay::ReplayTask";
    task.properties = YAML::Node(YAML::NodeType::Map);
    task.properties["file"] = std::filesystem::absolute(log).string();
    return task;
}

/** Leads connections of logged ports from the replay, drops what a replaced task would have read or not logged, and
 *  tells which streams lead somewhere. */
std::set<std::string> reconnect(DeploymentSpec& spec, const pocolog::Reader& log, const std::set<std::string>& replaced,
                                const std::string& replay) {
    std::erase_if(spec.connections, [&](const framework::ConnectionSpec& connection) {
        const bool from_replaced = replaced.contains(splitPort(connection.from).first);
        return replaced.contains(splitPort(connection.to).first) || (from_replaced && !log.find(connection.from));
    });
    std::set<std::string> used;
    for (framework::ConnectionSpec& connection : spec.connections) {
        if (!replaced.contains(splitPort(connection.from).first)) continue;
        used.insert(connection.from);
        connection.from = replay + "." + connection.from;
    }
    return used;
}

/** The deployment with the log in the place of the tasks that it has streams of. */
DeploymentSpec replaying(DeploymentSpec spec, const std::string& log_file) {
    const pocolog::Reader log(log_file);
    const std::set<std::string> replaced = loggedTasks(log, spec);
    const std::string name = freeName(spec);
    const std::set<std::string> used = reconnect(spec, log, replaced, name);
    for (const pocolog::Stream& stream : log.streams())
        if (!used.contains(stream.name))
            fmt::print(stderr, "notice: stream {} matches no connected port of {}\n", stream.name, spec.file);
    if (used.empty())
        throw types::ConfigError(log_file, "", "no stream of it matches a connected port of " + spec.file);

    std::erase_if(spec.tasks, [&](const framework::TaskSpec& task) { return replaced.contains(task.name); });
    spec.tasks.insert(spec.tasks.begin(), replayTask(name, log_file));
    return spec;
}

}  // namespace

void addReplayCommand(CLI::App& app, Action& action) {
    struct Options : RunOptions {
        std::string log;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("replay", "Runs a deployment with a log's streams in the place of its tasks");
    command->add_option("LOG", options->log, "a pocolog file")->required();
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file")->required();
    options->addTo(*command);
    command->callback([options, &action] {
        action = [options] { return runDeployment(replaying(loadSpec(*options), options->log), *options); };
    });
}

}  // namespace insonify::deployer
