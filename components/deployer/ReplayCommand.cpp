// insonify replay LOG DEPLOYMENT
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

/** Whether what a port has written is in the stream, not the values of a property. */
bool isOfPort(const pocolog::Stream& stream) {
    const auto type = stream.metadata.find("rock_stream_type");
    return type == stream.metadata.end() || type->second == "port";
}

/** Tasks of the deployment that have a stream in the log. */
std::set<std::string> loggedTasks(const pocolog::Reader& log, DeploymentSpec& spec) {
    std::set<std::string> names;
    for (const pocolog::Stream& stream : log.streams())
        if (const std::string task = splitPort(stream.name).first; isOfPort(stream) && spec.task(task))
            names.insert(task);
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

/** Connections of logged ports lead from the replay; those that a replaced task would have read, or written without
 *  a stream in the log, are left out. */
std::vector<framework::ConnectionSpec> reconnected(const DeploymentSpec& spec, const pocolog::Reader& log,
                                                   const std::set<std::string>& replaced, const std::string& replay) {
    std::vector<framework::ConnectionSpec> connections;
    for (const framework::ConnectionSpec& written : spec.connections) {
        const bool from_log = replaced.contains(splitPort(written.from).first);
        if (replaced.contains(splitPort(written.to).first) || (from_log && !log.find(written.from))) continue;
        connections.push_back(written);
        if (from_log) connections.back().from = replay + "." + written.from;
    }
    return connections;
}

/** The deployment with the log in the place of the tasks that it has streams of. New lists are made, since assigning
 *  a YAML node changes what other nodes see. */
DeploymentSpec replaying(DeploymentSpec spec, const std::string& log_file) {
    const pocolog::Reader log(log_file);
    const std::set<std::string> replaced = loggedTasks(log, spec);
    if (replaced.empty()) throw types::ConfigError(log_file, "", "none of its streams is of a task of " + spec.file);

    const std::string name = freeName(spec);
    std::vector<framework::TaskSpec> tasks{replayTask(name, log_file)};
    for (const framework::TaskSpec& task : spec.tasks)
        if (!replaced.contains(task.name)) tasks.push_back(task);
    std::vector<framework::ConnectionSpec> connections = reconnected(spec, log, replaced, name);
    spec.tasks.swap(tasks);
    spec.connections.swap(connections);
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
