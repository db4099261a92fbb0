#include "components/deployer/Tasks.hpp"

#include <fmt/core.h>

#include "components/console/Console.hpp"
#include "components/logger/LoggerTask.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/output/tasks/PictureTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/replay/ReplayTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"

namespace insonify::deployer {

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
