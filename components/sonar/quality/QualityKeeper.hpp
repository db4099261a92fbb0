#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/sonar/quality/Quality.hpp"

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

/** Chooses a sonar's quality on the first ping that hears anything, and goes on looking after it: about every fourth
 *  ping its error is estimated (every second in the first turn of a head), for 8 % of the samples, with all that is
 *  rendered to choose again at most 15 % and ten pings. Where that is more than 1.2 times the target and 1.5 times
 *  what was predicted, the quality is chosen again on this very ping, rows and columns only ever raised; where a whole
 *  turn of the head, and 64 pings at least, never had more than half the target, it is lowered. All from the pings
 *  alone, so that a run can be repeated bit for bit; with a budget also from the times that they take. */
class QualityKeeper {
public:
    /** `turn`: pings in which the sonar looks all around, as far as it turns [1]. */
    QualityKeeper(const SonarConfig& config, int turn);
    /** Follows a ping of `scene` that `renderer` has rendered at quality() in `ms`; renders it again where it is not
     *  good enough, and leaves the renderer at quality(). True: the quality, or the error that is predicted, is another
     *  one. `period_ms`: of the pings, the budget where there is no other; 0: none. */
    bool follow(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                double period_ms = 0);
    const Quality& quality() const { return model_.at; }
    /** Whether a ping has been good enough to choose it. */
    bool isChosen() const { return chosen_; }
    /** What there is to tell since the last call, a sentence each. */
    std::vector<std::string> takeNotices() { return std::exchange(notices_, {}); }

private:
    double mostSamples() const;  ///< Per beam [1].
    void choose(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping);
    bool watch(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping);
    bool isDue();
    bool lower(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping);
    bool keepBudget(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                    double period_ms);
    void moveTo(SonarRenderer& renderer, const Quality& quality);
    void tell(const std::string& notice);
    void tellChoice(const types::Snapshot& scene);
    void tellBudget(const types::Snapshot& scene, double ms);
    std::string text() const;
    std::string limitText() const;  ///< Why there is no finer quality.

    SonarConfig config_;
    double beams_, target_;  ///< No target: 0.
    int turn_;
    QualityLadder ladder_;
    ErrorEstimator estimator_;
    std::optional<BudgetKeeper> budget_;
    ErrorModel model_;  ///< At the quality that holds.
    bool chosen_ = false, missed_ = false, late_told_ = false;
    int64_t pings_ = 0;         ///< That heard anything [1].
    double heard_samples_ = 0;  ///< Per beam of all of these [1].
    int since_change_ = 0;  ///< Pings that heard anything since the quality changed, or since it was last judged [1].
    double worst_ = 0;      ///< Largest error estimated of them [1].
    double modelled_ = 0;   ///< Samples per beam at which the error was last estimated in two parts [1].
    Quality told_;          ///< Of the last notice.
    int notices_told_ = 0;
    std::vector<std::string> notices_;
};

}  // namespace insonify::sonar
