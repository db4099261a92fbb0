#include "components/framework/Watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace insonify::framework {

Watchdog::Watchdog(const std::vector<Limit>& limits, Report report) : report_(std::move(report)) {
    for (const Limit& limit : limits) {
        watched_.push_back({limit});
        interval_ = std::clamp(limit.seconds / 4, 0.001, interval_);
    }
    thread_ = std::thread(&Watchdog::loop, this);
}

Watchdog::~Watchdog() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void Watchdog::loop() {
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

}  // namespace insonify::framework
