#pragma once
// Conversions of times to stamps of messages and back. Samples count whole microseconds, as Rock's do; messages count
// nanoseconds.
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "components/ros/Messages.hpp"
#include "types/Time.hpp"

namespace insonify::ros {

/** Converts to a stamp. Throws std::out_of_range for times beyond 32 bits of seconds: years before 1901 and after
 *  2038. */
inline Time toRos(types::Time time) {
    const int64_t rest = (time.microseconds % 1'000'000 + 1'000'000) % 1'000'000;
    const int64_t seconds = (time.microseconds - rest) / 1'000'000;
    if (seconds < std::numeric_limits<int32_t>::min() || seconds > std::numeric_limits<int32_t>::max())
        throw std::out_of_range("ROS holds no time of " + std::to_string(seconds) +
                                " s: from -2147483648 s to 2147483647 s");
    return {static_cast<int32_t>(seconds), static_cast<uint32_t>(rest * 1000)};
}

/** Truncates to microseconds. */
inline types::Time fromRos(Time time) { return {time.sec * int64_t{1'000'000} + time.nanosec / 1000}; }

inline Clock toClock(types::Time time) { return {toRos(time)}; }

/** Keeps the nanoseconds of read stamps, which samples lack, so that derived messages have the full stamp: a ping that
 *  of its pose. Holds the last few thousand stamps; of two in the same microsecond, the later. Thread-safe and
 *  lock-free. */
class FineStamps {
public:
    void note(Time stamp) {
        const int64_t all = nanoseconds(stamp);
        at(all / 1000).store(all, std::memory_order_relaxed);
    }
    /** Returns the full stamp in the microsecond of `stamp`, else `stamp`. */
    Time exact(Time stamp) const {
        const int64_t all = nanoseconds(stamp), kept = at(all / 1000).load(std::memory_order_relaxed);
        if (all < 0 || all % 1000 != 0 || kept / 1000 != all / 1000) return stamp;
        return {stamp.sec, static_cast<uint32_t>(kept % 1'000'000'000)};
    }

private:
    static int64_t nanoseconds(Time stamp) { return stamp.sec * int64_t{1'000'000'000} + stamp.nanosec; }
    std::atomic<int64_t>& at(int64_t microseconds) { return kept_[static_cast<uint64_t>(microseconds) % kept_.size()]; }
    const std::atomic<int64_t>& at(int64_t microseconds) const {
        return kept_[static_cast<uint64_t>(microseconds) % kept_.size()];
    }

    std::array<std::atomic<int64_t>, 4099> kept_{};  ///< [ns]; a prime, since periods are round numbers.
};

/** Returns the stamps of this process, shared by tasks: one task reads a pose, another sends its ping. */
inline FineStamps& fineStamps() {
    static FineStamps stamps;
    return stamps;
}

/** Keeps the stamp of a message that was read. */
void noteStamp(const auto& message) {
    if constexpr (requires { message.header.stamp; }) fineStamps().note(message.header.stamp);
}

/** Restores the full stamps of a message made from a sample. */
void restoreStamps(auto& message) {
    if constexpr (requires { message.header.stamp; })
        message.header.stamp = fineStamps().exact(message.header.stamp);
    else if constexpr (requires { message.clock; })
        message.clock = fineStamps().exact(message.clock);
    else if constexpr (requires { message.transforms; })
        for (TransformStamped& transform : message.transforms) restoreStamps(transform);
}

}  // namespace insonify::ros
