#include "components/framework/Lockstep.hpp"

#include <algorithm>

#include "components/framework/Activity.hpp"
#include "components/framework/Port.hpp"

namespace insonify::framework {
namespace {

bool readsNothing(const TaskContext& task) {
    const auto& inputs = task.inputs();
    return std::none_of(inputs.begin(), inputs.end(), [](const auto* port) { return port->connected(); });
}

uint64_t samplesWritten(const TaskContext& task) {
    uint64_t written = 0;
    for (const OutputPortBase* port : task.outputs()) written += port->written();
    return written;
}

}  // namespace

types::Time Lockstep::Timed::due(types::Time start) const {
    if (!task->activity().settings().periodic()) return task->nextTime().value_or(never);
    return start + types::Time::fromSeconds(static_cast<double>(cycle) * task->activity().settings().period);
}

Lockstep::Lockstep(const std::vector<std::unique_ptr<TaskContext>>& tasks, const std::vector<TaskContext*>& order,
                   types::Time start)
    : start_(start) {
    for (const auto& task : tasks) {
        if (!task->activity().settings().periodic() && !task->nextTime()) continue;
        timed_.push_back({task.get()});
        if (readsNothing(*task)) sources_.push_back(task.get());
    }
    for (TaskContext* task : order)
        if (!task->activity().settings().periodic()) triggered_.push_back(task);
}

types::Time Lockstep::next() const {
    types::Time next = never;
    for (const Timed& timed : timed_) next = std::min(next, timed.due(start_));
    return next;
}

void Lockstep::step() {
    const types::Time instant = next();
    sources_wrote_ = false;
    for (Timed& timed : timed_) {
        if (timed.due(start_) != instant) continue;
        const uint64_t written = samplesWritten(*timed.task);
        timed.task->update();
        sources_wrote_ |= samplesWritten(*timed.task) != written;
        ++timed.cycle;
    }
    // Writers come before readers and update() empties the triggering ports, so one pass leaves all quiet.
    for (TaskContext* task : triggered_)
        if (task->triggered()) task->update();
}

bool Lockstep::sourcesFinished() const {
    return std::all_of(sources_.begin(), sources_.end(), [](const TaskContext* task) { return task->finished(); });
}

}  // namespace insonify::framework
