#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "types/Thread.hpp"
#include "types/Time.hpp"

namespace insonify::framework {

class TaskContext;

/** When a task's updateHook runs (every `period` seconds, or when a sample arrives on a triggering port), and the
 *  settings of its thread. Lockstep uses only `period` and `trigger`. */
struct ActivitySettings {
    double period = 0;                 ///< 0: triggered [s].
    std::vector<std::string> trigger;  ///< Input ports that wake the task; empty: all connected ports.
    bool fifo = false;                 ///< SCHED_FIFO with `priority`; else the system's default.
    int priority = 0;                  ///< 1 to 99; 99 is the highest.
    std::vector<uint32_t> cpus;        ///< Processors that the thread may use; empty: any.
    double deadline = 0;               ///< Max time from a sample's stamp to its writing; 0: no limit [s].
    double watchdog = 0;               ///< Max duration of a cycle before it is reported; 0: the deployment's [s].
    bool periodic() const { return period > 0; }
};

/** The single thread that runs all hooks and operations of a task. The first call starts it.
 *
 *  The thread serves calls at any time. Between release() and hold() it also runs cycles by itself, paced by the wall
 *  clock or by new samples. In lockstep the deployment requests each cycle. */
class Activity {
public:
    explicit Activity(TaskContext& owner) : owner_(owner) {}
    ~Activity();
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    const ActivitySettings& settings() const { return settings_; }
    /** Takes the settings and sets which input ports trigger the task. Not while released. */
    void configure(ActivitySettings settings);

    /** Runs `work` on the task's thread and waits until it ends; runs it directly when called on that thread. Rethrows
     *  what `work` throws. Allocates nothing. Throws std::runtime_error if the thread cannot be started, and in a
     * forked child, where there is no such thread. */
    template <class Work>
    void call(Work&& work) {
        using Callable = std::remove_reference_t<Work>;
        Job job{[](void* callable) { (*static_cast<Callable*>(callable))(); }, &work};
        submit(job);
    }

    void release();  ///< Lets the thread run cycles by itself; the first one at once if samples wait.
    void hold();     ///< Stops the cycles; none runs after the return (called from another thread).
    void trigger();  ///< Reports a new sample; any thread.
    /** Whether release() has been called: the task runs in realtime, even while it is held for its last cycle. */
    bool realtime() const { return realtime_; }
    /** Waits, within a cycle on the task's thread, until the task's clock shows `time`. Returns false as soon as the
     *  task is held. */
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
    bool timed() const;  ///< Whether next_cycle_ applies.
    void schedule();
    void runCycle(std::unique_lock<std::mutex>& lock);
    void wait(std::unique_lock<std::mutex>& lock);

    TaskContext& owner_;
    ActivitySettings settings_;
    types::OwnProcess process_;
    types::PriorityMutex mutex_;
    std::condition_variable wake_, served_;
    Job* first_job_ = nullptr;
    std::atomic<bool> free_{false};  ///< Changes under the mutex.
    std::atomic<bool> realtime_{false};
    bool woken_ = false, ending_ = false;
    std::chrono::nanoseconds wake_after_{0};
    Clock::time_point next_cycle_;  ///< For a triggered task: when it runs without a sample.
    std::thread thread_;
};

}  // namespace insonify::framework
