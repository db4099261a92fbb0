#include "components/sonar/quality/QualityKeeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace insonify::sonar {
namespace {

constexpr int patience_after_fall = 20, max_patience = 320, forgiven_after = 400;
constexpr double fall_to = 0.9, climb_to = 0.97, max_change = 4, min_climb = 1.09;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double watched_share = 0.2618034;  ///< Share of the pings; irrational, to cover all bearings of a head.
constexpr double first_turn_share = 0.5;     ///< The same in the first turn of a head.
constexpr int rarely = 16;  ///< One of this number of due pings is evaluated where the budget is used up.
constexpr double off_target = 1.2, off_prediction = 1.5, well_within = 0.5, worth_lowering = 0.7, near_limit = 0.8;
constexpr double overhead = 0.15, pings_to_choose = 10;  ///< Max total cost of estimates [share of the pings, pings].
constexpr int min_pings = 64, settled = 20, max_notices = 20;
constexpr double worth_reporting = 1.2, too_far_from_model = 4;

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
      estimator_(config) {
    if (config.quality.budget_ms) budget_.emplace(*config.quality.budget_ms, Quality().samples() * beams_);
}

double QualityKeeper::maxSamples() const {
    const double maximum = std::min(config_.maxSamples().value_or(infinity), budget_ ? budget_->limit() : infinity);
    return std::max(maximum / beams_, Quality().samples());
}

bool QualityKeeper::follow(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                           double period_ms) {
    if (!renderer.hasEchoes()) return false;
    ++pings_;
    ++since_change_;
    received_samples_ += model_.at.samples();
    if (!std::exchange(chosen_, true)) {
        choose(renderer, scene, ping);
        return true;
    }
    const bool limited = keepBudget(renderer, scene, ping, ms, period_ms);
    const bool watched = !limited && isDue() && watch(renderer, scene, ping);
    reportBudget(scene, ms);
    return limited || watched;
}

void QualityKeeper::choose(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping) {
    const Quality before = model_.at;
    const bool is_first = pings_ == 1, sees_all = turn_ == 1;
    model_ = climb(estimator_, ladder_, renderer, scene, before, {target_, maxSamples(), is_first || sees_all}, ping);
    const Quality enough = ladder_.choose(model_, target_share * target_, maxSamples(), before);
    if (enough.samples() <= worth_lowering * model_.at.samples()) moveTo(renderer, enough);
    modelled_ = model_.at.samples();
    since_change_ = 0;
    worst_ = 0;
    reportChoice(scene);
}

void QualityKeeper::moveTo(SonarRenderer& renderer, const Quality& quality) {
    model_ = {quality, model_.of_rows * model_.at.rows / quality.rows,
              model_.of_columns * model_.at.columns_per_beam / quality.columns_per_beam};
    renderer.setQuality(quality.rows, quality.columns_per_beam);
}

bool QualityKeeper::isDue() {
    const auto watched = [](int64_t pings, double share) { return std::floor(static_cast<double>(pings) * share); };
    if (estimator_.rendered() > overhead * received_samples_ + pings_to_choose * model_.at.samples()) return false;
    const bool no_time = budget_ && model_.at.samples() > near_limit * budget_->limit() / beams_;
    const bool is_first_turn = turn_ > 1 && pings_ <= turn_;
    const double share = no_time ? watched_share / rarely : is_first_turn ? first_turn_share : watched_share;
    return watched(pings_, share) != watched(pings_ - 1, share);
}

bool QualityKeeper::watch(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping) {
    const double error = estimator_.error(renderer, scene, ping, model_.at);
    worst_ = std::max(worst_, error);
    if (error > std::max(off_target * target_, off_prediction * model_.at.error)) {
        choose(renderer, scene, ping);
        return true;
    }
    return since_change_ >= std::max(turn_, min_pings) && lower(renderer, scene, ping);
}

bool QualityKeeper::lower(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping) {
    const double worst = std::exchange(worst_, 0);
    since_change_ = 0;
    if (worst > well_within * target_ || model_.at == Quality()) return false;
    ErrorModel model = estimator_.model(renderer, scene, ping, model_.at);
    const double scale = model.error() > 0 ? std::max(1.0, worst / model.error()) : 1;
    model.of_rows *= scale;
    model.of_columns *= scale;
    const Quality enough = ladder_.choose(model, target_share * target_, maxSamples());
    if (enough.samples() > worth_lowering * model_.at.samples()) return false;
    model_ = model;
    moveTo(renderer, enough);
    reportChoice(scene);
    return true;
}

bool QualityKeeper::keepBudget(SonarRenderer& renderer, const types::Snapshot& scene, types::Sonar& ping, double ms,
                               double period_ms) {
    const QualityConfig& wanted = config_.quality;
    const bool by_period = period_ms > 0 && !wanted.target_error && !wanted.max_samples && !wanted.budget_ms;
    if (by_period && budget_) budget_->setBudget(period_ms);
    if (by_period && !budget_) budget_.emplace(period_ms);
    const double before = maxSamples();
    if (!budget_ || !budget_->note(ms, model_.at.samples() * beams_)) return false;
    const bool rises = maxSamples() > before;
    if (rises && maxSamples() > too_far_from_model * modelled_) {
        choose(renderer, scene, ping);
        return true;
    }
    const Quality next = ladder_.choose(model_, target_share * target_, maxSamples(), rises ? model_.at : Quality());
    if (next == model_.at) return false;
    moveTo(renderer, next);
    since_change_ = 0;
    return true;
}

void QualityKeeper::report(const std::string& notice) {
    if (notices_reported_ < max_notices) notices_.push_back(notice);
    if (++notices_reported_ == max_notices) notices_.push_back("further changes of the quality are not reported");
}

std::string QualityKeeper::text() const {
    const Quality& quality = model_.at;
    return fmt::format("quality: {} rows, {} columns per beam, {:.0f} samples per ping, predicted error {:.2g}",
                       quality.rows, quality.columns_per_beam, quality.samples() * beams_, quality.error);
}

std::string QualityKeeper::limitText() const {
    if (budget_ && budget_->limit() < config_.maxSamples().value_or(infinity))
        return fmt::format("the budget of {:.4g} ms allows no more", budget_->budget());
    return config_.maxSamples() ? fmt::format("max_samples {:.0f} allows no more", *config_.maxSamples())
                                : "there is no finer quality";
}

void QualityKeeper::reportChoice(const types::Snapshot& scene) {
    const std::string when = notices_reported_ ? fmt::format("from {:.3f} s on ", scene.time.seconds()) : "";
    reported_ = model_.at;
    if (target_ == 0) return report(fmt::format("{}{}; budget {:g} ms", when, text(), *config_.quality.budget_ms));
    if (model_.at.error <= target_ || std::exchange(missed_, true))
        return report(fmt::format("{}{}, target {:g}", when, text(), target_));
    report(fmt::format("Warning: {}{}, misses the target of {:g}: {}", when, text(), target_, limitText()));
}

void QualityKeeper::reportBudget(const types::Snapshot& scene, double ms) {
    if (!budget_) return;
    if (model_.at == Quality() && budget_->limit() < model_.at.samples() * beams_ &&
        !std::exchange(late_reported_, true))
        report(fmt::format("Warning: the coarsest quality takes {:.3g} ms; the budget is {:.4g} ms", ms,
                           budget_->budget()));
    const double ratio = model_.at.samples() / reported_.samples();
    if (since_change_ == settled && std::max(ratio, 1 / ratio) > worth_reporting) reportChoice(scene);
}

}  // namespace insonify::sonar
