#include "components/sonar/Quality.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/SonarRenderer.hpp"

namespace insonify::sonar {
namespace {

constexpr int least_rows = 8, most_rows = 2048, most_columns = 256;
constexpr int patience = 20, late_of_patience = 2, early_in_a_row = 100;
constexpr double late_share = 0.85, early_share = 0.7;  ///< Of the budget: lowered before it is overrun.

/** Renders one scene at any quality. */
class Trial {
public:
    Trial(const SonarConfig& config, const types::Snapshot& scene)
        : config_(config), scene_(scene), renderer_(config_, scene.geometry) {}

    /** Rendered once for each quality: what one is compared with is often where the next begins. */
    const std::vector<float>& bins(int rows, int columns) {
        std::vector<float>& bins = rendered_[{rows, columns}];
        if (!bins.empty()) return bins;
        renderer_.setQuality(rows, columns);
        renderer_.render(scene_, ping_);
        return bins = ping_.bins;
    }
    double ms(int rows, int columns) {
        renderer_.setQuality(rows, columns);
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 4; ++i) {
            const auto start = std::chrono::steady_clock::now();
            renderer_.render(scene_, ping_);
            least = std::min(
                least, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
        return least;
    }
    /** Relative L2 of `coarse` against `fine`; 0 when nothing is heard. */
    double change(const std::vector<float>& coarse, const std::vector<float>& fine) const {
        double error = 0, norm = 0;
        const auto count = static_cast<size_t>(config_.bin_count);
        for (size_t i = 0; i < fine.size(); ++i) {
            const double range = static_cast<double>(i % count) + 0.5;
            const double weight =
                config_.model == Model::Physical ? std::pow(range / static_cast<double>(count), 5) : 1;
            error += std::pow(weight * (static_cast<double>(coarse[i]) - fine[i]), 2);
            norm += std::pow(weight * fine[i], 2);
        }
        return norm > 0 ? std::sqrt(error / norm) : 0;
    }

private:
    SonarConfig config_;
    const types::Snapshot& scene_;
    SonarRenderer renderer_;
    types::Sonar ping_;
    std::map<std::pair<int, int>, std::vector<float>> rendered_;
};

/** Whether a device can draw so many columns per beam. */
bool fits(SonarConfig config, int columns) {
    config.quality.columns_per_beam = columns;
    return makeSlabs(config, makeBeams(config)).front().columns <= most_image_size;
}

/** What more rows, columns, or both change. */
struct Changes {
    double of_rows, of_columns, of_both;
    double error() const { return std::max(std::hypot(of_rows, of_columns), of_both); }
};

/** Both together, because a small thing may need more of both before it is seen at all. What seems to be within
 * `target_error` is also tried with rows at factors that are not powers of 2: an edge along the rows may lie as wrong
 * at twice as many. */
Changes changesOf(Trial& trial, int rows, int columns, double target_error) {
    const auto change = [&](double taller, int wider) {
        const int more_rows = static_cast<int>(std::lround(taller * rows));
        return trial.change(trial.bins(rows, columns), trial.bins(more_rows, wider * columns));
    };
    Changes changes{change(2, 1), change(1, 2), change(2, 2)};
    if (changes.error() <= target_error) changes.of_rows = std::max({changes.of_rows, change(1.4, 1), change(2.7, 1)});
    return changes;
}

}  // namespace

std::vector<Quality> tryQualities(const SonarConfig& config, const types::Snapshot& scene, double target_error,
                                  double budget_ms) {
    Trial trial(config, scene);
    std::vector<Quality> ladder;
    for (int rows = least_rows, columns = 1;
         rows <= most_rows && columns <= most_columns && fits(config, 2 * columns);) {
        const Changes changes = changesOf(trial, rows, columns, target_error);
        const Quality quality{rows, columns, changes.error(), std::isfinite(budget_ms) ? trial.ms(rows, columns) : 0};
        if (!ladder.empty() && quality.ms > budget_ms) break;
        ladder.push_back(quality);
        if (quality.error <= target_error) break;
        (changes.of_rows >= changes.of_columns ? rows : columns) *= 2;
    }
    return ladder;
}

BudgetKeeper::BudgetKeeper(std::vector<Quality> ladder, double budget_ms)
    : ladder_(std::move(ladder)), budget_ms_(budget_ms), at_(ladder_.size() - 1) {}

bool BudgetKeeper::moveTo(size_t at) {
    pings_ = late_ = early_ = 0;
    if (at >= ladder_.size() || at == at_) return false;
    at_ = at;
    return true;
}

bool BudgetKeeper::heard(double ms) {
    const bool can_rise = at_ + 1 < ladder_.size();
    const double finer_ms = can_rise ? ms * ladder_[at_ + 1].ms / ladder_[at_].ms : budget_ms_;
    late_ += ms > late_share * budget_ms_;
    early_ = finer_ms < early_share * budget_ms_ ? early_ + 1 : 0;
    if (late_ >= late_of_patience) return moveTo(at_ > 0 ? at_ - 1 : 0);
    if (early_ >= early_in_a_row) return moveTo(at_ + 1);
    if (++pings_ == patience) pings_ = late_ = 0;
    return false;
}

}  // namespace insonify::sonar
