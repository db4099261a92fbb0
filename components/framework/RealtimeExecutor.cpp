#include "components/framework/RealtimeExecutor.hpp"

#include <stdexcept>
#include <thread>

#include "components/framework/Activity.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/RealtimeThread.hpp"

namespace insonify::framework {

RealtimeExecutor::RealtimeExecutor(const Graph& graph, Environment& environment, types::Time start, Options options)
    : Executor(graph, environment, start), options_(options) {
    followClocks();
}

void RealtimeExecutor::followClocks() {
    for (const auto& task : graph_.tasks()) {
        auto* const source = dynamic_cast<ClockSource*>(task.get());
        if (!source) continue;
        if (auto clock = source->clock(environment_.now)) {
            environment_.now = std::move(clock);
            environment_.wall_clock = false;
        }
    }
}

void RealtimeExecutor::begin() {
    Executor::begin();
    if (options_.lock_memory)
        if (const std::string refused = lockMemory(); !refused.empty()) environment_.warn(refused);
    prepareThreads();
    start_ = environment_.now();
    watchdog_.emplace(watchdogLimits(), environment_.warn);
}

void RealtimeExecutor::prepareThreads() {
    for (const auto& task : graph_.tasks())
        task->activity().call([&] {
            for (const std::string& refused : applyToThread(task->activity().settings()))
                environment_.warn(task->name() + ": " + refused);
        });
}

std::vector<Watchdog::Limit> RealtimeExecutor::watchdogLimits() const {
    std::vector<Watchdog::Limit> limits;
    for (const auto& task : graph_.tasks()) {
        const double own = task->activity().settings().watchdog;
        limits.push_back({task.get(), own > 0 ? own : options_.watchdog});
    }
    return limits;
}

void RealtimeExecutor::release(TaskContext& task) { task.activity().release(); }

void RealtimeExecutor::run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) {
    while (!stop && !isOver(limits)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (limits.duration_s > 0 && progress().elapsed_s >= limits.duration_s) return;
        if (report) report(progress());
    }
}

void RealtimeExecutor::end() {
    watchdog_.reset();
    if (options_.lock_memory) unlockMemory();
}

void RealtimeExecutor::pause(bool /*on*/) {
    throw std::runtime_error("cannot pause: the deployment runs in realtime; in lockstep, time can stand still");
}

void RealtimeExecutor::step() { throw std::runtime_error("cannot step: the deployment is not paused"); }

}  // namespace insonify::framework
