#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/Executor.hpp"
#include "components/framework/Watchdog.hpp"

namespace insonify::framework {

/** Gives this thread, and those that it will start, the scheduler, priority and processors of the settings.
 *  Returns what could not be had, and why; empty: all of it was. */
std::vector<std::string> applyToThread(const ActivitySettings& settings);

/** All memory of the process, present and future, stays resident. Empty, or why it cannot: then nothing is locked. */
std::string lockMemory();
void unlockMemory();

/** Has each task work on its own thread and the wall clock, or on that of a ClockSource among them. What the system
 *  does not permit of memory, priorities and processors is a warning of the environment, as is what a Watchdog sees. */
class RealtimeExecutor final : public Executor {
public:
    struct Options {
        bool lock_memory = false;  ///< All memory stays resident.
        double watchdog = 10;      ///< How long a cycle may take, of a task that says nothing else [s].
    };
    RealtimeExecutor(const Graph& graph, Environment& environment, types::Time start, Options options);

    void begin() override;
    void release(TaskContext& task) override;
    /** Until a limit, a task that fails, or `stop`. `report` comes every few milliseconds. */
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
