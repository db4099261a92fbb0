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

#include "components/framework/DeploymentSpec.hpp"
#include "components/framework/Executor.hpp"
#include "components/framework/Graph.hpp"
#include "components/framework/Registry.hpp"

namespace insonify::framework {

/** How far it came, and how. */
struct RunResult : Progress {
    std::vector<std::string> failures;  ///< "task: message"; empty: all went well.
    std::vector<std::string> warnings;  ///< As of onWarning(), the first hundred.
    bool failed() const { return !failures.empty(); }
};

/** Tasks made, given their properties and connected, as a DeploymentSpec says: a Graph, with the executor for its
 *  schedule.
 *
 *      Deployment deployment(DeploymentSpec::load("deploy/minimal.yml"), registry, "out");  // throws every diagnostic
 *      deployment.configure();                                                              // throws every diagnostic
 *      RunResult result = deployment.run({.duration_s = 10}, stop, {});
 *
 *  Tasks configure in file order, start readers before writers, stop and clean up writers before readers; a reader
 *  has a last cycle before it stops, so that nothing that waits for it is lost. Its destructor cleans up. */
class Deployment final : public types::DeploymentControl {
public:
    /** Makes and checks; nothing is configured. Throws types::ConfigError with every diagnostic, those of `spec` first.
     *  A `seed` that is not 0 gives each task that has a property of that name a hash of it and the task's name; 0: the
     *  tasks of which none is written get one of the deployment's seed. */
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

    /** Configures every task; throws types::ConfigError with the diagnostics of all, having cleaned up. */
    void configure();
    /** Starts, runs until a limit, the end of the sources, a task that fails, or `stop`; stops all. Does not clean up.
     *  `report` as of the executors, on this thread. */
    RunResult run(const RunLimits& limits, const std::atomic<bool>& stop, const Executor::Report& report = {});
    // A run that a program drives itself, in lockstep: start(), advance() as often as it likes, stop().
    /** Returns the failures, "task: message"; where there are any, all have stopped again. */
    std::vector<std::string> start();
    /** Runs the next instant; false: no task is due any more. Throws std::logic_error in realtime. */
    bool advance() { return executor_->advance(); }
    /** Returns the failures, "task: message". */
    std::vector<std::string> stop();
    /** Returns the failures, "task: message". */
    std::vector<std::string> cleanup();
    /** In realtime: what of priorities, processors and memory was not permitted, before tasks start; then tasks that
     *  hang, are in error, or no longer. Comes on any thread, one at a time. */
    void onWarning(std::function<void(const std::string&)> told) { told_ = std::move(told); }

    std::string call(const std::string& operation, const std::vector<std::string>& arguments) override;
    types::DeploymentStatus status() const override;
    std::vector<types::TaskInterface> interfaces() const override;
    void pause(bool on) override { executor_->pause(on); }
    void step() override { executor_->step(); }

    /** Samples lost in each connection, by "from>to". */
    std::map<std::string, uint64_t> losses() const;
    /** Samples of each connection that its reader has passed over for newer ones, by "from>to". */
    std::map<std::string, uint64_t> passedOver() const;

private:
    void makeEnvironment(std::filesystem::path output_folder, uint64_t seed);
    std::unique_ptr<Executor> makeExecutor();
    std::vector<types::TaskRecord> records() const;
    void warn(const std::string& text);
    bool startAll(std::vector<std::string>& failures);
    void stopAll(std::vector<std::string>& failures);
    void noteFailed(std::vector<std::string>& failures) const;

    DeploymentSpec spec_;
    std::shared_ptr<Environment> environment_;
    std::unique_ptr<Executor> executor_;  ///< Outlives the tasks, which read its clock.
    Graph graph_;
    std::mutex warning_mutex_;
    std::vector<std::string> warnings_;
    std::function<void(const std::string&)> told_;
};

}  // namespace insonify::framework
