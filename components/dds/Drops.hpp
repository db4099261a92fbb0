#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace insonify::dds {

/** Messages that were not taken or not sent, by reason. On one thread. */
class Drops {
public:
    /** `detail` is told with the last, and is no reason of its own: a sender may choose it. */
    void add(const std::string& reason, const std::string& detail = "", uint64_t count = 1);
    uint64_t count() const { return count_; }
    const std::map<std::string, uint64_t>& byReason() const { return by_reason_; }
    const std::string& last() const { return last_; }  ///< Reason and detail.
    /** What to warn of now: at the first drop, then every ten seconds at most; empty: nothing. */
    std::string untold();
    /** A line for each reason: "3 messages dropped: /auv/odometry: ...". */
    std::vector<std::string> notices() const;

private:
    using Clock = std::chrono::steady_clock;

    std::map<std::string, uint64_t> by_reason_;
    std::string last_;
    uint64_t count_ = 0, told_ = 0;
    Clock::time_point told_at_;
};

}  // namespace insonify::dds
