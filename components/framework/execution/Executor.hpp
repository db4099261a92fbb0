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

/** Limits and pace of a run; 0: no limit. Without limits, a lockstep run ends once its sources have finished; a
 *  realtime run ends with the stop flag. */
struct RunLimits {
    /** A range of the run's counted samples, numbered from 0; `last` is excluded. */
    struct Shard {
        uint64_t first = 0, last = std::numeric_limits<uint64_t>::max();
    };

    uint64_t samples = 0;   ///< Counted samples, see Graph::countedSamples.
    double duration_s = 0;  ///< By Environment::elapsed [s].
    double pace = 0;        ///< In lockstep, max simulated seconds per wall-clock second; 0: unlimited.
    /** In lockstep: makes only these samples. Instants before the shard are rehearsed. From the instant after sample
     *  `first` - 1 the run proceeds as the whole run does; it ends with sample `last` - 1. All tasks must be
     *  Divisible. */
    std::optional<Shard> shard{};
};

struct Progress {
    uint64_t samples = 0;    ///< Counted samples, see Graph::countedSamples; in a shard, those made.
    uint64_t rehearsed = 0;  ///< Counted samples before the shard.
    double elapsed_s = 0;    ///< By Environment::elapsed [s].
    double wall_s = 0;       ///< [s]
    uint64_t most = 0;       ///< As `samples`, of the source that has written most, unless `rehearsed`.
};

/** Runs the tasks of a graph between their start and their stop, and keeps the clock that the tasks read.
 *
 *      executor.begin();
 *      task.start(), executor.release(task);  // each, readers before writers
 *      executor.run(limits, stop, report);
 *      task.stop();                           // each
 *      executor.end();
 *
 *  pause(), step(), paused() and betweenInstants() may be called on any thread. */
class Executor {
public:
    using Report = std::function<void(const Progress&)>;

    /** `graph` and `environment` outlive the executor; `start` is on the deployment's clock, before the first run. */
    Executor(const Graph& graph, Environment& environment, types::Time start);
    virtual ~Executor() = default;
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    virtual void begin();                           ///< Before tasks start.
    virtual void release(TaskContext& /*task*/) {}  ///< A task has started and may run cycles.
    /** Returns at a limit, at the end of the sources, when a task fails, or with `stop`. Calls `report` on this
     *  thread. */
    virtual void run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) = 0;
    /** Runs the next instant, where time advances by instants; false: no task is due any more. Throws std::logic_error
     *  in other executors. */
    virtual bool advance();
    virtual void end() {}  ///< After tasks have stopped.

    virtual bool paused() const { return false; }
    virtual void pause(bool on) = 0;  ///< As DeploymentControl::pause.
    virtual void step() = 0;          ///< As DeploymentControl::step.
    /** Returns the lock for calling an operation. Where cycles run one by one, no cycle is running while the lock is
     *  held. */
    virtual std::unique_lock<std::mutex> betweenInstants() { return {}; }

    Progress progress() const;  ///< Returns the progress of this run.

protected:
    using Clock = std::chrono::steady_clock;

    /** Returns whether a task has failed or the count is reached. */
    bool isOver(const RunLimits& limits) const;

    const Graph& graph_;
    uint64_t first_ = 0;  ///< First counted sample that is made; earlier samples are rehearsed.
    Environment& environment_;
    types::Time start_;             ///< Start of the run, on the deployment's clock.
    Clock::time_point wall_start_;  ///< Start of the run.
};

}  // namespace insonify::framework
