#include "components/sonar/renderer/QualityKeeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace insonify::sonar {
namespace {

constexpr int patience_after_fall = 20, max_patience = 320, forgiven_after = 400, more_patience = 4, max_turns = 1024;
constexpr double fall_to = 0.9, climb_to = 0.97, max_change = 4, min_climb = 1.09;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double watched_share = 0.2618034;  ///< Share of the pings; irrational, to cover all bearings of a head.
constexpr int rarely = 16;  ///< One of this number of due pings is evaluated where the budget is used up.
constexpr double off_target = 1.2, off_prediction = 1.5, well_within = 0.5, has_fallen = 0.67, near_budget = 0.8;
constexpr double min_look = 0.25;  ///< Min share of the worst error by which a target is lowered [1].
constexpr double overhead = 0.15,
                 pings_to_choose = 100;  ///< Max total cost of new choices [share of the pings, pings].
constexpr double min_per_change = 1.5;   ///< Least growth of the error with the difference to a coarser ping [1].
constexpr double pings_to_measure = 15, max_delay = 4;  ///< Max time to measure for a budget [pings, budgets].
constexpr double off_measure = 1.2;  ///< Margin where the error of another quality is taken from one comparison [1].
constexpr int min_pings = 64, settled = 20, max_notices = 20;
constexpr double worth_reporting = 1.2;
constexpr double max_move = 1.5;  ///< Max growth of samples from ping to ping after a change of settings [1].

}  // namespace

bool BudgetKeeper::moveTo(double limit) {
    limit_ = limit;
    pings_ = 0;
    return true;
}

double BudgetKeeper::slowButOne() const {
    std::array<double, window> times = times_;
    const auto last = times.begin() + std::min(pings_, window);
    std::nth_element(times.begin(), times.begin() + 1, last, std::greater<>());
    return times[1];
}

bool BudgetKeeper::note(double ms, double samples) {
    times_[static_cast<size_t>(pings_++ % window)] = ms;
    if (since_fall_ >= 0) ++since_fall_;
    if (pings_ < 2) return false;
    const double slow = slowButOne();
    if (slow > budget_ms_) {
        const bool again = since_fall_ >= 0 && since_fall_ < forgiven_after;
        patience_ = again ? std::min(2 * patience_, max_patience) : patience_after_fall;
        since_fall_ = 0;
        return moveTo(samples * std::max(fall_to * budget_ms_ / slow, 1 / max_change));
    }
    const double room = std::min(climb_to * budget_ms_ / slow, max_change);
    if (pings_ < patience_ || room < min_climb || samples * room <= limit_) return false;
    return moveTo(samples * room);
}

double PeriodMeter::period() const {
    if (count_ == 0) return 0;
    std::array<double, 16> seconds = seconds_;
    const auto count = static_cast<std::ptrdiff_t>(std::min(count_, seconds.size()));
    std::nth_element(seconds.begin(), seconds.begin() + count / 4, seconds.begin() + count);
    return seconds[static_cast<size_t>(count / 4)];
}

QualityKeeper::QualityKeeper(const SonarConfig& config, int turn)
    : config_(config),
      beams_(config.beams()),
      target_(config.targetError().value_or(0)),
      turn_(turn),
      ladder_(config),
      estimator_(config, target_ > 0 ? min_share * target_ : min_error) {
    model_.at = firstQuality(config);
    if (config.quality.budget_ms) budget_.emplace(*config.quality.budget_ms, model_.at.samples() * beams_);
}

double QualityKeeper::maxSamples() const {
    const double maximum = std::min(config_.maxSamples().value_or(infinity), budget_ ? budget_->limit() : infinity);
    return std::max(maximum / beams_, Quality().samples());
}

bool QualityKeeper::changeConfig(const SonarConfig& config) {
    const QualityLadder ladder(config);
    if (!chosen_ || !(config.quality == config_.quality) || upcoming().columns_per_beam > ladder.maxColumns())
        return false;
    config_ = config;
    beams_ = config.beams();
    ladder_ = ladder;
    estimator_ = ErrorEstimator(config, target_ > 0 ? min_share * target_ : min_error);
    steady_ = approaching_ = true;
    if (upcoming().samples() > maxSamples()) next_ = ladder_.choose(model_, target_share * target_, maxSamples());
    return true;
}

