#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/framework/DeploymentControl.hpp"
#include "components/framework/DeploymentSpec.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/framework/Watchdog.hpp"

namespace insonify::framework {

/** One connection as made. */
struct Connection {
    OutputPortBase* from;
    InputPortBase* to;
    ConnPolicy policy;
    std::shared_ptr<const ChannelBase> channel;
    std::string text() const { return from->path() + ">" + to->path(); }
};

/** When a run ends by itself, and how fast it goes; 0 stands for no limit. Without limits a lockstep run ends once its
 * sources have finished, a realtime run with the stop flag. */
struct RunLimits {
    uint64_t pings = 0;     ///< Every sonar has written so many.
    double duration_s = 0;  ///< On the deployment's clock [s].
    double pace = 0;  ///< In lockstep, simulated seconds per second of the wall clock at most; 0: as fast as it goes.
};

struct Progress {
    uint64_t pings = 0;    ///< Written by every sonar.
    double elapsed_s = 0;  ///< On the deployment's clock [s].
    double wall_s = 0;     ///< [s]
};

struct RunResult {
    uint64_t pings = 0;                 ///< Written by every sonar.
    double elapsed_s = 0, wall_s = 0;   ///< As in Progress.
    std::vector<std::string> failures;  ///< "task: message"; empty: all went well.
    std::vector<std::string> warnings;  ///< As of onWarning(), the first hundred.
    bool failed() const { return !failures.empty(); }
};

/** Tasks made, given their properties and connected, as a DeploymentSpec says.
 *
 *      Deployment deployment(DeploymentSpec::load("deploy/minimal.yml"), registry, "out");  // throws every fault
 *      deployment.configure();                                                              // throws every fault
 *      RunResult result = deployment.run({.pings = 10}, stop, {});
 *
 *  Tasks configure in file order, start readers before writers, stop and clean up writers before readers; a reader
 *  has a last cycle before it stops, so that nothing that waits for it is lost. Its destructor cleans up.
 *
 *  In lockstep, simulated time goes from one instant at which a periodic task is due to the next. At each, the due
 *  tasks run in file order, then triggered tasks, writers before readers. What a buffer carries backwards in that
 *  order (a loop) arrives at the next instant. In realtime each task runs on its own thread and the wall clock. */
class Deployment final : public DeploymentControl {
public:
    /** Makes and checks; nothing is configured. Throws types::ConfigError with every fault, those of `spec` first.
     *  A `seed` that is not 0 gives each task that has a property of that name a hash of it and the task's name. */
    Deployment(DeploymentSpec spec, Registry& registry, std::filesystem::path output_folder = ".", uint64_t seed = 0);
    ~Deployment() override;
    Deployment(const Deployment&) = delete;
    Deployment& operator=(const Deployment&) = delete;

    const DeploymentSpec& spec() const { return spec_; }
    Environment& environment() { return *environment_; }
    const std::vector<std::unique_ptr<TaskContext>>& tasks() const { return tasks_; }  ///< In file order.
    TaskContext* task(const std::string& name) const;                                  ///< Null when there is none.
    const std::vector<Connection>& connections() const { return connections_; }
    const std::vector<TaskContext*>& order() const { return order_; }  ///< Writers before readers.

    /** Configures every task; throws types::ConfigError with the faults of all, having cleaned up. */
    void configure();
    /** Starts, runs until a limit, the end of the sources, a task that fails, or `stop`; stops all. Does not clean up.
     *  `progress` is called after each instant (lockstep) or every few milliseconds (realtime), on this thread. */
    RunResult run(const RunLimits& limits, const std::atomic<bool>& stop,
                  const std::function<void(const Progress&)>& progress = {});
    /** Returns the failures, "task: message". */
    std::vector<std::string> cleanup();
    /** In realtime: what of priorities, processors and memory was not permitted, before tasks start; then tasks that
     *  hang, are in error, or no longer. Comes on any thread, one at a time. */
    void onWarning(std::function<void(const std::string&)> told) { told_ = std::move(told); }

    std::string call(const std::string& operation, const std::vector<std::string>& arguments) override;
    types::DeploymentStatus status() const override;
    std::vector<types::TaskInterface> interfaces() const override;
    void pause(bool on) override;
    void step() override;

    /** Samples lost in each connection, by "from>to". */
    std::map<std::string, uint64_t> losses() const;
    /** Pings that every sonar has written; a sonar writes pings and reads none. */
    uint64_t pings() const;

private:
    friend class Wiring;
    void setClock();
    /** Simulated time starts with what a source wants to play, if there is one. */
    void startAtFirstStamp();
    /** In realtime, a source's own clock takes the place of the wall's. */
    void followClock();
    void runLockstep(const RunLimits& limits, const std::atomic<bool>& stop,
                     const std::function<void(const Progress&)>& progress);
    void runRealtime(const RunLimits& limits, const std::atomic<bool>& stop,
                     const std::function<void(const Progress&)>& progress);
    /** Waits until an instant is due at the pace that is wanted, or time stands still. */
    void keepPace(double pace, types::Time instant, const std::atomic<bool>& stop) const;
    /** Locks memory and sets up the tasks' threads, as far as is permitted. */
    void prepareRealtime();
    bool standsStill() const { return paused_ && steps_ == 0; }
    /** Whether an instant may begin; while paused, one of those that were asked for. Between instants. */
    bool takeStep();
    /** While paused, until a step is asked for. */
    void standStill(const std::atomic<bool>& stop);
    /** What is held while an instant is under way, and by who calls operations in between; empty in realtime. */
    std::unique_lock<std::mutex> betweenInstants();
    std::vector<Watchdog::Limit> watchdogLimits() const;
    void warn(const std::string& text);
    bool startAll(std::vector<std::string>& failures);
    void stopAll(std::vector<std::string>& failures);
    void stopOne(TaskContext& task, std::vector<std::string>& failures);
    void noteBroken(std::vector<std::string>& failures) const;
    bool broken(const RunLimits& limits) const;
    bool reached(const RunLimits& limits) const;
    Progress progressNow() const;

    DeploymentSpec spec_;
    std::shared_ptr<Environment> environment_;
    std::vector<std::unique_ptr<TaskContext>> tasks_;
    std::vector<Connection> connections_;
    std::vector<TaskContext*> order_;
    std::vector<const OutputPortBase*> sonars_;
    std::atomic<int64_t> simulated_us_{0};
    types::Time start_;
    std::chrono::steady_clock::time_point wall_start_;
    std::chrono::steady_clock::duration stood_still_{};  ///< In this run.
    std::atomic<bool> paused_{false};
    std::atomic<uint64_t> steps_{0};  ///< To be made while paused.
    std::mutex instant_mutex_;
    std::atomic<unsigned> callers_{0};  ///< That wait for the end of an instant.
    std::mutex warning_mutex_;
    std::vector<std::string> warnings_;
    std::function<void(const std::string&)> told_;
};

/** Which seed a task gets from `run --seed`: stable over runs, machines and versions; below 2^53. */
uint64_t seedOf(uint64_t seed, const std::string& task);

}  // namespace insonify::framework
