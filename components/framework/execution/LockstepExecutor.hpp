#pragma once
#include <condition_variable>
#include <limits>

#include "components/framework/Offers.hpp"
#include "components/framework/execution/Executor.hpp"

namespace insonify::framework {

/** Runs tasks in simulated time. It reads no other clock, so the same tasks and data give the same run.
 *
 *  Time advances to the next instant at which a task is due, by its period or as a ClockSource. At each instant the due
 *  tasks run in file order, then triggered tasks, writers before readers. A sample that a buffer carries backwards in
 *  that order (a loop) arrives at the next instant. Time can be paused and advanced step by step. */
class LockstepExecutor final : public Executor {
public:
    /** At `start` all tasks with a period are due. */
    LockstepExecutor(const Graph& graph, Environment& environment, types::Time start);

    void begin() override;
    /** Also ends once every source has finished; a source is a task that runs by the clock and reads nothing. With a
     *  limit, the run ends then only if no source writes any more. Calls `report` after each instant. */
    void run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) override;
    bool advance() override;
    bool paused() const override { return paused_; }
    void pause(bool on) override;
    void step() override;
    std::unique_lock<std::mutex> betweenInstants() override;

private:
    static constexpr types::Time never{std::numeric_limits<int64_t>::max()};

    /** A task with a period, or a ClockSource, which names the time of its next cycle. */
    struct Timed {
        TaskContext* task;
        const ClockSource* source;  ///< Null for a task with a period.
        uint64_t cycle = 0;
    };

    void findTasks();
    types::Time due(const Timed& timed) const;
    types::Time next() const;  ///< Next instant at which a task is due; `never`: none.
    types::Time nextBetweenInstants();
    /** Runs the due tasks in file order, then triggered tasks until no sample triggers a task. */
    void runInstant(types::Time instant);
    /** Sets whether the next instant is rehearsed; false: the instant is after the shard. */
    bool joinStep(const RunLimits& limits);
    /** Whether no source will write a further sample, or the count of samples cannot be reached any more. */
    bool sourcesAreDone(const RunLimits& limits) const;
    /** Waits until the instant is due at the given pace, or until time is paused. */
    void keepPace(double pace, types::Time instant, const std::atomic<bool>& stop) const;
    bool isHalted() const { return paused_ && steps_ == 0; }
    /** Waits while paused, until a step is requested. */
    void standStill(const std::atomic<bool>& stop);
    /** Returns whether an instant may begin; while paused, uses up one of the requested steps. Between instants. */
    bool consumeStep();
    /** Waits until the callers that wait now have been served. */
    void letCallersIn(const std::atomic<bool>& stop) const;
    /** Returns the lock for an instant, for which later callers wait. */
    std::unique_lock<std::mutex> acquireTurn();
    void giveTurn(std::unique_lock<std::mutex> held);

    std::vector<Timed> timed_;
    std::vector<TaskContext*> triggered_;
    std::vector<const TaskContext*> sources_;
    int refusals_ = 0;            ///< Consecutive instants in which a source of counted samples was in error.
    int failures_ = 0;            ///< Consecutive instants without a counted sample in which a task was in error.
    bool sources_wrote_ = false;  ///< Whether a task that runs by the clock wrote anything at the last instant.
    std::atomic<int64_t> now_us_;
    Clock::duration stood_still_{};  ///< In this run.
    std::atomic<bool> paused_{false};
    std::atomic<uint64_t> steps_{0};  ///< Requested while paused.
    std::mutex instant_mutex_;
    std::condition_variable turn_;                 ///< An instant has ended.
    std::atomic<bool> instant_due_{false};         ///< The run waits for its turn, or has it.
    std::atomic<uint64_t> called_{0}, let_in_{0};  ///< Callers so far; those of them that have had the lock.
};

}  // namespace insonify::framework
