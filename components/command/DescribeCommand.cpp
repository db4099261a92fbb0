// insonify describe [TYPE]
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>

#include "components/command/CommandLine.hpp"
#include "components/command/SceneCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using framework::PropertyInfo;
using framework::TaskState;

/** Numbers, booleans and lists unchanged, other values as text; null without a default. */
Json defaultJson(const PropertyInfo& property) {
    if (property.default_value.empty()) return nullptr;
    const Json value = Json::parse(property.default_value, nullptr, false);
    return value.is_number() || value.is_boolean() || value.is_array() ? value : Json(property.default_value);
}

Json toBound(double bound) { return std::isfinite(bound) ? Json(bound) : Json(nullptr); }

Json propertyJson(const PropertyInfo& property) {
    return {{"name", property.name},        {"type", property.type},
            {"unit", property.unit},        {"default", defaultJson(property)},
            {"min", toBound(property.min)}, {"max", toBound(property.max)},
            {"doc", property.doc}};
}

Json portJson(const framework::PortBase& port, const char* direction) {
    return {{"name", port.name()}, {"direction", direction}, {"type", port.typeName()}, {"doc", port.doc()}};
}

/** Returns one line for each state of the life cycle, which all tasks share. */
std::vector<std::string> states() {
    std::vector<std::string> names;
    for (TaskState state : {TaskState::PreOperational, TaskState::Stopped, TaskState::Running, TaskState::RunTimeError,
                            TaskState::Exception, TaskState::FatalError})
        names.emplace_back(framework::toString(state));
    return names;
}

Json describeTask(const framework::Registry::Entry& entry) {
    const auto task = entry.make("task");
    Json json = {{"type", entry.type},          {"doc", entry.doc},
                 {"ports", Json::array()},      {"properties", Json::array()},
                 {"operations", Json::array()}, {"states", states()}};
    for (const auto* port : task->inputs()) json["ports"].push_back(portJson(*port, "in"));
    for (const auto* port : task->outputs()) json["ports"].push_back(portJson(*port, "out"));
    for (const auto* properties : task->properties())
        for (const PropertyInfo& property : properties->list()) json["properties"].push_back(propertyJson(property));
    for (const auto* operation : task->operations())
        json["operations"].push_back(
            {{"name", operation->name()}, {"signature", operation->signature()}, {"doc", operation->doc()}});
    return json;
}

std::string boundsText(const Json& property) {
    if (property["min"].is_null() && property["max"].is_null()) return "";
    const auto text = [](const Json& bound, const char* otherwise) {
        return bound.is_null() ? otherwise : fmt::format("{}", bound.get<double>());
    };
    return fmt::format(", {} to {}", text(property["min"], "-inf"), text(property["max"], "inf"));
}

std::string defaultText(const Json& property) {
    const Json& value = property["default"];
    if (value.is_null()) return "";
    return ", default " + (value.is_string() ? value.get<std::string>() : value.dump());
}

std::string unitText(const Json& property) {
    const auto unit = property["unit"].get<std::string>();
    return unit.empty() ? "" : fmt::format(" [{}]", unit);
}

std::string field(const Json& json, const char* key) { return json[key].get<std::string>(); }

void printTask(const Json& task) {
    console::printResult("{}: {}\n\nports\n", field(task, "type"), field(task, "doc"));
    for (const Json& port : task["ports"])
        console::printResult("  {:3}  {}  {}\n       {}\n", field(port, "direction"), field(port, "name"),
                             field(port, "type"), field(port, "doc"));
    console::printResult("\nproperties\n");
    for (const Json& property : task["properties"])
        console::printResult("  {}: {}{}{}\n       {}{}\n", field(property, "name"), field(property, "type"),
                             defaultText(property), boundsText(property), loader::locatePages(field(property, "doc")),
                             unitText(property));
    console::printResult("\noperations\n");
    for (const Json& operation : task["operations"])
        console::printResult("  {}: {}\n       {}\n", field(operation, "name"), field(operation, "signature"),
                             field(operation, "doc"));
    console::printResult("\nstates\n  {}\n", fmt::join(task["states"].get<std::vector<std::string>>(), ", "));
}

int listTasks(const framework::Registry& registry, bool json) {
    Json list = Json::array();
    for (const auto& entry : registry.list()) list.push_back({{"type", entry.type}, {"doc", entry.doc}});
    if (json)
        print(list);
    else
        for (const auto& entry : registry.list()) console::printResult("{:28} {}\n", entry.type, entry.doc);
    return 0;
}

template <class Enum>
std::vector<std::string_view> getNames() {
    return {std::begin(types::EnumNames<Enum>::names), std::end(types::EnumNames<Enum>::names)};
}

int listMaterials(bool json) {
    if (json) {
        print({{"sediments", getNames<scene::Sediment>()}, {"materials", getNames<scene::Matter>()}});
        return 0;
    }
    console::printResult("sediments (material.extras.acoustics = {{\"sediment\": NAME}})\n  {}\n",
                         fmt::join(getNames<scene::Sediment>(), "\n  "));
    console::printResult("materials (material.extras.acoustics = {{\"material\": NAME}})\n  {}\n",
                         fmt::join(getNames<scene::Matter>(), "\n  "));
    return 0;
}

struct Described {
    std::string type, deployment;
    std::vector<std::string> libraries;
    bool json = false;
};

/** Adds the tasks of the libraries that are named, and of those that a deployment names. */
void loadLibraries(const Described& options, framework::Registry& registry) {
    for (const std::string& library : options.libraries) registry.loadLibrary(library);
    if (options.deployment.empty()) return;
    const std::string file = deploymentIn(options.deployment);
    types::Diagnostics wrong =
        registry.loadLibraries(framework::DeploymentSpec::load(file), std::filesystem::path(file).parent_path());
    if (!wrong.empty()) throw types::ConfigError(std::move(wrong));
}

int describe(const Described& options) {
    const std::string& type = options.type;
    const bool json = options.json;
    if (scene::findSceneFormat(type)) return showScene(type, json);
    framework::Registry registry = allTasks();
    loadLibraries(options, registry);
    if (type.empty()) return listTasks(registry, json);
    if (type == "materials") return listMaterials(json);
    for (const auto& entry : registry.list()) {
        if (entry.type != type) continue;
        const Json task = describeTask(entry);
        json ? print(task) : printTask(task);
        return 0;
    }
    if (const std::string owner = type.substr(0, type.find(':'));
        loader::findComponent(owner) && !loader::isPresent(owner))
        throw types::ConfigError("", type, "is in " + loader::absence(owner));
    std::vector<std::string> known{"materials"};
    for (const auto& entry : registry.list()) known.push_back(entry.type);
    throw types::ConfigError("", type,
                             "is no task type; " + framework::suggestion(type, known) +
                                 "; a task of your own is read with --library FILE or --deployment FILE");
}

}  // namespace

void addDescribeCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<Described>();
    CLI::App* command = app.add_subcommand("describe", "Lists the tasks; or a task's ports, properties and operations");
    command->add_option("TYPE", options->type, "a task type, `materials` for the names of materials, or a scene file");
    command->add_option("--library", options->libraries, "a shared object with tasks of your own; may be given again")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command->add_option("--deployment", options->deployment, "also the tasks of the `libraries` of this deployment")
        ->type_name("FILE");
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return describe(*options); }; });
}

}  // namespace insonify::command