bool QualityKeeper::follow(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                           double period_ms) {
    const Quality before = model_.at;
    if (next_) {
        model_ = model_.movedTo(*std::exchange(next_, {}));
        change_ = -1;
        since_change_ = 0;
    }
    if (renderer.hasEchoes()) {
        ++pings_;
        ++since_change_;
        received_samples_ += model_.at.samples();
        if (!std::exchange(chosen_, true)) {
            choose(renderer, scene, ping, target_, {});
        } else {
            keepBudget(renderer, scene, ping, ms, period_ms);
            if (!next_ && approaching_)
                approach(renderer, scene, ping);
            else if (!next_ && isDue())
                watch(renderer, scene, ping);
            reportBudget(scene, ms);
        }
    }
    const Quality& next = upcoming();
    const SonarConfig& set = renderer.renderPlan().config;
    if (set.rows() != next.rows || set.columnsPerBeam() != next.columns_per_beam)
        renderer.setQuality(next.rows, next.columns_per_beam);
    return chosen_ && !(before == model_.at && before.error == model_.at.error);
}

bool QualityKeeper::mayChoose() const {
    const bool no_time = budget_ && model_.at.samples() > near_budget * budget_->limit() / beams_;
    return !no_time && choosing_ <= overhead * received_samples_ + pings_to_choose * model_.at.samples();
}

void QualityKeeper::choose(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double target,
                           const Quality& minimum) {
    const Quality before = model_.at;
    const double rendered = estimator_.rendered();
    take(climb(estimator_, ladder_, renderer, scene, model_.at, {target, maxSamples(), minimum}, ping), renderer, scene,
         ping);
    const bool is_first = pings_ == 1;
    if (!is_first) choosing_ += estimator_.rendered() - rendered;
    if (is_first || !(before == model_.at)) reportChoice(scene);
}

void QualityKeeper::take(const ErrorModel& measured, SonarRenderer& renderer, const types::Snapshot& scene,
                         const types::Sonar& ping) {
    model_ = measured;
    measured_ = model_.at.error;
    least_ = estimator_.least(ping);
    change_ = estimator_.changeToCoarser(renderer, scene, ping, model_.at);
    per_change_ = change_ > 0 ? measured_ / change_ : min_per_change;
    since_change_ = 0;
    worst_ = 0;
}

bool QualityKeeper::isDue() const {
    const auto watched = [](int64_t pings, double share) { return std::floor(static_cast<double>(pings) * share); };
    const bool no_time = budget_ && model_.at.samples() > near_budget * budget_->limit() / beams_;
    const bool is_first_turn = turn_ > 1 && pings_ <= turn_;
    if (no_time && change_ < 0 && since_change_ == settled) return true;
    if (is_first_turn && !no_time) return true;
    const double share = no_time ? watched_share / rarely : watched_share;
    return watched(pings_, share) != watched(pings_ - 1, share);
}

double QualityKeeper::computeError(double change) {
    if (change_ < 0) {  // the first look at a quality that was chosen for its time
        change_ = change;
        const double error = std::max(off_measure * per_change_ * change, min_error);
        model_ = model_.withError(error);
        measured_ = error;
    }
    const double fall = change < change_ ? change / change_ : 1, rise = std::max(0.0, change - change_);
    return measured_ * fall + std::max(per_change_, min_per_change) * rise;
}

void QualityKeeper::approach(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping) {
    approaching_ = false;
    change_ = -1;
    since_change_ = 0;
    worst_ = computeError(estimator_.changeToCoarser(renderer, scene, ping, model_.at));
    if (target_ > 0 && worst_ > off_target * target_) move(worst_, max_move * model_.at.samples(), model_.at);
    if (!next_ && std::max(model_.at.samples() / reported_.samples(), reported_.samples() / model_.at.samples()) >
                      worth_reporting)
        reportChoice(scene);
}

void QualityKeeper::move(double error, double max_samples, const Quality& minimum) {
    model_ = model_.withError(error);
    const Quality next = ladder_.choose(model_, target_share * target_, std::min(maxSamples(), max_samples), minimum);
    if (next == model_.at) return;
    next_ = next;
    approaching_ = true;
}

