#include <gtest/gtest.h>

#include "components/framework/Deployment.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/output/tasks/PictureTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/support/Fuzz.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::fuzz {
namespace {

void check(const Input& input) try {
    framework::Registry registry;
    pose::registerTasks(registry);
    scene::registerTasks(registry);
    noise::registerTasks(registry);
    receiver::registerTasks(registry);
    output::registerTasks(registry);
    const framework::Deployment deployment(framework::DeploymentSpec::load(input.file()), registry);
    for (const auto& task : deployment.tasks()) EXPECT_FALSE(task->name().empty());
} catch (const types::ConfigError& error) {
    for (const types::Diagnostic& diagnostic : error.diagnostics()) expectOurWords(diagnostic.message);
}

TEST(DeploymentFuzzTest, EveryTextIsADeploymentOrAnError) {
    push({"deployment",
          "deployment.yml",
          {"tasks:\n",
           "connections:\n",
           "{",
           "}",
           "[",
           "]",
           ": ",
           "\n  - ",
           "&a ",
           "*a",
           "<<: *a",
           "!!int ",
           "|\n",
           "%YAML 1.2\n",
           "---\n",
           "\t",
           "#",
           "\"",
           "'",
           "~",
           "null",
           ".nan",
           "20.deg",
           "5.cm",
           "from: ",
           "to: ",
           "policy: ",
           "type: ",
           "noise::NoiseTask",
           "output::FanImageTask",
           "receiver::ReceiverTask",
           "scene::SceneTask",
           "properties: ",
           "activity: ",
           "trigger: ",
           "period: ",
           "aliases: ",
           "copies: ",
           "switches: ",
           "schedule: realtime\n"},
          check});
}

}  // namespace
}  // namespace insonify::fuzz
