// insonify libraries: the available component libraries, or those that a deployment lacks
#include <fmt/core.h>

#include <memory>
#include <set>

#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/output/PictureFiles.hpp"
#include "components/scene/Scene.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

/** Adds the libraries that properties need: for a file named in a text, or for a block. */
void addNeeded(const YAML::Node& node, std::set<std::string>& names) {
    if (node.IsSequence())
        for (const auto& element : node) addNeeded(element, names);
    if (node.IsMap())
        for (const auto& entry : node) {
            const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
            if (key == "bathymetry") names.insert("survey");
            if (key == "gazebo") names.insert("gazebo");
            addNeeded(entry.second, names);
        }
    if (!node.IsDefined() || !node.IsScalar()) return;
    const scene::SceneFormat* const format = scene::findSceneFormat(node.Scalar());
    if (format && !format->component.empty()) names.emplace(format->component);
    if (output::findFileFormat(node.Scalar(), output::FileContent::Video)) names.insert("video");
}

std::set<std::string> neededBy(const framework::DeploymentSpec& spec) {
    std::set<std::string> names;
    for (const framework::TaskSpec& task : spec.tasks) {
        const std::string owner = task.type.substr(0, task.type.find(':'));
        if (loader::findComponent(owner)) names.insert(owner);
        addNeeded(task.properties, names);
    }
    return names;
}

/** Returns why a library cannot be loaded; empty: it can be. */
std::string findDamage(const std::string& name) try {
    loader::load(name);
    return "";
} catch (const types::ConfigError& error) {
    return error.diagnostics().front().text();
}

int listLacking(const std::string& deployment) {
    for (const std::string& name : neededBy(framework::DeploymentSpec::load(deployment)))
        if (!findDamage(name).empty()) console::printResult("{}\n", name);
    return 0;
}

/** Lists the libraries of Insonify, installed or not, and those of users. */
int list(bool json) {
    Json all = Json::array();
    std::set<std::string> names;
    for (const std::string& name : loader::present()) names.insert(name);
    for (const loader::Component& component : loader::components()) names.insert(component.name);
    for (const std::string& name : names) {
        const loader::Component* const known = loader::findComponent(name);
        const std::string wrong = loader::isPresent(name) ? findDamage(name) : "";
        const char* const state = !loader::isPresent(name) ? "absent" : wrong.empty() ? "here" : "broken";
        all.push_back({{"name", name},
                       {"state", state},
                       {"gives", known ? known->gives : "your own components"},
                       {"wrong", wrong}});
        if (!json)
            console::printResult("{:10} {:8} {}\n", name, state,
                                 wrong.empty() ? all.back()["gives"].get<std::string>() : wrong);
    }
    if (json) print(all);
    return 0;
}

}  // namespace

void addLibrariesCommand(CLI::App& app, Action& action) {
    struct Options {
        std::string deployment;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "libraries", "Lists the component libraries; or those that a deployment needs and that are missing");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment");
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] {
        action = [options] {
            return options->deployment.empty() ? list(options->json) : listLacking(deploymentIn(options->deployment));
        };
    });
}

}  // namespace insonify::command
