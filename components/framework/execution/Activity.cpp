#include "components/framework/execution/Activity.hpp"

#include <algorithm>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {
namespace {

std::chrono::nanoseconds nanoseconds(double seconds) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

}  // namespace

Activity::~Activity() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void Activity::configure(ActivitySettings settings) {
    settings_ = std::move(settings);
    const auto& names = settings_.trigger;
    for (InputPortBase* port : owner_.inputs()) {
        const bool named = names.empty() || std::find(names.begin(), names.end(), port->name()) != names.end();
        port->setTriggers(!settings_.periodic() && named);
    }
}

void Activity::submit(Job& job) {
    process_.require("this task");
    std::unique_lock<std::mutex> lock(mutex_);
    if (thread_.get_id() == std::this_thread::get_id()) {
        lock.unlock();
        return job.function(job.callable);
    }
    // First, so that a job is not in the list if this throws.
    if (!thread_.joinable()) thread_ = types::startThread("task " + owner_.name(), [this] { loop(); });
    Job** last = &first_job_;
    while (*last) last = &(*last)->next;
    *last = &job;
    wake_.notify_one();
    served_.wait(lock, [&] { return job.done; });
    if (job.error) std::rethrow_exception(job.error);
}

void Activity::release() {
    {
        std::lock_guard lock(mutex_);
        free_ = realtime_ = true;
        woken_ = false;
        next_cycle_ = Clock::now();
        wake_after_ = nanoseconds(owner_.wakeAfter());  // read here: the owner may be destroyed while the thread waits
        if (!settings_.periodic()) next_cycle_ += wake_after_;
    }
    wake_.notify_one();
    if (owner_.triggered()) trigger();  // samples that arrived before
}

void Activity::hold() {
    {
        std::lock_guard lock(mutex_);
        free_ = false;
    }
    call([] {});  // a running cycle ends first
}

void Activity::trigger() {
    if (!free_) return;
    {
        std::lock_guard lock(mutex_);
        if (!free_ || woken_) return;
        woken_ = true;
    }
    wake_.notify_one();  // without the mutex, so that the thread can lock it at once
}

void Activity::loop() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ending_) {
        if (first_job_)
            serve(lock);
        else if (due())
            runCycle(lock);
        else
            wait(lock);
    }
}

void Activity::serve(std::unique_lock<std::mutex>& lock) {
    Job& job = *first_job_;
    first_job_ = job.next;
    lock.unlock();
    try {
        job.function(job.callable);
    } catch (...) {
        job.error = std::current_exception();
    }
    lock.lock();
    job.done = true;
    served_.notify_all();
}

bool Activity::due() const {
    if (!free_) return false;
    return (woken_ && !settings_.periodic()) || (timed() && Clock::now() >= next_cycle_);
}

bool Activity::timed() const { return settings_.periodic() || wake_after_.count() > 0; }

/** Times are absolute: a late cycle does not shift the next; a period that is missed altogether is skipped. */
void Activity::schedule() {
    const auto now = Clock::now();
    if (!settings_.periodic()) {
        next_cycle_ = now + wake_after_;
        return;
    }
    const auto period = nanoseconds(settings_.period);
    const auto missed = (now - next_cycle_) / period;
    owner_.timing().jitter.add(std::chrono::duration<double>(now - next_cycle_).count());
    // Read by reports while the task runs.
    std::atomic_ref(owner_.timing().overruns).fetch_add(static_cast<uint64_t>(missed), std::memory_order_relaxed);
    next_cycle_ += period * (1 + missed);
}

void Activity::runCycle(std::unique_lock<std::mutex>& lock) {
    if (timed()) schedule();
    woken_ = false;
    lock.unlock();
    const bool more = owner_.cycle();
    lock.lock();
    woken_ = woken_ || more;
}

void Activity::wait(std::unique_lock<std::mutex>& lock) {
    if (free_ && timed())
        wake_.wait_until(lock, next_cycle_);
    else
        wake_.wait(lock);
}

bool Activity::sleepUntil(types::Time time) {
    const Environment& environment = owner_.environment();
    const auto left = [&] { return std::chrono::microseconds((time - environment.now()).microseconds); };
    owner_.timing().pause();
    {
        std::unique_lock<std::mutex> lock(mutex_);
        if (environment.wall_clock) {  // may be set while this waits
            const auto end = Clock::now() + left();
            while (free_ && wake_.wait_until(lock, end) == std::cv_status::no_timeout) {
            }
        } else {
            constexpr std::chrono::microseconds at_most(20'000);  // another clock may stand still, or run faster
            for (auto rest = left(); free_ && rest.count() > 0; rest = left())
                wake_.wait_for(lock, std::min(rest, at_most));
        }
    }
    owner_.timing().resume();
    return free_;
}

}  // namespace insonify::framework
