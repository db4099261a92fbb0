#pragma once
// Interfaces that a task may offer its deployment in addition to ports, properties and operations, as a second base.
//
//     class ReaderTask final : public framework::TaskContext, public framework::ClockSource { ... };
#include <functional>
#include <optional>
#include <string>

#include "components/framework/TaskContext.hpp"
#include "types/ReturnLevels.hpp"
#include "types/Time.hpp"
#include "types/samples/DeploymentControl.hpp"
#include "types/samples/Plan.hpp"

namespace insonify::framework {

/** A task whose samples have their own times, which drive the deployment's clock. */
class ClockSource {
public:
    virtual ~ClockSource() = default;

    /** Returns, in lockstep, the time of the next cycle of a task without a period; none: no cycle, or no further one.
     *  A cycle at that time must advance this value. Valid once the connections are made: simulated time starts at the
     *  earliest value of all tasks. */
    virtual std::optional<types::Time> nextTime() const { return std::nullopt; }

    /** Returns, in realtime, the clock that all tasks read instead of `wall`; it may follow `wall` at its own pace.
     *  `wall` is never set, and counts from an unspecified time. None: this task has no clock. Called once, when the
     *  connections are made. */
    virtual std::function<types::Time()> clock(std::function<types::Time()> /*wall*/) { return {}; }
};

/** A task in whose samples others detect returns. */
class ReturnSource {
public:
    virtual ~ReturnSource() = default;

    /** Returns how its samples fall with range, with the present configuration. */
    virtual types::ReturnRules returnRules() const = 0;
};

/** A task that plays a recording. */
class Player {
public:
    virtual ~Player() = default;

    /** None: no recording is open yet. Any thread. */
    virtual std::optional<types::Playback> playback() const = 0;
};

/** A task that records. */
class Recorder {
public:
    virtual ~Recorder() = default;

    /** None: nothing has been written yet. Any thread. */
    virtual std::optional<types::Recording> recording() const = 0;
};

/** A task that takes new values of its properties while it runs: one that overrides TaskContext::propertiesHook. The
 *  live view shows the properties of other tasks read-only. */
class Adjustable {
public:
    virtual ~Adjustable() = default;

    /** Whether a property can be set while the task runs, by its name without those below blocks. Any thread. */
    virtual bool adjusts(const std::string& /*property*/) const { return true; }
};

/** A task that decides which parts of its work are done and which are omitted. */
class Planned {
public:
    virtual ~Planned() = default;

    /** Null: not decided yet. Valid after the first cycle. When the plan has changed, the task calls
     *  TaskContext::refreshRecord before it writes the first sample under the new plan. */
    virtual const types::Plan* plan() const = 0;
};

/** A task whose runs can be cut into shards: it writes the same sample no matter at which sample the run begins.
 *
 *  Instants before the shard are rehearsed (Environment::rehearsing). The task then does only what later samples depend
 *  on, such as turning a motor. It skips work that may take long or that leaves the deployment. A source of counted
 *  samples writes a sample that has a time and nothing else. A task that reads such samples passes them on and counts
 *  them, and makes nothing of them. */
class Divisible {
public:
    virtual ~Divisible() = default;

    /** Returns why a run with this task and its properties cannot be cut; empty: it can. The text starts with the
     *  property that prevents it and names the remedy, "quality: is chosen ...". */
    virtual std::string indivisible() const { return {}; }
};

/** A task that may be in error only because it receives no data: a run that ends in this state has not failed. */
class Waits {
public:
    virtual ~Waits() = default;

    /** Whether it waits now, after having received data before. Any thread. */
    virtual bool waits() const = 0;
};

/** Returns the plan of a Planned task; null: not Planned, or no plan yet. On the task's thread, or when it has
 *  stopped. */
inline const types::Plan* makePlan(const TaskContext& task) {
    const auto* const planned = dynamic_cast<const Planned*>(&task);
    return planned ? planned->plan() : nullptr;
}

}  // namespace insonify::framework
