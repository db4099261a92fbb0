#pragma once
// What a task may offer its deployment beside ports, properties and operations, as a second base.
//
//     class ReaderTask final : public framework::TaskContext, public framework::ClockSource { ... };
#include <functional>
#include <optional>
#include <string>

#include "components/framework/TaskContext.hpp"
#include "types/DeploymentControl.hpp"
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

/** A task of which a run can be cut into shards: whatever sample a run begins with, this one writes of each the same.
 *
 *  Instants before those of the shard are rehearsed (Environment::rehearsing). The task then does what later samples
 *  depend on, a motor that turns for example, and what may be long or leaves the deployment it leaves out: a source of
 *  counted samples makes nothing, and writes one that has a time and nothing else; who reads such hands them on, counts
 *  them, and makes nothing of them. */
class Divisible {
public:
    virtual ~Divisible() = default;

    /** Why a run with this task, as its properties are, cannot be cut; empty: it can. Starts with the property that
     *  stands in the way and says what would do, "quality: is chosen ...". */
    virtual std::string indivisible() const { return {}; }
};

/** A task that may be in error only because nobody sends it anything: a run that ends so has not failed. */
class Waits {
public:
    virtual ~Waits() = default;

    /** Whether it is so now, having heard of somebody before. From any thread. */
    virtual bool waits() const = 0;
};

/** Of a task that is Planned; null: it is not, or not yet. On the task's thread, or when it has stopped. */
inline const types::Plan* planOf(const TaskContext& task) {
    const auto* const planned = dynamic_cast<const Planned*>(&task);
    return planned ? planned->plan() : nullptr;
}

}  // namespace insonify::framework
