#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>

#include "components/framework/Graph.hpp"

namespace insonify::framework {

/** When a run ends by itself, and how fast it goes; 0 stands for no limit. Without limits a lockstep run ends once its
 *  sources have finished, a realtime run with the stop flag. */
struct RunLimits {
    /** Some of the counted samples of a run, by their numbers from 0 on, `last` not included. */
    struct Shard {
        uint64_t first = 0, last = std::numeric_limits<uint64_t>::max();
    };

    uint64_t samples = 0;   ///< Counted ones, see Graph::countedSamples.
    double duration_s = 0;  ///< On the deployment's clock [s].
    double pace = 0;  ///< In lockstep, simulated seconds per second of the wall clock at most; 0: as fast as it goes.
    /** In lockstep: only these are made. Instants before are rehearsed, from the one after sample `first` - 1 on all
     *  goes as in the whole run, and with sample `last` - 1 it ends. All tasks must be Divisible. */
    std::optional<Shard> shard{};
};

struct Progress {
    uint64_t samples = 0;    ///< Counted ones, see Graph::countedSamples; of a shard, those that were made.
    uint64_t rehearsed = 0;  ///< Those before a shard.
    double elapsed_s = 0;    ///< On the deployment's clock [s].
    double wall_s = 0;       ///< [s]
};

/** Has the tasks of a graph work, between their start and their stop, and keeps the clock that they read.
 *
 *      executor.begin();
 *      task.start(), executor.release(task);  // each, readers before writers
 *      executor.run(limits, stop, report);
 *      task.stop();                           // each
 *      executor.end();
 *
 *  pause(), step(), paused() and betweenInstants() are for any thread. */
class Executor {
public:
    using Report = std::function<void(const Progress&)>;

    /** Graph and environment outlive it; `start` on the deployment's clock, before the first run. */
    Executor(const Graph& graph, Environment& environment, types::Time start);
    virtual ~Executor() = default;
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    virtual void begin();                           ///< Before tasks start.
    virtual void release(TaskContext& /*task*/) {}  ///< A task has started: from now on it may work.
    /** Returns at a limit, with the end of the sources, with a task that fails, or with `stop`. `report` is called
     *  on this thread. */
    virtual void run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) = 0;
    /** Runs the next instant, where time goes by instants; false: no task is due any more. Throws std::logic_error
     *  where it does not. */
    virtual bool advance();
    virtual void end() {}  ///< After tasks have stopped.

    virtual bool paused() const { return false; }
    virtual void pause(bool on) = 0;  ///< As DeploymentControl::pause.
    virtual void step() = 0;          ///< As DeploymentControl::step.
    /** What an operation is called under: while it is held, no cycle is under way where cycles come one by one. */
    virtual std::unique_lock<std::mutex> betweenInstants() { return {}; }

    Progress progress() const;  ///< Of this run.

protected:
    using Clock = std::chrono::steady_clock;

    /** A task has failed, or the count is reached. */
    bool isOver(const RunLimits& limits) const;

    const Graph& graph_;
    uint64_t first_ = 0;  ///< Counted sample that is made, those before are rehearsed.
    Environment& environment_;
    types::Time start_;             ///< Of the run, on the deployment's clock.
    Clock::time_point wall_start_;  ///< Of the run.
};

}  // namespace insonify::framework
