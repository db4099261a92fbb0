// insonify plan DEPLOYMENT
#include <fmt/core.h>

#include <memory>
#include <stdexcept>

#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/sonar/tasks/PingTask.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using framework::Deployment;
using framework::DeploymentSpec;

void printPlan(const std::string& task, const types::Plan& plan) {
    console::printResult("{}\n  {}\n", task, qualityText(plan));
    for (const std::string& feature : plan.features) console::printResult("  compiled: {}\n", feature);
    for (const std::string& pass : plan.passes) console::printResult("  run: {}\n", pass);
    for (const types::Omission& omission : plan.omitted)
        console::printResult("  omitted: {}: {}\n", omission.name, omission.reason);
    for (const types::Notice& notice : plan.notices) console::printResult("  {}\n", labelled(notice));
}

/** A substitute for the readers of a sonar's truth: they are not part of the run, but what the sonar computes depends
 *  on them. */
struct TruthReader : framework::TaskContext {
    using TaskContext::TaskContext;
    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "the newest"};
    framework::InputPort<types::SonarReturnsPtr> returns{this, "returns", "the newest"};
};

/** Connects the ports of a sonar that are connected in the whole deployment. */
void connectAsIn(const Deployment& whole, sonar::PingTask& sonar, TruthReader& reader) {
    for (const framework::Connection& connection : whole.connections()) {
        if (connection.from->owner().name() != sonar.name()) continue;
        if (connection.from->name() == sonar.truth.name() && !sonar.truth.connected())
            sonar.truth.connectTo(reader.truth, framework::ConnPolicy::data());
        if (connection.from->name() == sonar.returns.name() && !sonar.returns.connected())
            sonar.returns.connectTo(reader.returns, framework::ConnPolicy::data());
    }
}

using Plans = std::vector<std::pair<std::string, const types::Plan*>>;

/** Prints the plan of the only sonar, or the plans by task. */
void printJson(const Plans& plans) {
    if (plans.size() == 1) return print(toJson(*plans.front().second));
    Json all = Json::object();
    for (const auto& [task, plan] : plans) all[task] = toJson(*plan);
    print(all);
}

int showPlan(const RunOptions& options, bool json) {
    framework::Registry registry = coreTasks();
    const DeploymentSpec spec = loadSpec(options);
    Deployment deployment(pipeline(spec, registry), registry);
    const Deployment whole(spec, registry);
    std::vector<std::unique_ptr<TruthReader>> readers;
    for (const auto& task : deployment.tasks())
        if (auto* sonar = dynamic_cast<sonar::PingTask*>(task.get()))
            connectAsIn(whole, *sonar, *readers.emplace_back(std::make_unique<TruthReader>("reader")));
    deployment.configure();
    const framework::RunResult result = deployment.run({.samples = 1}, stopOnSignals());
    if (result.failed()) throw std::runtime_error(result.failures.front());

    Plans plans;
    for (const auto& task : deployment.tasks())
        if (const types::Plan* plan = framework::makePlan(*task)) plans.emplace_back(task->name(), plan);
    if (plans.empty()) throw types::ConfigError(spec.file, "tasks", "has no sonar that sends a ping: nothing to plan");
    if (json)
        printJson(plans);
    else
        for (const auto& [task, decided] : plans) printPlan(task, *decided);
    return 0;
}

}  // namespace

void addPlanCommand(CLI::App& app, Action& action) {
    struct Options {
        RunOptions run;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("plan", "Prints what is compiled and run, what is omitted, and why");
    options->run.addDeploymentTo(*command);
    command->add_flag("--json", options->json, "for machines");
    command->callback([options, &action] { action = [options] { return showPlan(options->run, options->json); }; });
}

}  // namespace insonify::command
