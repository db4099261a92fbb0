// insonify check DEPLOYMENT
#include <fmt/core.h>

#include <memory>
#include <set>

#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Offers.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

const char* getName(framework::ConnPolicy::Type type) {
    switch (type) {
        case framework::ConnPolicy::Data: return "data";
        case framework::ConnPolicy::Buffer: return "buffer";
        case framework::ConnPolicy::CircularBuffer: return "circular_buffer";
    }
    return "";
}

Json taskJson(const framework::TaskSpec& task) {
    Json json = {{"name", task.name}, {"type", task.type}};
    if (task.activity.periodic())
        json["activity"] = {{"period", task.activity.period}};
    else
        json["activity"] = {{"trigger", task.activity.trigger}};
    return json;
}

Json connectionJson(const framework::Connection& connection) {
    Json policy = {{"type", getName(connection.policy.type)}};
    if (connection.policy.type != framework::ConnPolicy::Data) policy["size"] = connection.policy.size;
    return {{"from", connection.from->path()},
            {"to", connection.to->path()},
            {"type", connection.from->typeName()},
            {"policy", policy}};
}

/** Configures the tasks that lead to pings, which find the graphics device but open no files and ports to write, and
 * returns what all tasks report at the start of a run. */
types::Notices findNotices(framework::Deployment& deployment) {
    std::set<std::string> names;
    for (const auto& task : deployment.tasks())
        for (const framework::OutputPortBase* port : task->outputs())
            if (port->typeName() == types::Sonar::type_name) names.insert(task->name());
    names = upstream(std::move(names), deployment);
    deployment.configure([&](const framework::TaskContext& task) {
        return names.contains(task.name()) && dynamic_cast<const framework::Divisible*>(&task);
    });
    types::Notices all;
    for (const std::string& line : deployment.spec().unused()) all.push_back(types::warning(line));
    for (const auto& task : deployment.tasks())
        for (const types::Notice& notice : task->notices())
            all.emplace_back(task->name() + ": " + notice.text, notice.kind);
    return all;
}

Json validJson(const framework::Deployment& deployment, const types::Notices& notices) {
    Json json = {{"valid", true}, {"errors", Json::array()}, {"tasks", Json::array()}, {"connections", Json::array()}};
    if (const auto& datum = deployment.spec().datum) json["datum"] = Json::parse(framework::flowYaml(*datum));
    json["warnings"] = json["notices"] = Json::array();
    for (const types::Notice& notice : notices)
        json[notice.kind == types::Notice::Kind::Warning ? "warnings" : "notices"].push_back(notice.text);
    for (const auto& task : deployment.spec().tasks) json["tasks"].push_back(taskJson(task));
    for (const auto& connection : deployment.connections()) json["connections"].push_back(connectionJson(connection));
    return json;
}

Json invalidJson(const types::ConfigError& error) {
    Json json = {{"valid", false}, {"errors", Json::array()}, {"tasks", Json::array()}, {"connections", Json::array()}};
    for (const auto& diagnostic : error.diagnostics()) json["errors"].push_back(toJson(diagnostic));
    return json;
}

std::string activityText(const framework::ActivitySettings& activity) {
    return activity.periodic() ? fmt::format("every {} s", activity.period) : "on new samples";
}

/** Prints each task with its outgoing connections, writers before readers. */
void printGraph(framework::Deployment& deployment, const types::Notices& notices) {
    const framework::DeploymentSpec& spec = deployment.spec();
    console::printResult("{}: valid, {}, {} tasks, {} connections\n", spec.file,
                         spec.lockstep ? "lockstep" : "realtime", deployment.tasks().size(),
                         deployment.connections().size());
    if (spec.datum) console::printResult("datum: {}\n", text(*spec.datum));
    for (const types::Notice& notice : notices) console::printResult("{}\n", labelled(notice));
    for (const framework::TaskContext* task : deployment.order()) {
        const framework::TaskSpec written = *framework::DeploymentSpec(spec).task(task->name());
        console::printResult("{} ({}, {})\n", written.name, written.type, activityText(written.activity));
        for (const framework::Connection& connection : deployment.connections()) {
            if (&connection.from->owner() != task) continue;
            const std::string size =
                connection.policy.type == framework::ConnPolicy::Data ? "" : fmt::format(" {}", connection.policy.size);
            console::printResult("  {} -> {}  {}, {}{}\n", connection.from->name(), connection.to->path(),
                                 connection.from->typeName(), getName(connection.policy.type), size);
        }
    }
}

int check(const RunOptions& options, bool json) {
    framework::Registry registry = coreTasks();
    try {
        framework::Deployment deployment(loadSpec(options), registry);
        const types::Notices notices = findNotices(deployment);
        json ? print(validJson(deployment, notices)) : printGraph(deployment, notices);
        return 0;
    } catch (const types::ConfigError& error) {
        if (json) print(invalidJson(error));
        throw;
    }
}

}  // namespace

void addCheckCommand(CLI::App& app, Action& action) {
    struct Options {
        RunOptions run;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("check", "Validates a deployment and prints its graph");
    options->run.addDeploymentTo(*command);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return check(options->run, options->json); }; });
}

}  // namespace insonify::command
