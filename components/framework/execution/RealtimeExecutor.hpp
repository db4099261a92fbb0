#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "components/framework/execution/Activity.hpp"
#include "components/framework/execution/Executor.hpp"

namespace insonify::framework {

/** Watches tasks from its own thread while it exists. It reports a hanging cycle once, and its end, and each change of
 *  a task to RunTimeError and back. It cannot end a cycle. Its priority is above those of tasks with `scheduler: fifo`,
 *  where the system permits it. */
class Watchdog {
public:
    struct Limit {
        TaskContext* task;
        double
            seconds;  ///< How long a cycle may take, without the pauses that it makes itself, see Activity::sleepUntil.
    };
    /** Called with "camera: ..." on the watchdog's thread. */
    using Report = std::function<void(const std::string&)>;

    /** Throws std::runtime_error if there is no thread for it. */
    Watchdog(const std::vector<Limit>& limits, Report report);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

private:
    struct Watched {
        Limit limit;
        int64_t reported = 0;  ///< Start of the hanging cycle that was reported; 0: none [ns].
        bool in_error = false;
    };
    void outrankTasks() const;
    void loop();
    void look(Watched& watched) const;
    void lookForHang(Watched& watched) const;

    std::vector<Watched> watched_;
    Report report_;
    double interval_ = 0.05;  ///< Between two checks [s].
    std::mutex mutex_;
    std::condition_variable wake_;
    bool ending_ = false;
    std::thread thread_;
};

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