void QualityKeeper::watch(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping) {
    const double error = computeError(estimator_.changeToCoarser(renderer, scene, ping, model_.at));
    worst_ = std::max(worst_, error);
    const bool is_off = error > std::max(off_target * target_, off_prediction * measured_);
    if (is_off && steady_) return move(error, max_move * model_.at.samples(), model_.at);
    if (is_off && mayChoose()) {
        if (std::exchange(lowered_, false)) turns_ = std::min(more_patience * turns_, max_turns);
        return choose(renderer, scene, ping, target_, turn_ == 1 ? Quality() : model_.at);
    }
    model_.at.error = std::max(model_.at.error, error);
    if (since_change_ >= turns_ * std::max(turn_, min_pings)) settle(renderer, scene, ping, error);
}

void QualityKeeper::settle(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double error) {
    const double worst = std::exchange(worst_, 0);
    since_change_ = 0;
    model_.at.error = worst;
    const bool is_idle = worst <= well_within * target_ && worst <= has_fallen * measured_;
    if (is_idle && steady_) return move(std::max(worst, min_error), model_.at.samples());
    if (!is_idle || model_.at == Quality() || !mayChoose()) return;
    const double look = worst > 0 ? std::max(error / worst, min_look) : 1;
    choose(renderer, scene, ping, target_ * look, {});
    model_.at.error /= look;
    lowered_ = true;
}

void QualityKeeper::keepBudget(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                               double ms, double period_ms) {
    const QualityConfig& wanted = config_.quality;
    const bool by_period = period_ms > 0 && !wanted.target_error && !wanted.max_samples && !wanted.budget_ms;
    if (by_period && budget_) budget_->setBudget(period_ms);
    if (by_period && !budget_) budget_.emplace(period_ms);
    const double before = maxSamples();
    if (!budget_ || !budget_->note(ms, model_.at.samples() * beams_)) return;
    const bool rises = maxSamples() > before;
    if (rises && !steady_ && pings_to_measure * ms <= max_delay * budget_->budget()) {
        estimator_.begin();
        take(estimator_.measure(renderer, scene, ping, model_.at), renderer, scene, ping);
    }
    const Quality next = ladder_.choose(model_, target_share * target_, maxSamples(), rises ? model_.at : Quality());
    if (!(next == model_.at)) next_ = next;
}

void QualityKeeper::report(const types::Notice& notice) {
    if (notices_reported_ < max_notices) notices_.push_back(notice);
    if (++notices_reported_ == max_notices) notices_.push_back("further changes of the quality are not reported");
}

std::string QualityKeeper::text() const {
    const Quality& quality = model_.at;
    return fmt::format("quality: {} rows, {} columns per beam, {:.0f} samples per ping, predicted error {:.2g}",
                       quality.rows, quality.columns_per_beam, quality.samples() * beams_, quality.error);
}

std::string QualityKeeper::limitText() const {
    if (least_ > target_) return "a single bin is that much of the ping";
    if (ladder_.choose(model_, target_share * target_, infinity).samples() <= maxSamples())
        return "there is no finer quality";
    if (budget_ && budget_->limit() < config_.maxSamples().value_or(infinity))
        return fmt::format("the budget of {:.4g} ms allows no more", budget_->budget());
    return fmt::format("max_samples {:.0f} allows no more", config_.maxSamples().value_or(infinity));
}

void QualityKeeper::reportChoice(const types::Snapshot& scene) {
    const std::string when = notices_reported_ ? fmt::format("from {:.3f} s on ", scene.time.seconds()) : "";
    reported_ = model_.at;
    if (target_ == 0) return report(fmt::format("{}{}; budget {:g} ms", when, text(), *config_.quality.budget_ms));
    if (model_.at.error <= target_ || std::exchange(missed_, true))
        return report(fmt::format("{}{}, target {:g}", when, text(), target_));
    report(types::warning(fmt::format("{}{}, misses the target of {:g}: {}", when, text(), target_, limitText())));
}

void QualityKeeper::reportBudget(const types::Snapshot& scene, double ms) {
    if (!budget_) return;
    if (model_.at == Quality() && budget_->limit() < model_.at.samples() * beams_ &&
        !std::exchange(late_reported_, true))
        report(types::warning(
            fmt::format("the coarsest quality takes {:.3g} ms; the budget is {:.4g} ms", ms, budget_->budget())));
    const double ratio = model_.at.samples() / reported_.samples();
    if (since_change_ == settled && std::max(ratio, 1 / ratio) > worth_reporting) reportChoice(scene);
}

}  // namespace insonify::sonar
