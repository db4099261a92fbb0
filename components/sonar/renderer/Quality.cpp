#include "components/sonar/renderer/Quality.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/sonar/beams/BeamFan.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr int max_rows = 2048, max_columns = 256, rungs_per_doubling = 8;
constexpr int max_steps = 12, max_lowerings = 3;
constexpr double step_of_samples = 4, worth_a_step = 0.95, worth_lowering = 0.8, worth_halving = 1.5;
constexpr double margin = 1.2, margin_of_means = 1.5;   ///< Predicted error over the measured difference [1].
constexpr double max_margin = 2, margin_of_lag = 1.15;  ///< Where finer pings change in the same direction [1].
constexpr double first_column_deg = 1.5;                ///< Widest column of a search's first ping [deg].
constexpr double min_part = 0.2;                        ///< Smallest part of rows or columns in an error [1].

/** Returns whether a device can rasterise this number of columns per beam. */
bool fits(SonarConfig config, int columns) {
    config.quality.columns_per_beam = columns;
    if (config.tracesRays()) return true;
    return makeFrusta(config, makeBeams(config)).front().columns <= max_image_size;
}

int fewerRows(int rows) { return std::max(1, static_cast<int>(std::lround(0.6 * rows))); }
int fewerColumns(int columns) { return std::max(1, (columns + 1) / 2); }

/** Returns up to `wanted` columns, as many as can be rasterised, and at least `columns`. */
int moreColumns(const SonarConfig& config, int columns, int wanted) {
    while (wanted > columns && !fits(config, wanted)) --wanted;
    return std::max(wanted, columns);
}

}  // namespace

Quality firstQuality(const SonarConfig& config) {
    const Quality least;
    double widest = 0;
    for (const Beam& beam : makeBeams(config)) widest = std::max(widest, beam.high - beam.low);
    const double allowed = config.maxSamples().value_or(std::numeric_limits<double>::infinity()) / config.beams();
    const double columns = std::min(widest / types::radians(first_column_deg), allowed / least.rows);
    return {least.rows,
            moreColumns(config, least.columns_per_beam, static_cast<int>(std::min(columns, double{max_columns})))};
}

double ErrorModel::error(int rows, int columns_per_beam) const {
    return std::hypot(of_rows * at.rows / rows, of_columns * at.columns_per_beam / columns_per_beam);
}

ErrorModel ErrorModel::movedTo(const Quality& other) const {
    const auto& [rows, columns, unused] = other;
    return {
        {rows, columns, error(rows, columns)}, of_rows * at.rows / rows, of_columns * at.columns_per_beam / columns};
}

ErrorModel ErrorModel::scaled(double factor) const {
    return {{at.rows, at.columns_per_beam, at.error * factor}, of_rows * factor, of_columns * factor};
}

