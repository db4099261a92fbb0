#include "components/sonar/quality/Quality.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/fan/BeamFan.hpp"

namespace insonify::sonar {
namespace {

constexpr int max_rows = 2048, max_columns = 256, rungs_per_doubling = 8;
constexpr double step_of_samples = 4, worth_a_trade = 0.85;

/** Returns whether a device can rasterise this number of columns per beam. */
bool fits(SonarConfig config, int columns) {
    config.quality.columns_per_beam = columns;
    if (config.tracesRays()) return true;
    return makeFrusta(config, makeBeams(config)).front().columns <= max_image_size;
}

/** Returns the error of the finer of two pings relative to their difference; the spacing of the samples differs by
 *  `ratio` < 1. */
double shareOfFiner(double ratio) { return 1 / std::sqrt(1 + 1 / (ratio * ratio)); }

int fewerRows(int rows) { return std::max(1, static_cast<int>(std::lround(0.6 * rows))); }
int fewerColumns(int columns) { return std::max(1, (columns + 1) / 2); }

double rowShare(const Quality& q) { return shareOfFiner(static_cast<double>(fewerRows(q.rows)) / q.rows); }
double columnShare(const Quality& q) {
    return shareOfFiner(static_cast<double>(fewerColumns(q.columns_per_beam)) / q.columns_per_beam);
}

}  // namespace

double ErrorModel::error(int rows, int columns_per_beam) const {
    return std::hypot(of_rows * at.rows / rows, of_columns * at.columns_per_beam / columns_per_beam);
}

QualityLadder::QualityLadder(const SonarConfig& config) {
    const Quality minimum;
    for (int i = 0; rows_.empty() || rows_.back() < max_rows; ++i)
        rows_.push_back(
            static_cast<int>(std::lround(minimum.rows * std::exp2(i / static_cast<double>(rungs_per_doubling)))));
    for (int columns = minimum.columns_per_beam; columns <= max_columns; columns *= 2)
        for (const int each : {columns, columns + columns / 2})
            if (each <= max_columns && (columns_.empty() || fits(config, each))) columns_.push_back(each);
}

Quality QualityLadder::choose(const ErrorModel& model, double target, double max_samples,
                              const Quality& minimum) const {
    Quality best = minimum;
    best.error = model.error(minimum.rows, minimum.columns_per_beam);
    const auto better = [&](const Quality& quality) {
        if (best.error > target) return quality.error < best.error;
        return quality.error <= target && quality.samples() < best.samples();
    };
    for (const int columns : columns_)
        for (const int rows : rows_) {
            const Quality quality{rows, columns, model.error(rows, columns)};
            if (rows < minimum.rows || columns < minimum.columns_per_beam || quality.samples() > max_samples) continue;
            if (better(quality)) best = quality;
        }
    return best;
}

ErrorEstimator::ErrorEstimator(const SonarConfig& config) {
    const double count = config.bin_count;
    for (int i = 0; i < config.bin_count; ++i)
        weights_.push_back(config.model == Model::Physical ? std::pow((i + 0.5) / count, 10) : 1);
}

double ErrorEstimator::change(const std::vector<float>& coarse, const std::vector<float>& fine) const {
    double error = 0, norm = 0;
    for (size_t beam = 0; beam < fine.size(); beam += weights_.size())
        for (size_t i = 0; i < weights_.size(); ++i) {
            const double value = fine[beam + i], difference = value - coarse[beam + i];
            error += weights_[i] * difference * difference;
            norm += weights_[i] * value * value;
        }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

double ErrorEstimator::changeBy(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                                int rows, int columns_per_beam) {
    renderer.setQuality(rows, columns_per_beam);
    renderer.render(scene, coarse_);
    rendered_ += Quality{rows, columns_per_beam}.samples();
    return change(coarse_.bins, ping.bins);
}

ErrorModel ErrorEstimator::model(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                                 const Quality& quality) {
    const auto& [rows, columns, unused] = quality;
    ErrorModel model{quality, rowShare(quality) * changeBy(renderer, scene, ping, fewerRows(rows), columns),
                     columnShare(quality) * changeBy(renderer, scene, ping, rows, fewerColumns(columns))};
    model.at.error = model.error();
    renderer.setQuality(rows, columns);
    return model;
}

double ErrorEstimator::error(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                             const Quality& quality) {
    const auto& [rows, columns, unused] = quality;
    const double changed = changeBy(renderer, scene, ping, fewerRows(rows), fewerColumns(columns));
    renderer.setQuality(rows, columns);
    return std::max(rowShare(quality), columnShare(quality)) * changed;
}

ErrorModel climb(ErrorEstimator& estimator, const QualityLadder& ladder, SonarRenderer& renderer,
                 const types::Snapshot& scene, const Quality& start, const QualityGoal& goal, types::Sonar& ping) {
    const auto goTo = [&](const Quality& next) {
        renderer.setQuality(next.rows, next.columns_per_beam);
        renderer.render(scene, ping);
        return estimator.model(renderer, scene, ping, next);
    };
    ErrorModel model = estimator.model(renderer, scene, ping, start);
    while (model.error() > goal.target) {
        const double samples = std::min(goal.max_samples, step_of_samples * model.at.samples());
        const Quality finer = ladder.choose(model, target_share * goal.target, samples, model.at);
        const Quality other = ladder.choose(model, target_share * goal.target, samples);
        if (!(finer == model.at))
            model = goTo(finer);
        else if (goal.trades && other.error < worth_a_trade * model.error())
            return goTo(other);
        else
            break;
    }
    return model;
}

Quality chooseQuality(const SonarConfig& config, const types::Snapshot& scene) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    SonarRenderer renderer(config, scene.geometry);
    ErrorEstimator estimator(config);
    types::Sonar ping;
    const Quality start;
    renderer.setQuality(start.rows, start.columns_per_beam);
    renderer.render(scene, ping);
    const QualityGoal goal{config.targetError().value_or(0), config.maxSamples().value_or(infinity) / config.beams()};
    return climb(estimator, QualityLadder(config), renderer, scene, start, goal, ping).at;
}

}  // namespace insonify::sonar
