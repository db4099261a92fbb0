#pragma once
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace insonify::types {

/** Counts what recurs by reason and says when to warn of it, which is seldom. All functions are for any thread. */
class ThrottledWarning {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds interval{10};

    /** `noun` and `participle` of what is counted: "message", "dropped". */
    ThrottledWarning(std::string noun, std::string participle)
        : noun_(std::move(noun)), participle_(std::move(participle)) {}

    /** `detail` is told with the last, and is no reason of its own: a sender may choose it. */
    void add(const std::string& reason, const std::string& detail = "", uint64_t count = 1);
    void reset();

    uint64_t count() const;    ///< Over all reasons.
    std::string last() const;  ///< Reason and detail.
    std::map<std::string, uint64_t> byReason() const;
    /** "3 messages dropped; the last: ...", at the first and then once an interval while more come; else empty. */
    std::string takeWarning(Clock::time_point now = Clock::now());
    /** A line for each reason: "3 messages dropped: /auv/odometry: ...". */
    std::vector<std::string> summary() const;

private:
    std::string counted(uint64_t count) const;

    const std::string noun_, participle_;
    mutable std::mutex mutex_;
    std::map<std::string, uint64_t> by_reason_;
    std::string last_;
    uint64_t count_ = 0, told_ = 0;
    Clock::time_point told_at_;
};

}  // namespace insonify::types
