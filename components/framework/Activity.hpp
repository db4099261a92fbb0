#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "types/Time.hpp"

namespace insonify::framework {

class TaskContext;

/** When a task's updateHook runs: every `period` seconds, or when a sample arrives on one of its triggering ports; and
 *  on what. Of the rest, lockstep knows nothing. */
struct ActivitySettings {
    double period = 0;                 ///< 0: triggered [s].
    std::vector<std::string> trigger;  ///< Input ports that wake the task; empty: all that are connected.
    bool fifo = false;                 ///< SCHED_FIFO, with `priority`; else the system's default.
    int priority = 0;                  ///< 1 to 99, the highest.
    std::vector<uint32_t> cpus;        ///< Processors that the thread keeps to; empty: any.
    double deadline = 0;               ///< Samples written longer after their stamp are late; 0: none is [s].
    double watchdog = 0;               ///< A cycle that takes longer hangs; 0: as the deployment has it [s].
    bool periodic() const { return period > 0; }
};

/** The one thread on which all hooks and operations of a task run. It starts with the first call.
 *
 *  It serves calls at any time. Cycles of its own, paced by the wall clock or by new samples, it runs only between
 *  release() and hold(): in lockstep the deployment asks for each cycle. */
class Activity {
public:
    explicit Activity(TaskContext& owner) : owner_(owner) {}
    ~Activity();
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    const ActivitySettings& settings() const { return settings_; }
    /** Takes the settings and tells the input ports which of them trigger. Not while released. */
    void configure(ActivitySettings settings);

    /** Runs `work` on the task's thread and waits for its end; at once when this is that thread.
     *  What `work` throws is thrown here. Allocates nothing. */
    template <class Work>
    void call(Work&& work) {
        using Callable = std::remove_reference_t<Work>;
        Job job{[](void* callable) { (*static_cast<Callable*>(callable))(); }, &work};
        submit(job);
    }

    void release();  ///< From now on the thread runs cycles by itself; the first at once if samples wait.
    void hold();     ///< No cycle runs any more once this returns (called from another thread).
    void trigger();  ///< A new sample is there; any thread.
    /** Whether cycles have been released before: the task runs in realtime, even if it is held for its last cycle. */
    bool realtime() const { return realtime_; }
    /** In a cycle, on the task's thread: waits until the task's clock shows `time`. False as soon as the task is held.
     */
    bool sleepUntil(types::Time time);

private:
    struct Job {
        void (*function)(void*);
        void* callable;
        std::exception_ptr error = nullptr;
        bool done = false;
        Job* next = nullptr;
    };
    using Clock = std::chrono::steady_clock;

    void submit(Job& job);
    void loop();
    void serve(std::unique_lock<std::mutex>& lock);
    bool due() const;
    bool timed() const;  ///< Whether next_cycle_ counts.
    void schedule();
    void runCycle(std::unique_lock<std::mutex>& lock);
    void wait(std::unique_lock<std::mutex>& lock);

    TaskContext& owner_;
    ActivitySettings settings_;
    std::mutex mutex_;
    std::condition_variable wake_, served_;
    Job* first_job_ = nullptr;
    std::atomic<bool> free_{false};  ///< Changes under the mutex.
    std::atomic<bool> realtime_{false};
    bool woken_ = false, ending_ = false;
    std::chrono::nanoseconds wake_after_{0};
    Clock::time_point next_cycle_;  ///< Of a triggered task: when it runs without a sample.
    std::thread thread_;
};

}  // namespace insonify::framework
