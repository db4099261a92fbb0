#include "components/sonar/BudgetKeeper.hpp"

#include <algorithm>
#include <functional>

namespace insonify::sonar {
namespace {

constexpr int patience_after_fall = 20, max_patience = 320, forgiven_after = 400;
constexpr double fall_to = 0.9, climb_to = 0.97, max_change = 4, min_climb = 1.09;

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

}  // namespace insonify::sonar
