#pragma once
// What a task may offer its deployment beside ports, properties and operations, as a second base.
//
//     class ReaderTask final : public framework::TaskContext, public framework::ClockSource { ... };
#include <functional>
#include <optional>

#include "components/framework/TaskContext.hpp"
#include "types/DeploymentStatus.hpp"
#include "types/Plan.hpp"
#include "types/Time.hpp"

namespace insonify::framework {

/** A task whose samples bear times of their own, by which the deployment goes. */
class ClockSource {
public:
    virtual ~ClockSource() = default;

    /** In lockstep, when the task wants its next cycle, where it has no period; none: not, or not any more. A cycle at
     *  that time must move it on. Valid once the connections are made: the earliest of all tasks is then when simulated
     *  time starts. */
    virtual std::optional<types::Time> nextTime() const { return std::nullopt; }

    /** In realtime, the clock that all tasks read in place of the wall's, which it may follow at a pace of its own;
     *  none: this task has none. Asked for once, when the connections are made. */
    virtual std::function<types::Time()> clock(std::function<types::Time()> /*wall*/) { return {}; }
};

/** A task that plays what was recorded. */
class Player {
public:
    virtual ~Player() = default;

    /** None: nothing is opened yet. Any thread. */
    virtual std::optional<types::Playback> playback() const = 0;
};

/** A task that decides what of its work is done and what is left out. */
class Planned {
public:
    virtual ~Planned() = default;

    /** Null: not decided yet. Valid after the first cycle. When it has changed, the task calls
     *  TaskContext::refreshRecord before it writes the first sample that it holds for. */
    virtual const types::Plan* plan() const = 0;
};

/** Of a task that is Planned; null: it is not, or not yet. On the task's thread, or when it has stopped. */
inline const types::Plan* planOf(const TaskContext& task) {
    const auto* const planned = dynamic_cast<const Planned*>(&task);
    return planned ? planned->plan() : nullptr;
}

}  // namespace insonify::framework
