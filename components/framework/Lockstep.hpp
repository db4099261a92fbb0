#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** The order of work on simulated time. It reads no other clock: the same tasks and data give the same run. */
class Lockstep {
public:
    /** `tasks` in file order, `order` writers before readers. Time starts at `start`, at which all tasks are due. */
    Lockstep(const std::vector<std::unique_ptr<TaskContext>>& tasks, const std::vector<TaskContext*>& order,
             types::Time start);

    types::Time next() const;  ///< The next instant at which a task is due; the largest time: none is any more.
    /** Runs the due tasks in file order, then triggered ones until no sample triggers any. */
    void step();
    /** Every source, a task that runs by the clock and reads nothing, has nothing more to say. */
    bool sourcesFinished() const;
    /** Whether a task that runs by the clock wrote anything in the last step. */
    bool sourcesWrote() const { return sources_wrote_; }

private:
    static constexpr types::Time never{std::numeric_limits<int64_t>::max()};

    /** A task with a period, or one that says itself when it wants to run. */
    struct Timed {
        TaskContext* task;
        uint64_t cycle = 0;
        types::Time due(types::Time start) const;
    };

    types::Time start_;
    std::vector<Timed> timed_;
    std::vector<TaskContext*> triggered_;
    std::vector<const TaskContext*> sources_;
    bool sources_wrote_ = false;
};

}  // namespace insonify::framework
