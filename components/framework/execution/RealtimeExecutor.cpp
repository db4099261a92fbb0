#include "components/framework/execution/RealtimeExecutor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "components/framework/Offers.hpp"
#include "components/framework/execution/Activity.hpp"

namespace insonify::framework {
namespace {

std::string useFifo(int priority) {
    const sched_param wanted{priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    if (error == 0) return {};
    if (error != EPERM) return fmt::format("no SCHED_FIFO: {}", std::strerror(error));
    return fmt::format("no SCHED_FIFO: priority {} is not permitted (LimitRTPRIO or ulimit -r, or CAP_SYS_NICE)",
                       priority);
}

std::string useProcessors(const std::vector<uint32_t>& cpus) {
    cpu_set_t wanted;
    CPU_ZERO(&wanted);
    for (const uint32_t cpu : cpus) CPU_SET(cpu, &wanted);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted);
    if (error == 0) return {};
    return fmt::format("cannot run on only the CPUs {}: {}", fmt::join(cpus, ", "),
                       error == EINVAL ? "they do not exist, or this process may not use them" : std::strerror(error));
}

}  // namespace

Watchdog::Watchdog(const std::vector<Limit>& limits, Report report) : report_(std::move(report)) {
    for (const Limit& limit : limits) {
        watched_.push_back({limit});
        interval_ = std::clamp(limit.seconds / 4, 0.001, interval_);
    }
    thread_ = types::startThread("the watchdog", [this] { loop(); });
}

Watchdog::~Watchdog() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

/** Sets a priority above those of the tasks, so that a task that uses a processor without end is reported. */
void Watchdog::outrankTasks() const {
    ActivitySettings own;
    for (const Watched& watched : watched_) {
        const ActivitySettings& settings = watched.limit.task->activity().settings();
        if (settings.fifo) own.fifo = true, own.priority = std::max(own.priority, std::min(settings.priority + 1, 99));
    }
    applyToThread(own);  // where it is not permitted, it was not for the tasks, who have said so
}

void Watchdog::loop() {
    outrankTasks();
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::duration<double>(interval_), [this] { return ending_; }))
        for (Watched& watched : watched_) try {
                look(watched);
            } catch (...) {
                // A report that cannot be made, for lack of memory or by its receiver, must not end the process.
            }
}

void Watchdog::look(Watched& watched) const {
    lookForHang(watched);
    const TaskContext& task = *watched.limit.task;
    const TaskState state = task.state();
    const bool in_error = state == TaskState::RunTimeError;
    const bool was_in_error = std::exchange(watched.in_error, in_error);
    if (in_error && !was_in_error) report_(fmt::format("{}: RunTimeError: {}", task.name(), task.lastError()));
    if (was_in_error && state == TaskState::Running) report_(task.name() + ": has recovered");
}

void Watchdog::lookForHang(Watched& watched) const {
    TaskContext& task = *watched.limit.task;
    const int64_t since = task.timing().workingSince().count();
    const auto seconds = [](int64_t begin) { return static_cast<double>(Timing::ticks() - begin) * 1e-9; };
    if (watched.reported != 0 && since != watched.reported) {
        const int64_t begin = std::exchange(watched.reported, 0);
        report_(fmt::format("{}: is back after {:.3g} s", task.name(), seconds(begin)));
    }
    if (since == 0 || since == watched.reported || seconds(since) <= watched.limit.seconds) return;
    watched.reported = since;
    task.timing().hangs.fetch_add(1);
    report_(fmt::format("{}: hangs: a cycle has run for {:.3g} s", task.name(), watched.limit.seconds));
}

std::vector<std::string> applyToThread(const ActivitySettings& settings) {
    std::vector<std::string> refused;
    if (settings.fifo) refused.push_back(useFifo(settings.priority));
    if (!settings.cpus.empty()) refused.push_back(useProcessors(settings.cpus));
    std::erase(refused, "");
    return refused;
}

std::string lockMemory() {
    // Under a limit, locking the present memory may work while later allocations fail. So lock only without a limit.
    rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0) {
        getrlimit(RLIMIT_MEMLOCK, &limit);
        if (limit.rlim_cur != RLIM_INFINITY)
            return fmt::format(
                "memory is not locked: {} bytes are permitted, must be unlimited (LimitMEMLOCK or ulimit -l)",
                limit.rlim_cur);
    }
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
    return fmt::format("memory is not locked: {}", std::strerror(errno));
}

void unlockMemory() { munlockall(); }

RealtimeExecutor::RealtimeExecutor(const Graph& graph, Environment& environment, types::Time start, Options options)
    : Executor(graph, environment, start), options_(options) {
    followClocks();
}

void RealtimeExecutor::followClocks() {
    for (const auto& task : graph_.tasks()) {
        auto* const source = dynamic_cast<ClockSource*>(task.get());
        if (!source) continue;
        const std::function<types::Time()> wall = environment_.wall_clock ? steadyClock : environment_.now;
        if (auto clock = source->clock(wall)) {
            environment_.now = std::move(clock);
            environment_.wall_clock = false;
        }
    }
    if (!environment_.wall_clock) return;
    environment_.run_time = [this] {
        return types::Time{std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - wall_start_).count()};
    };
}

void RealtimeExecutor::begin() {
    Executor::begin();
    if (options_.lock_memory)
        if (const std::string refused = lockMemory(); !refused.empty()) environment_.warn(refused);
    prepareThreads();
    start_ = environment_.now();
    wall_start_ = Clock::now();
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
