#pragma once
// Stamps finer than a microsecond. Samples count whole microseconds, as Rock's do; messages count nanoseconds.
#include <array>
#include <atomic>
#include <cstdint>

#include "components/ros/TransformMessages.hpp"

namespace insonify::ros {

/** Keeps what stamps of messages had beyond the microseconds of their samples, so that what is made of these samples
 *  bears the whole stamp again: a ping that of its pose. Of the last few thousand stamps; of two within one microsecond
 *  the later. For any thread, and without waiting. */
class FineStamps {
public:
    void note(Time stamp) {
        const int64_t all = nanoseconds(stamp);
        at(all / 1000).store(all, std::memory_order_relaxed);
    }
    /** The stamp that came with the microsecond of `stamp`, else `stamp`. */
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

/** Those of this process: a pose comes by one task, and its ping goes by another. */
inline FineStamps& fineStamps() {
    static FineStamps stamps;
    return stamps;
}

/** Notes the stamp of a message that was read. */
template <class Message>
void noteStamp(const Message& message) {
    if constexpr (requires { message.header.stamp; }) fineStamps().note(message.header.stamp);
}

/** Gives a message that was made of a sample its whole stamps. */
template <class Message>
void restoreStamps(Message& message) {
    if constexpr (requires { message.header.stamp; })
        message.header.stamp = fineStamps().exact(message.header.stamp);
    else if constexpr (requires { message.clock; })
        message.clock = fineStamps().exact(message.clock);
    else if constexpr (requires { message.transforms; })
        for (TransformStamped& transform : message.transforms) restoreStamps(transform);
}

}  // namespace insonify::ros
