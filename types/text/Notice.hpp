#pragma once
#include <chrono>
#include <concepts>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace insonify::types {

/** A sentence for the user about what a task or a file does. What prints it says its kind, too. */
struct Notice {
    enum class Kind : uint8_t { Note, Warning };

    template <std::convertible_to<std::string> Text>
    Notice(Text&& sentence, Kind of_kind = Kind::Note) : text(std::forward<Text>(sentence)), kind(of_kind) {}
    /** Returns the form of logs, of JSON and of the viewer's page: "Warning: " before the text of a warning. */
    explicit operator std::string() const { return kind == Kind::Warning ? "Warning: " + text : text; }
    friend bool operator==(const Notice&, const Notice&) = default;

    std::string text;
    Kind kind;
};
using Notices = std::vector<Notice>;

inline Notice warning(std::string text) { return {std::move(text), Notice::Kind::Warning}; }

/** Returns each notice in the form of logs. */
inline std::vector<std::string> lines(const Notices& notices) {
    std::vector<std::string> lines;
    for (const Notice& notice : notices) lines.emplace_back(notice);
    return lines;
}

/** Decides when to report wrong samples: the first, and another only after a series of right samples. */
class RecurringDiagnostic {
public:
    static constexpr int well_after = 10;  ///< Consecutive right samples before the next report [1].

    /** Returns whether to report this sample. */
    bool isDue(bool wrong) {
        const bool due = wrong && right_ >= well_after;
        right_ = wrong ? 0 : right_ + (right_ < well_after ? 1 : 0);
        return due;
    }

private:
    int right_ = well_after;
};

/** Counts recurring events by reason, and limits the warnings about them. All functions are thread-safe. */
class ThrottledWarning {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds interval{10};

    /** `noun` and `participle` name the events: "message", "dropped". */
    ThrottledWarning(std::string noun, std::string participle)
        : noun_(std::move(noun)), participle_(std::move(participle)) {}

    /** `detail` is printed with the last event. It does not count as a separate reason, because a sender may choose
     *  it. */
    void add(const std::string& reason, const std::string& detail = "", uint64_t count = 1);
    void reset();

    uint64_t count() const;    ///< Number of events of all reasons.
    std::string last() const;  ///< Reason and detail of the last event.
    std::map<std::string, uint64_t> byReason() const;
    /** Returns "3 messages dropped; the last: ..." for the first event, and then at most once per interval if there are
     *  new events; else empty. */
    std::string consumeWarning(Clock::time_point now = Clock::now());
    /** Returns a line for each reason: "3 messages dropped: /auv/odometry: ...". */
    std::vector<std::string> summary() const;

private:
    std::string counted(uint64_t count) const;

    const std::string noun_, participle_;
    mutable std::mutex mutex_;
    std::map<std::string, uint64_t> by_reason_;
    std::string last_;
    uint64_t count_ = 0, reported_ = 0;
    Clock::time_point reported_at_;
};

}  // namespace insonify::types