ErrorModel ErrorModel::withError(double error) const {
    const double own = std::hypot(of_rows, of_columns);
    ErrorModel model = own > 0 ? scaled(error / own) : ErrorModel{at, error / std::sqrt(2), error / std::sqrt(2)};
    model.at.error = error;
    return model;
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

ErrorEstimator::ErrorEstimator(const SonarConfig& config, double least) : config_(config), least_(least) {
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

double ErrorEstimator::lag(const std::vector<float>& coarse, const std::vector<float>& finer,
                           const std::vector<float>& finest) const {
    double along = 0, norm = 0;
    for (size_t beam = 0; beam < finest.size(); beam += weights_.size())
        for (size_t i = 0; i < weights_.size(); ++i) {
            const double to_finest = double{finest[beam + i]} - coarse[beam + i];
            along += weights_[i] * to_finest * (double{finest[beam + i]} - finer[beam + i]);
            norm += weights_[i] * to_finest * to_finest;
        }
    return norm > 0 ? std::max(along / norm, 0.0) : 0;
}

void ErrorEstimator::render(SonarRenderer& renderer, const types::Snapshot& scene, int rows, int columns_per_beam,
                            types::Sonar& ping) {
    renderer.setQuality(rows, columns_per_beam);
    renderer.render(scene, ping);
    rendered_ += Quality{rows, columns_per_beam}.samples();
}

double ErrorEstimator::changeToCoarser(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                                       const Quality& quality) {
    render(renderer, scene, fewerRows(quality.rows), fewerColumns(quality.columns_per_beam), other_);
    return change(other_.bins, ping.bins);
}

ErrorModel ErrorEstimator::measure(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                                   const Quality& quality) {
    const auto& [rows, columns, unused] = quality;
    const auto finer = [&](double by_rows, int by_columns, types::Sonar& other) {
        const int more = moreColumns(config_, columns, by_columns * columns);
        render(renderer, scene, static_cast<int>(std::lround(by_rows * rows)), more, other);
        return static_cast<double>(more) / columns;
    };
    finer(2.2, 2, other_);
    const double to_finer = change(ping.bins, other_.bins);
    finer(3, 3, finest_);
    const double to_finest = change(ping.bins, finest_.bins), lagging = lag(ping.bins, other_.bins, finest_.bins);
    const double ratio = finer(1, 2, other_), of_rows = std::min(change(other_.bins, finest_.bins), to_finest);
    const bool is_below = 3 * rows <= finest_yet_.rows && 3 * columns <= finest_yet_.columns_per_beam;
    const double to_reference = is_below ? change(ping.bins, reference_.bins) : 0;
    if (Quality{3 * rows, 3 * columns}.samples() > finest_yet_.samples()) {
        reference_.bins = finest_.bins;
        finest_yet_ = {3 * rows, 3 * columns};
    }
    double measured = std::max({to_finer, to_finest, to_reference}),
           of_columns = std::sqrt(to_finest * to_finest - of_rows * of_rows);
    if (ratio < 2) {  // these columns are the last that can be rasterised
        measured = std::hypot(measured, changeToCoarser(renderer, scene, ping, quality));
        of_columns = to_finest;
    }
    const double least = std::max(min_part * to_finest, 1e-12);
    ErrorModel model{quality, std::max(of_rows, least), std::max(of_columns, least)};
    const double min_margin = config_.model == Model::Physical ? margin : margin_of_means;
    measured *= std::clamp(margin_of_lag * (1 + 2 * lagging), min_margin, max_margin);
    model = model.scaled(measured / std::hypot(model.of_rows, model.of_columns));
    model.at.error = measured;
    return model;
}

double ErrorEstimator::least(const types::Sonar& ping) const {
    if (config_.model == Model::Physical) return least_;
    double norm = 0, brightest = 0;
    for (const float value : ping.bins) {
        norm += double{value} * value;
        brightest = std::max(brightest, double{value});
    }
    return norm > 0 ? std::max(least_, brightest / std::sqrt(norm)) : least_;
}

namespace {

/** The qualities that a search has measured. */
class Search {
public:
    Search(const QualityLadder& ladder, const QualityGoal& goal) : ladder_(ladder), goal_(goal) {}

    bool hasReached(const ErrorModel& model) const { return model.at.error <= goal_.target; }
    /** Adds a measured quality. One that is coarser in rows and columns has at least the error of a finer one. */
    void add(ErrorModel model) {
        const auto isCoarser = [](const Quality& a, const Quality& b) {
            return a.rows <= b.rows && a.columns_per_beam <= b.columns_per_beam;
        };
        for (ErrorModel& other : measured_) {
            if (isCoarser(other.at, model.at)) other.at.error = std::max(other.at.error, model.at.error);
            if (isCoarser(model.at, other.at)) model.at.error = std::max(other.at.error, model.at.error);
        }
        measured_.push_back(model);
    }
    /** Returns the quality with the fewest samples that reaches the target, else that with the most. */
    const ErrorModel& best() const {
        return *std::ranges::min_element(measured_, [&](const ErrorModel& a, const ErrorModel& b) {
            if (hasReached(a) != hasReached(b)) return hasReached(a);
            return hasReached(a) ? a.at.samples() < b.at.samples() : a.at.samples() > b.at.samples();
        });
    }
    /** Returns the next quality to measure; none: the search is over. */
    std::optional<Quality> next() const {
        const bool has_reached = hasReached(best());
        const ErrorModel& from = has_reached ? best() : measured_.back();
        const auto since = std::ranges::find_if(measured_, [&](const ErrorModel& m) { return hasReached(m); });
        if (has_reached && measured_.end() - since > max_lowerings) return {};
        const Quality other = has_reached ? coarser(from) : finer(from);
        return isNew(other) && static_cast<int>(measured_.size()) < max_steps ? std::optional(other) : std::nullopt;
    }

private:
    bool isNew(const Quality& quality) const {
        return std::ranges::none_of(measured_, [&](const ErrorModel& model) { return model.at == quality; });
    }
    /** Goes where the parts of the error lead, or to finer rows and columns alike where they led nowhere. */
    Quality finer(const ErrorModel& from) const {
        const double limit = std::min(goal_.max_samples, step_of_samples * from.at.samples());
        const auto choose = [&](const ErrorModel& model) {
            const Quality other = ladder_.choose(model, target_share * goal_.target, limit, goal_.minimum);
            return other.error <= worth_a_step * from.at.error && other.samples() <= limit ? other : from.at;
        };
        const ErrorModel balanced{from.at, from.at.error / std::sqrt(2), from.at.error / std::sqrt(2)};
        const bool led_nowhere =
            measured_.size() > 1 && from.at.error > worth_lowering * measured_[measured_.size() - 2].at.error;
        const Quality other = choose(led_nowhere ? balanced : from);
        return other == from.at ? choose(balanced) : other;
    }
    /** Lets the error grow as fast as it fell since the qualities that had not reached the target, or goes halfway to
     *  these. */
    Quality coarser(const ErrorModel& from) const {
        double target = target_share * goal_.target;
        for (const ErrorModel& failed : measured_) {
            const double predicted = from.error(failed.at.rows, failed.at.columns_per_beam) / from.at.error;
            if (hasReached(failed) || predicted <= 1 || target <= from.at.error) continue;
            const double power = std::clamp(std::log(failed.at.error / from.at.error) / std::log(predicted), 1.0, 4.0);
            target = std::min(target, from.at.error * std::pow(target_share * goal_.target / from.at.error, 1 / power));
        }
        const Quality other = ladder_.choose(from, target, worth_lowering * from.at.samples(), goal_.minimum);
        if (other.error <= target && isNew(other)) return other;
        double below = 0;
        for (const ErrorModel& failed : measured_)
            if (!hasReached(failed) && failed.at.samples() < from.at.samples())
                below = std::max(below, failed.at.samples());
        if (below == 0 || from.at.samples() <= worth_halving * below) return from.at;
        return ladder_.choose(from, 0, std::sqrt(below * from.at.samples()), goal_.minimum);
    }

    const QualityLadder& ladder_;
    QualityGoal goal_;
    std::vector<ErrorModel> measured_;
};

}  // namespace

ErrorModel climb(ErrorEstimator& estimator, const QualityLadder& ladder, SonarRenderer& renderer,
                 const types::Snapshot& scene, const Quality& start, const QualityGoal& goal, types::Sonar& ping) {
    const auto render = [&](const Quality& quality) {
        renderer.setQuality(quality.rows, quality.columns_per_beam);
        renderer.render(scene, ping);
    };
    Search search(ladder, goal);
    estimator.begin();
    search.add(estimator.measure(renderer, scene, ping, start));
    Quality rendered = start;
    while (const auto next = search.next()) {
        rendered = *next;
        render(rendered);
        search.add(estimator.measure(renderer, scene, ping, rendered));
    }
    ErrorModel best = search.best();
    if (!(best.at == rendered)) render(best.at);
    if (best.at.error > 0) best = best.scaled(std::max(1.0, estimator.least(ping) / best.at.error));
    return best;
}

Quality chooseQuality(const SonarConfig& config, const types::Snapshot& scene) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double target = config.targetError().value_or(0);
    SonarRenderer renderer(config, scene.geometry);
    ErrorEstimator estimator(config, target > 0 ? min_share * target : min_error);
    types::Sonar ping;
    const Quality start = firstQuality(config);
    renderer.setQuality(start.rows, start.columns_per_beam);
    renderer.render(scene, ping);
    const QualityGoal goal{target, config.maxSamples().value_or(infinity) / config.beams()};
    return climb(estimator, QualityLadder(config), renderer, scene, start, goal, ping).at;
}

}  // namespace insonify::sonar
