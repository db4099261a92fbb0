#pragma once
#include <array>
#include <cstddef>
#include <limits>

namespace insonify::sonar {

/** Keeps pings within a time by limiting their samples. Down to nine tenths of the time when 2 of the last 20 pings
 *  took longer than it; up when so many pings in a row would leave room for at least 9 % more samples: 4 until the
 *  first fall, then 20, twice as many after each fall that follows within 400 pings of the one before, at most 320.
 *  Times are taken to be in proportion to samples, which overrates what more of them take. */
class BudgetKeeper {
public:
    /** Begins at `limit` samples. */
    explicit BudgetKeeper(double budget_ms, double limit = std::numeric_limits<double>::infinity())
        : budget_ms_(budget_ms), limit_(limit) {}
    double budget() const { return budget_ms_; }
    /** Another time holds from now on [ms]. */
    void setBudget(double budget_ms) { budget_ms_ = budget_ms; }
    /** Samples that a ping may have [1]. */
    double limit() const { return limit_; }
    /** Hears how long a ping of so many samples took [ms]; true when the limit is another one from now on. */
    bool note(double ms, double samples);

private:
    bool moveTo(double limit);
    double slowButOne() const;  ///< The longest but one of the last pings [ms].

    static constexpr int window = 20;
    double budget_ms_, limit_;
    std::array<double, window> times_{};  ///< Of the last pings since the limit was moved [ms].
    int pings_ = 0;                       ///< Since the limit was moved [1].
    int since_fall_ = -1;                 ///< Pings since the last fall; -1: none yet [1].
    int patience_ = 4;
};

/** The period of pings from the times between them: the lower quartile of the last 16, which neither a ping that was
 *  left out changes, nor two poses at once. */
class PeriodMeter {
public:
    void note(double seconds) { seconds_[count_++ % seconds_.size()] = seconds; }
    double period() const;  ///< 0 before the first time [s].

private:
    std::array<double, 16> seconds_{};
    size_t count_ = 0;
};

}  // namespace insonify::sonar
