#pragma once
#include <cstdint>
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

    bool idle() const { return periodic_.empty(); }  ///< No task is ever due.
    types::Time next() const;                        ///< The next instant at which a task is due.
    /** Runs the due tasks in file order, then triggered ones until no sample triggers any. */
    void step();
    /** Every source, a periodic task that reads nothing, has nothing more to say. */
    bool sourcesFinished() const;
    /** Whether a periodic task wrote anything in the last step. */
    bool sourcesWrote() const { return sources_wrote_; }

private:
    struct Periodic {
        TaskContext* task;
        uint64_t cycle = 0;
        types::Time due(types::Time start) const;
    };

    types::Time start_;
    std::vector<Periodic> periodic_;
    std::vector<TaskContext*> triggered_;
    std::vector<const TaskContext*> sources_;
    bool sources_wrote_ = false;
};

}  // namespace insonify::framework
