#pragma once
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>

#include "types/text/Describe.hpp"

namespace insonify::types {

/** A time in the (simulated) world, or a duration: Rock's base::Time. 0 is Rock's null: "no time". */
struct Time {
    static constexpr const char* type_name = "/base/Time";
    int64_t microseconds = 0;

    static Time fromSeconds(double seconds) { return {static_cast<int64_t>(std::llround(seconds * 1e6))}; }
    double seconds() const { return static_cast<double>(microseconds) * 1e-6; }
    bool isNull() const { return microseconds == 0; }

    friend auto operator<=>(const Time&, const Time&) = default;
    friend Time operator+(Time a, Time b) { return {a.microseconds + b.microseconds}; }
    friend Time operator-(Time a, Time b) { return {a.microseconds - b.microseconds}; }

    static void describe(auto& self, auto& visit) {
        visit({"microseconds", "us", "since the epoch, or a duration"}, self.microseconds);
    }
};

}  // namespace insonify::types

// Durations on a clock that may be set, as the wall clock is when it gets the time of a network or of GPS.
namespace insonify::types {

/** Returns the time since an event on our clock; infinitely long when the clock has been set back since. */
constexpr Time elapsed(Time since, Time now) {
    return now < since ? Time{std::numeric_limits<int64_t>::max()} : now - since;
}

/** Returns whether `period` has passed since an event on our clock, or the clock has been set back since. A clock that
 *  is set back thus delays what is due by less than a period. */
constexpr bool due(Time last, Time period, Time now) { return elapsed(last, now) >= period; }

/** A stamp further before the previous one of its stream is no late sample: the clock of the stamps was set back, or a
 *  recording repeats. */
constexpr Time max_lateness{1'000'000};

/** Counts time on a clock that may be set: a step back counts as no time, a step forward as the time that it skips. The
 *  steady time is the clock's until the clock is set back for the first time. */
class SteadyTime {
public:
    /** Returns the steady time of a reading of the clock; each reading is later than the one before it. */
    Time read(Time clock) {
        step_back_ = last_ && clock < *last_ ? *last_ - clock : Time{};
        ahead_ = ahead_ + step_back_;
        last_ = clock;
        return steady(clock);
    }
    /** Returns the steady time of a stamp of the clock as it is set now. */
    Time steady(Time stamp) const { return stamp + ahead_; }
    /** Returns what the clock will show at a steady time unless it is set again. */
    Time clock(Time steady) const { return steady - ahead_; }

    /** Whether the clock was set back by more than max_lateness between the last two readings. */
    bool jumpedBack() const { return step_back_ > max_lateness; }

private:
    std::optional<Time> last_;
    Time ahead_;  ///< The steady time minus the clock's.
    Time step_back_;
};

}  // namespace insonify::types
