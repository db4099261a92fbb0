#include "components/framework/execution/LockstepExecutor.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "components/framework/execution/Activity.hpp"

namespace insonify::framework {
namespace {

constexpr int max_failures = 20'000;  ///< Consecutive instants with an error after which no counted sample is expected.
constexpr int max_refusals = 100'000;  ///< Consecutive instants after which no counted sample is expected any more.

bool readsNothing(const TaskContext& task) {
    return std::ranges::none_of(task.inputs(), [](const auto* port) { return port->connected(); });
}

uint64_t samplesWritten(const TaskContext& task) {
    uint64_t written = 0;
    for (const OutputPortBase* port : task.outputs()) written += port->written();
    return written;
}

}  // namespace

LockstepExecutor::LockstepExecutor(const Graph& graph, Environment& environment, types::Time start)
    : Executor(graph, environment, start), now_us_(start.microseconds) {
    environment_.now = [this] { return types::Time{now_us_.load()}; };
}

// -- order of the tasks -----------------------------------------------------------------------------------------------

void LockstepExecutor::findTasks() {
    timed_.clear(), sources_.clear(), triggered_.clear();
    for (const auto& task : graph_.tasks()) {
        const bool periodic = task->activity().settings().periodic();
        const auto* const source = dynamic_cast<const ClockSource*>(task.get());
        if (!periodic && !(source && source->nextTime())) continue;
        timed_.push_back({task.get(), periodic ? nullptr : source});
        if (readsNothing(*task)) sources_.push_back(task.get());
    }
    for (TaskContext* task : graph_.order())
        if (!task->activity().settings().periodic()) triggered_.push_back(task);
}

types::Time LockstepExecutor::due(const Timed& timed) const {
    if (timed.source) return timed.source->nextTime().value_or(never);
    return start_ +
           types::Time::fromSeconds(static_cast<double>(timed.cycle) * timed.task->activity().settings().period);
}

types::Time LockstepExecutor::next() const {
    types::Time next = never;
    for (const Timed& timed : timed_) next = std::min(next, due(timed));
    return next;
}

types::Time LockstepExecutor::nextBetweenInstants() {
    const auto held = betweenInstants();
    return next();
}

void LockstepExecutor::runInstant(types::Time instant) {
    now_us_ = instant.microseconds;
    sources_wrote_ = false;
    for (Timed& timed : timed_) {
        if (due(timed) != instant) continue;
        const uint64_t written = samplesWritten(*timed.task);
        timed.task->update();
        sources_wrote_ |= samplesWritten(*timed.task) != written;
        ++timed.cycle;
    }
    // Writers run before readers and update() empties the triggering ports, so one pass suffices.
    for (TaskContext* task : triggered_)
        if (task->triggered()) task->update();
}

// -- a run ------------------------------------------------------------------------------------------------------------

void LockstepExecutor::begin() {
    Executor::begin();
    stood_still_ = {};
    timed_.clear();
}

bool LockstepExecutor::advance() {
    if (timed_.empty()) findTasks();
    const auto held = betweenInstants();
    const types::Time instant = next();
    if (instant == never) return false;
    runInstant(instant);
    return true;
}

void LockstepExecutor::run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) {
    findTasks();
    refusals_ = failures_ = 0;
    first_ = limits.shard ? limits.shard->first : 0;
    const types::Time end = limits.duration_s > 0 ? start_ + types::Time::fromSeconds(limits.duration_s) : never;
    for (types::Time instant = nextBetweenInstants(); !stop && instant < end; instant = nextBetweenInstants()) {
        standStill(stop);
        keepPace(limits.pace, instant, stop);
        letCallersIn(stop);
        {
            struct Turn {
                LockstepExecutor& executor;
                std::unique_lock<std::mutex> held = executor.acquireTurn();
                ~Turn() { executor.giveTurn(std::move(held)); }
            } const turn{*this};
            if (!consumeStep()) continue;        // paused meanwhile
            const types::Time now_due = next();  // may differ, if a source has advanced meanwhile
            if (now_due >= end || !joinStep(limits)) return;
            const uint64_t before = graph_.countedSamples();
            runInstant(now_due);
            const auto is_in_error = [](const auto& task) { return task->state() == TaskState::RunTimeError; };
            const bool has_failed =
                before == graph_.countedSamples() && std::ranges::any_of(graph_.tasks(), is_in_error);
            failures_ = has_failed ? failures_ + 1 : 0;
        }
        if (report) report(progress());
        refusals_ = graph_.hasSourceInError() ? refusals_ + 1 : 0;
        if (isOver(limits) || sourcesAreDone(limits)) return;
    }
}

bool LockstepExecutor::joinStep(const RunLimits& limits) {
    const uint64_t done = graph_.countedSamples();
    environment_.rehearsing = limits.shard && done < limits.shard->first;
    return !limits.shard || done < limits.shard->last;
}

bool LockstepExecutor::sourcesAreDone(const RunLimits& limits) const {
    if (limits.samples > 0 && (refusals_ >= max_refusals || failures_ >= max_failures)) return true;
    if (!std::ranges::all_of(sources_, [](const TaskContext* task) { return task->finished(); })) return false;
    // With a limit, a source that keeps writing its last value counts as active, unless that value is refused; a source
    // that writes nothing more does not.
    if (limits.samples > 0 && refusals_ > 0) return true;
    const bool is_limited = limits.samples > 0 || limits.duration_s > 0;
    return !is_limited || !sources_wrote_;
}

void LockstepExecutor::keepPace(double pace, types::Time instant, const std::atomic<bool>& stop) const {
    if (pace <= 0) return;
    using Seconds = std::chrono::duration<double>;
    const Seconds due((instant - start_).seconds() / pace);
    for (Seconds left = due; !stop && !isHalted() && left.count() > 0;
         left = due - (Clock::now() - wall_start_ - stood_still_))
        std::this_thread::sleep_for(std::min(left, Seconds(0.02)));
}

void LockstepExecutor::letCallersIn(const std::atomic<bool>& stop) const {
    const uint64_t goal = called_;
    while (let_in_ < goal && !stop) std::this_thread::sleep_for(std::chrono::microseconds(100));
}

std::unique_lock<std::mutex> LockstepExecutor::betweenInstants() {
    ++called_;
    std::unique_lock lock(instant_mutex_);
    turn_.wait(lock, [this] { return !instant_due_; });
    ++let_in_;
    return lock;
}

std::unique_lock<std::mutex> LockstepExecutor::acquireTurn() {
    instant_due_ = true;
    return std::unique_lock(instant_mutex_);
}

void LockstepExecutor::giveTurn(std::unique_lock<std::mutex> held) {
    instant_due_ = false;
    held.unlock();
    turn_.notify_all();
}

// -- pausing ----------------------------------------------------------------------------------------------------------

void LockstepExecutor::pause(bool on) {
    const auto held = betweenInstants();
    steps_ = 0;
    paused_ = on;
}

void LockstepExecutor::step() {
    if (!paused_) throw std::runtime_error("cannot step: the deployment is not paused");
    ++steps_;
}

bool LockstepExecutor::consumeStep() {
    if (isHalted()) return false;
    if (paused_) --steps_;
    return true;
}

void LockstepExecutor::standStill(const std::atomic<bool>& stop) {
    const auto since = Clock::now();
    while (isHalted() && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    stood_still_ += Clock::now() - since;
}

}  // namespace insonify::framework
