#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/framework/Graph.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/framework/execution/Executor.hpp"
#include "types/Thread.hpp"

namespace insonify::framework {

/** How far a run got, with its failures and warnings. */
struct RunResult : Progress {
    std::map<std::string, uint64_t> by_port;  ///< Counted samples of each source, also before the shard.
    std::vector<std::string> failures;        ///< "task: message"; empty: no failure.
    std::vector<std::string> warnings;        ///< The first hundred of onWarning().
    bool failed() const { return !failures.empty(); }
};

/** Creates, configures and connects the tasks of a DeploymentSpec as a Graph, and runs them with the executor of its
 *  schedule.
 *
 *      Deployment deployment(DeploymentSpec::load("deploy/minimal.yml"), registry, "out");  // throws every diagnostic
 *      deployment.configure();                                                              // throws every diagnostic
 *      RunResult result = deployment.run({.duration_s = 10}, stop, {});
 *
 *  Tasks configure in file order, start readers before writers, and stop and clean up writers before readers. A reader
 *  runs a last cycle before it stops, so that no waiting sample is lost. The destructor cleans up, but in a forked
 * child, where the threads are missing and the files are those of the parent, it leaves everything as it is. */
class Deployment final : public types::DeploymentControl {
public:
    /** Makes and checks the tasks; configures none. Throws types::ConfigError with every diagnostic, those of `spec`
     *  first. If `seed` is not 0, each task with a `seed` property gets a hash of `seed` and its name. If `seed` is 0,
     *  tasks without a written seed get a hash of the deployment's seed and their name. */
    Deployment(DeploymentSpec spec, Registry& registry, std::filesystem::path output_folder = ".", uint64_t seed = 0);
    ~Deployment() override;
    Deployment(const Deployment&) = delete;
    Deployment& operator=(const Deployment&) = delete;

    const DeploymentSpec& spec() const { return spec_; }
    Environment& environment() { return *environment_; }
    const std::vector<std::unique_ptr<TaskContext>>& tasks() const { return graph_.tasks(); }  ///< In file order.
    TaskContext* task(const std::string& name) const { return graph_.task(name); }  ///< Null when there is none.
    const std::vector<Connection>& connections() const { return graph_.connections(); }
    const std::vector<TaskContext*>& order() const { return graph_.order(); }  ///< Writers before readers.

    /** Configures every task. Throws types::ConfigError with the diagnostics of all tasks, after cleaning up. */
    void configure(const std::function<bool(const TaskContext&)>& chosen = {});
    /** Starts the tasks, runs until a limit, the end of the sources, a failing task or `stop`, and stops the tasks.
     *  Does not clean up. `report` is called as by Executor::run, on this thread. */
    RunResult run(const RunLimits& limits, const std::atomic<bool>& stop, const Executor::Report& report = {});
    // A run that a program drives itself, in lockstep: start(), any number of advance(), stop().
    /** Returns the failures, "task: message"; after a failure all tasks are stopped again. */
    std::vector<std::string> start();
    /** Runs the next instant; false: no task is due any more. Throws std::logic_error in realtime. */
    bool advance() { return executor_->advance(); }
    /** Returns the failures, "task: message". */
    std::vector<std::string> stop();
    /** Returns the failures, "task: message". */
    std::vector<std::string> cleanup();
    /** Sets the receiver of warnings in realtime. Before tasks start it gets the priorities, processors and memory that
     *  were not permitted; later, tasks that hang or are in error, and their recovery. Called on any thread, one call
     *  at a time, and holds up that thread; what it throws is ignored. */
    void onWarning(std::function<void(const std::string&)> reported) { reported_ = std::move(reported); }

    std::string call(const std::string& operation, const std::vector<std::string>& arguments) override;
    /** Sets properties, "task.name", to values in YAML: all, or none. Each task sets its own on its thread; if one
     *  refuses, the others set theirs back. Throws types::ConfigError, with `origin` as the file, and
     *  std::runtime_error. */
    void set(const std::map<std::string, std::string>& values, const std::string& origin);
    types::DeploymentStatus status() const override;
    std::vector<types::TaskInterface> interfaces() const override;
    void pause(bool on) override { executor_->pause(on); }
    void step() override { executor_->step(); }

    /** Returns the number of samples lost in each connection, by "from>to". */
    std::map<std::string, uint64_t> losses() const;
    /** Returns the number of samples of each connection that its reader skipped for newer samples, by "from>to". */
    std::map<std::string, uint64_t> passedOver() const;

private:
    void makeEnvironment(std::filesystem::path output_folder, uint64_t seed);
    std::unique_ptr<Executor> makeExecutor();
    std::vector<types::TaskRecord> records() const;
    void warn(const std::string& text) noexcept;
    bool startAll(std::vector<std::string>& failures);
    void stopAll(std::vector<std::string>& failures);
    void noteFailed(std::vector<std::string>& failures) const;

    std::mutex warning_mutex_;  ///< With what it protects, outlives the tasks, whose threads may warn until they end.
    std::vector<std::string> warnings_;
    std::function<void(const std::string&)> reported_;
    types::OwnProcess process_;
    DeploymentSpec spec_;
    std::shared_ptr<Environment> environment_;
    std::unique_ptr<Executor> executor_;  ///< Outlives the tasks, which read its clock.
    Graph graph_;
};

}  // namespace insonify::framework
