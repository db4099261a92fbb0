#pragma once
#include "components/framework/Activity.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** What wakes a task from outside of its deployment: a message, a device.
 *
 *      framework::Event arrived_{this};  // and where it arrives, on any thread: arrived_.raise();
 *
 *  In realtime the task then runs a cycle, unless it has a period. It needs no other activity. */
class Event {
public:
    explicit Event(TaskContext* owner) : owner_(*owner) { owner->enlist(this); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    void raise() { owner_.activity().trigger(); }

private:
    TaskContext& owner_;
};

}  // namespace insonify::framework
