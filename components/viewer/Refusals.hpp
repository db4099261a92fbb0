#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace insonify::viewer {

/** Connections that were refused: how many, and why the last was. All functions are for any thread. */
class Refusals {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds between_warnings{10};

    void add(std::string reason) {
        std::lock_guard lock(mutex_);
        ++count_;
        last_ = std::move(reason);
    }
    uint64_t count() const {
        std::lock_guard lock(mutex_);
        return count_;
    }
    /** What to warn of now: at the first refusal, then every ten seconds at most; empty: nothing. */
    std::string untold(Clock::time_point now = Clock::now()) {
        std::lock_guard lock(mutex_);
        if (count_ == told_ || (told_ > 0 && now < told_at_ + between_warnings)) return "";
        told_ = count_;
        told_at_ = now;
        return std::to_string(count_) + (count_ == 1 ? " connection" : " connections") + " refused; the last: " + last_;
    }

private:
    mutable std::mutex mutex_;
    std::string last_;
    uint64_t count_ = 0, told_ = 0;
    Clock::time_point told_at_;
};

}  // namespace insonify::viewer
