#pragma once
#include "components/framework/Activity.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** Wakes a task from outside its deployment: for a message, a device.
 *
 *      framework::Event arrived_{this};  // and where it arrives, on any thread: arrived_.raise();
 *
 *  In realtime the task then runs a cycle, unless it has a period. The task needs no other activity. */
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
