#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/sonar/renderer/Quality.hpp"

namespace insonify::sonar {

/** Keeps pings within a time by limiting their samples.
 *
 *  Lowers the limit to nine tenths of the time when 2 of the last 20 pings took longer than the time. Raises it when
 *  enough successive pings would allow at least 9 % more samples. Enough is 4 until the first fall, then 20, and
 *  doubles, up to 320, with each fall within 400 pings of the fall before. Assumes that times are proportional to
 *  samples, which overestimates the time of more samples. */
class BudgetKeeper {
public:
    /** Begins with a limit of `limit` samples. */
    explicit BudgetKeeper(double budget_ms, double limit = std::numeric_limits<double>::infinity())
        : budget_ms_(budget_ms), limit_(limit) {}
    double budget() const { return budget_ms_; }
    /** Sets another time [ms]. */
    void setBudget(double budget_ms) { budget_ms_ = budget_ms; }
    /** Returns the max samples of a ping [1]. */
    double limit() const { return limit_; }
    /** Records the time of a ping with this number of samples [ms]. Returns whether the limit has changed. */
    bool note(double ms, double samples);

private:
    bool moveTo(double limit);
    double slowButOne() const;  ///< Second longest time of the last pings [ms].

    static constexpr int window = 20;
    double budget_ms_, limit_;
    std::array<double, window> times_{};  ///< Times of the last pings since the limit was changed [ms].
    int pings_ = 0;                       ///< Pings since the limit was changed [1].
    int since_fall_ = -1;                 ///< Pings since the last fall; -1: none yet [1].
    int patience_ = 4;
};

/** The period of pings from the times between them: the lower quartile of the last 16, which neither an omitted ping
 *  nor two poses at once change. */
class PeriodMeter {
public:
    void note(double seconds) { seconds_[count_++ % seconds_.size()] = seconds; }
    double period() const;  ///< Period; 0 before the first time [s].

private:
    std::array<double, 16> seconds_{};
    size_t count_ = 0;
};

/** Chooses a sonar's quality on the first ping with an echo, and maintains it.
 *
 *  The first ping is rendered at several qualities until its measured error is within the target. About every fourth
 *  ping (each in the first turn of a head) is compared with a coarser one, for 8 % of the samples. Where the
 *  difference is larger than on the measured ping, the predicted error rises with it; where it is smaller, nothing
 *  changes. The quality is chosen again, on this ping, if the predicted error exceeds 1.2 times the target and 1.5
 *  times the error of the choice. Rows and columns are not lowered then for a head. It is chosen again as well if all
 *  errors of a whole turn of the head, and of at least 64 pings, were within half the target and had fallen by a third:
 *  a still scene keeps its quality. New choices have at most 15 % of the pings' samples plus 100 pings. All decisions
 *  depend on the pings alone, so that a run can be repeated bit for bit; with a budget also on their times.
 *
 *  When settings of the sonar change, such as the range, the quality stays. From then on the quality is not chosen anew
 *  on one ping, so that no ping takes much longer than the others. It moves by at most half of its samples from ping to
 *  ping, and each ping of such a move is compared with a coarser one, until the predicted error is within 1.2 times the
 *  target. */
class QualityKeeper {
public:
    /** `turn`: pings in which the sonar covers all its look directions [1]. */
    QualityKeeper(const SonarConfig& config, int turn);
    /** Evaluates a ping of `scene` that `renderer` has rendered in `ms`. Renders it again where its error is too
     *  large. Leaves the renderer at the quality of the next ping. Returns whether quality() has changed.
     *  `period_ms`: period of the pings, which is the budget where there is no other; 0: none. */
    bool follow(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                double period_ms = 0);
    /** Switches to a sonar with other settings. Returns false where the quality must be chosen anew by another keeper:
     *  before the first choice, with another `quality`, or where these columns cannot be rasterised. */
    bool changeConfig(const SonarConfig& config);
    /** Returns the quality of the next ping. */
    const Quality& upcoming() const { return next_ ? *next_ : model_.at; }
    /** Returns the quality of the last ping that was followed, with its predicted error. */
    const Quality& quality() const { return model_.at; }
    /** Returns whether the quality has been chosen, on a ping with an echo. */
    bool isChosen() const { return chosen_; }
    /** Returns the notices since the last call, one sentence each. */
    types::Notices consumeNotices() { return std::exchange(notices_, {}); }

private:
    double maxSamples() const;  ///< Max samples per beam [1].
    bool mayChoose() const;
    void choose(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double target,
                const Quality& minimum);
    /** Takes an error that was measured on `ping`, and compares the ping with a coarser one. */
    void take(const ErrorModel& measured, SonarRenderer& renderer, const types::Snapshot& scene,
              const types::Sonar& ping);
    /** Returns the error of a ping from its difference to a coarser one [1]. */
    double computeError(double change);
    void watch(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping);
    bool isDue() const;
    /** Evaluates a ping after a change of settings or of the quality, and moves the quality towards the target. */
    void approach(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping);
    /** Moves the next ping's quality towards the target, from this ping's error [1], within these samples per beam. */
    void move(double error, double max_samples, const Quality& minimum = {});
    void settle(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double error);
    /** Chooses the quality of the next ping for its time. */
    void keepBudget(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping, double ms,
                    double period_ms);
    void report(const types::Notice& notice);
    void reportChoice(const types::Snapshot& scene);
    void reportBudget(const types::Snapshot& scene, double ms);
    std::string text() const;
    std::string limitText() const;  ///< Why there is no finer quality.

    SonarConfig config_;
    double beams_, target_;  ///< `target_` is 0 without a target.
    int turn_;
    QualityLadder ladder_;
    ErrorEstimator estimator_;
    std::optional<BudgetKeeper> budget_;
    ErrorModel model_;             ///< At the current quality; its error covers all pings of it.
    double measured_ = 0;          ///< Error of the ping of the last choice, at the current quality [1].
    double least_ = 0;             ///< Smallest error that is predicted for that ping [1].
    double change_ = 0;            ///< Difference of that ping to a coarser one; negative: unknown at this quality [1].
    double per_change_ = 0;        ///< Predicted error per difference to a coarser ping [1].
    std::optional<Quality> next_;  ///< Quality of the next ping, where it is another.
    bool chosen_ = false, missed_ = false, late_reported_ = false;
    bool steady_ = false;          ///< Whether settings have changed: the quality only moves in steps.
    bool approaching_ = false;     ///< Whether each ping is evaluated, since the last change of settings.
    int64_t pings_ = 0;            ///< Pings with an echo [1].
    double received_samples_ = 0;  ///< Samples per beam of all pings with an echo [1].
    double choosing_ = 0;          ///< Samples per beam of all choices [1].
    int since_change_ = 0;         ///< Pings with an echo since the quality was changed or last evaluated [1].
    double worst_ = 0;             ///< Largest error in these pings [1].
    int turns_ = 1;                ///< Turns, or 64 pings each, without need until the quality is lowered [1].
    bool lowered_ = false;         ///< Whether it was lowered last.
    Quality reported_;             ///< Quality of the last notice.
    int notices_reported_ = 0;
    types::Notices notices_;
};

}  // namespace insonify::sonar
