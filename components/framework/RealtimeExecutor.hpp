#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/Executor.hpp"
#include "components/framework/Watchdog.hpp"

namespace insonify::framework {

/** Sets the scheduler, priority and processors of this thread and of threads that it starts later. Returns what was
 *  refused, and why; empty: nothing was. */
std::vector<std::string> applyToThread(const ActivitySettings& settings);

/** Keeps all memory of the process, present and future, resident. Returns empty, or the reason why nothing is
 *  locked. */
std::string lockMemory();
void unlockMemory();

/** Runs each task on its own thread, by the wall clock or by the clock of a ClockSource among them. Warnings of the
 *  environment report refused memory locks, priorities and processors, and what a Watchdog reports. */
class RealtimeExecutor final : public Executor {
public:
    struct Options {
        bool lock_memory = false;  ///< All memory stays resident.
        double watchdog = 10;      ///< Max duration of a cycle, for tasks without their own limit [s].
    };
    RealtimeExecutor(const Graph& graph, Environment& environment, types::Time start, Options options);

    void begin() override;
    void release(TaskContext& task) override;
    /** Runs until a limit, a failing task, or `stop`. Calls `report` every few milliseconds. */
    void run(const RunLimits& limits, const std::atomic<bool>& stop, const Report& report) override;
    void end() override;
    void pause(bool on) override;
    void step() override;

private:
    void followClocks();
    void prepareThreads();
    std::vector<Watchdog::Limit> watchdogLimits() const;

    Options options_;
    std::optional<Watchdog> watchdog_;
};

}  // namespace insonify::framework
