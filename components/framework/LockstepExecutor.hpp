#pragma once
#include <limits>

#include "components/framework/Executor.hpp"
#include "components/framework/Offers.hpp"

namespace insonify::framework {

/** The order of work on simulated time: it reads no other clock, so that the same tasks and data give the same run.
 *
 *  Time goes from one instant at which a task is due, by its period or as a ClockSource, to the next. At each, the due
 *  tasks run in file order, then triggered tasks, writers before readers. What a buffer carries backwards in that order
 *  (a loop) arrives at the next instant. Time can stand still, and go on step by step. */
class LockstepExecutor final : public Executor {
public:
    /** At `start` all tasks with a period are due. */
    LockstepExecutor(const Graph& graph, Environment& environment, types::Time start);

    void begin() override;
    /** Ends as well once every source, a task that runs by the clock and reads nothing, has finished: with a limit,
     *  only if none writes any more. `report` comes after each instant. */
    void run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) override;
    bool advance() override;
    bool paused() const override { return paused_; }
    void pause(bool on) override;
    void step() override;
    std::unique_lock<std::mutex> betweenInstants() override;

private:
    static constexpr types::Time never{std::numeric_limits<int64_t>::max()};

    /** A task with a period, or one that says itself when it wants to run. */
    struct Timed {
        TaskContext* task;
        const ClockSource* source;  ///< Null for a task with a period.
        uint64_t cycle = 0;
    };

    void findTasks();
    types::Time due(const Timed& timed) const;
    types::Time next() const;  ///< Instant at which a task is due; `never`: none is any more.
    types::Time nextBetweenInstants();
    /** The due tasks in file order, then triggered ones until no sample triggers any. */
    void runInstant(types::Time instant);
    /** Sees to whether the next instant is rehearsed; false: it comes after the shard. */
    bool takePart(const RunLimits& limits);
    /** Whether no source has anything more to say, or a count is not to be reached any more. */
    bool sourcesAreDone(const RunLimits& limits) const;
    /** Waits until an instant is due at the pace that is wanted, or time stands still. */
    void keepPace(double pace, types::Time instant, const std::atomic<bool>& stop) const;
    bool standsStill() const { return paused_ && steps_ == 0; }
    /** While paused, until a step is asked for. */
    void standStill(const std::atomic<bool>& stop);
    /** Whether an instant may begin; while paused, one of those that were asked for. Between instants. */
    bool takeStep();
    void letCallersIn(const std::atomic<bool>& stop) const;

    std::vector<Timed> timed_;
    std::vector<TaskContext*> triggered_;
    std::vector<const TaskContext*> sources_;
    int refusals_ = 0;            ///< Instants in a row in which a source of counted samples was in error.
    bool sources_wrote_ = false;  ///< Whether a task that runs by the clock wrote anything at the last instant.
    std::atomic<int64_t> now_us_;
    Clock::duration stood_still_{};  ///< In this run.
    std::atomic<bool> paused_{false};
    std::atomic<uint64_t> steps_{0};  ///< To be made while paused.
    std::mutex instant_mutex_;
    std::atomic<unsigned> callers_{0};  ///< That wait for the end of an instant.
};

}  // namespace insonify::framework
