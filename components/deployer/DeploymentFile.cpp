#include "components/deployer/DeploymentFile.hpp"

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "components/console/Console.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/logger/LoggerTask.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/output/tasks/PictureTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/replay/ReplayTask.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {
namespace fs = std::filesystem;
namespace {

bool isDeployment(const fs::path& file) {
    if (file.extension() != ".yml" && file.extension() != ".yaml") return false;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with("tasks:")) return true;
    return false;
}

}  // namespace

std::string exampleAt(const std::string& path) {
    std::error_code unreadable;
    if (!path.starts_with("deploy/") || fs::exists(path, unreadable)) return path;
    const fs::path shared = loader::sharedFolder() / path;
    return fs::exists(shared, unreadable) ? shared.string() : path;
}

std::string deploymentIn(const std::string& given) {
    const std::string path = exampleAt(given);
    std::error_code unreadable;
    if (path.empty()) throw types::ConfigError("", "", "the file's name is empty; must be a deployment file");
    if (!fs::is_directory(path, unreadable)) {
        if (scene::findSceneFormat(path))
            throw types::ConfigError(path, "",
                                     "is a scene; must be a deployment, a .yml file whose scene task names it as "
                                     "`file`; `insonify init` makes one");
        return path;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path, unreadable))
        if (isDeployment(entry.path())) found.push_back(entry.path().string());
    std::ranges::sort(found);
    if (found.size() == 1) return found.front();
    if (found.empty())
        throw types::ConfigError(path, "",
                                 "is a folder without a deployment, a .yml file with tasks; `insonify init` makes one");
    throw types::ConfigError(path, "",
                             fmt::format("is a folder of several deployments; name one of {}", fmt::join(found, ", ")));
}

framework::Registry coreTasks() {
    framework::Registry registry;
    pose::registerTasks(registry);
    scene::registerTasks(registry);
    sonar::registerTasks(registry);
    noise::registerTasks(registry);
    receiver::registerTasks(registry);
    output::registerTasks(registry);
    logger::registerTasks(registry);
    replay::registerTasks(registry);
    return registry;
}

framework::Registry allTasks() {
    framework::Registry registry = coreTasks();
    for (const types::Diagnostic& wrong : registry.loadAll()) console::printDiagnostic("notice: {}\n", wrong.text());
    return registry;
}

}  // namespace insonify::deployer
