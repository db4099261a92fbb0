#include "components/study/fit/FitLevels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/optim.hpp>

#include "components/receiver/Receiver.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

constexpr size_t first_slice = 3;  ///< Nearer, transmitters ring, and the gain changes within a slice.
constexpr double huber_db = 3;     ///< Residuals beyond this count by their size, not their square.
constexpr double uncut_deg = 110;  ///< Aperture of a side-scan's beam, which is limited only by its pattern [deg].
constexpr double elevation_before = 15;  ///< Width of an unknown beam in elevation [deg].

double medianLevel(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<long>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/** Wraps a function for OpenCV's minimiser. */
class Cost final : public cv::MinProblemSolver::Function {
public:
    Cost(int dimensions, std::function<double(const double*)> cost) : dimensions_(dimensions), cost_(std::move(cost)) {}
    int getDims() const override { return dimensions_; }
    double calc(const double* x) const override { return cost_(x); }

private:
    int dimensions_;
    std::function<double(const double*)> cost_;
};

/** Finds the minimum from `x` on with the given first steps. Restarts there with halved steps in each round. */
std::vector<double> minimum(std::vector<double> x, const std::vector<double>& steps, int evaluations, int rounds,
                            const std::function<double(const double*)>& cost) {
    const int n = static_cast<int>(x.size());
    for (int round = 0; round < rounds; ++round) {
        const auto solver = cv::DownhillSolver::create(cv::makePtr<Cost>(n, cost));
        cv::Mat at(1, n, CV_64F, x.data()), step(1, n, CV_64F);
        for (int i = 0; i < n; ++i) step.at<double>(0, i) = steps[static_cast<size_t>(i)] / (1 << round);
        solver->setInitStep(step);
        solver->setTermCriteria(
            cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, evaluations, 1e-7));
        solver->minimize(at);
        for (int i = 0; i < n; ++i) x[static_cast<size_t>(i)] = at.at<double>(0, i);
    }
    return x;
}

/** Returns the chain with a subset of the beams, whose median is that of all. */
FitChain thinned(FitChain chain) {
    if (chain.isSideScan()) return chain;
    constexpr size_t few = 32;
    const std::vector<double> all = std::move(chain.sonar.bearings_deg);
    const size_t step = std::max<size_t>(1, all.size() / few);
    chain.sonar.bearings_deg.clear();
    for (size_t i = step / 2; i < all.size(); i += step) chain.sonar.bearings_deg.push_back(all[i]);
    return chain;
}

/** Parameters that may be fitted: levels, then the sonar's attitude over the scene. */
enum Parameter : size_t {
    full_scale,
    noise_level,
    log_coefficient,
    tvg_slope,
    absorption,
    water_strength,
    pitch,
    height,
    elevation,
    parameters
};
using Values = std::array<double, parameters>;
using Chosen = std::vector<size_t>;  ///< Parameters.

constexpr double water_deviation = 15;  ///< Deviation of a volume backscattering strength before the fit [dB].

/** Models the levels of the blocks, and compares them with the recorded levels. */
class LevelModel {
public:
    LevelModel(const LevelBlocks& recorded, const CodedPing& law, const FitChain& chain, const LevelOptions& options)
        : recorded_(recorded),
          water_recorded_(options.water),
          response_(law),
          chain_(chain),
          rough_(options.rough),
          by_median_(options.rough && !chain.isSideScan()),  // lines know their altitudes
          fits_water_(options.rough && chain.isSideScan() && !chain.sonar.volume.empty()),
          fits_scene_(options.rough && options.fits_scene),
          range_(recorded.ranges.back()) {
        const receiver::TvgConfig tvg = chain.receiver.tvg.value_or(receiver::TvgConfig{});
        before_ = {chain.code().full_scale_db - chain.receiver.gain_db,
                   -100,
                   tvg.log_coefficient,
                   tvg.db_per_m,
                   sonar::makeAbsorption(chain.sonar).db_per_m,
                   chain.sonar.volume.empty() ? -200 : chain.sonar.volume.front().strength_db.value_or(-200),
                   0,
                   0,
                   std::log(elevation_before)};
        if (fits_water_) chain_.sonar.volume.clear();
        render(chain_);
        findLoudBlocks();
        if (by_median_) recorded_level_ = overBeams(recorded);
    }
    Chosen levels() const {
        Chosen all{full_scale, noise_level, log_coefficient, tvg_slope, absorption};
        if (fits_water_) all.push_back(water_strength);
        return all;
    }
    /** Returns the fitted attitude parameters. */
    Chosen looks() const {
        if (!fits_scene_) return {};
        return chain_.isSideScan() ? Chosen{pitch, elevation} : Chosen{pitch, height, elevation};
    }

    /** Returns initial values: full scale and noise from the loudest and faintest slices. */
    Values start() const {
        Values values = before_;
        const std::vector<double> recorded = overBeams(recorded_), echoes = overBeams(echoes_);
        const auto loudest =
            static_cast<size_t>(std::max_element(recorded.begin() + first_slice, recorded.end()) - recorded.begin());
        const double echo = *std::max_element(echoes.begin() + first_slice, echoes.end());
        values[full_scale] = echo + gainDb(values, recorded_.ranges[loudest]) - recorded[loudest];
        std::vector<double> floors;
        for (size_t i = 0; i < recorded.size(); ++i)
            floors.push_back(recorded[i] + values[full_scale] - gainDb(values, recorded_.ranges[i]));
        std::ranges::sort(floors);
        values[noise_level] = floors[floors.size() / 16];
        return values;
    }
    /** Returns initial values that explain the faintest ranges by the water, with noise far below. */
    Values startInWater() const {
        Values values = start();
        const std::vector<double> recorded = overBeams(recorded_), echoes = overBeams(echoes_),
                                  water = overBeams(water_);
        values[log_coefficient] = 20;
        std::vector<double> strengths;
        for (size_t i = first_slice; i < recorded.size(); ++i)
            strengths.push_back(recorded[i] + values[full_scale] - gainDb(values, recorded_.ranges[i]) - water[i]);
        std::ranges::sort(strengths);
        values[water_strength] = strengths[strengths.size() / 16];
        values[noise_level] -= 25;
        return values;
    }
    bool fitsWater() const { return fits_water_; }
    /** Returns the first steps of the simplex. */
    Values steps() const { return {6, 6, 10, 10 / range_, 5 / range_, 6, 8, -0.1 * range_, 0.4}; }

    /** Renders the scene for these values, if its attitude is fitted. */
    void look(const Values& values) {
        if (fits_scene_) render(seen(values));
    }
    FitChain seen(const Values& values) const {
        FitChain chain = chain_;
        if (chain.isSideScan()) {
            lookAcross(values[pitch], std::exp(values[elevation]), chain);
            return chain;
        }
        chain.snapshot.sonar = moved(chain.snapshot.sonar, types::radians(values[pitch]), values[height]);
        setElevation(std::exp(values[elevation]), chain);
        return chain;
    }
    /** Turns the beams of a side-scan down and sets their width across the track. */
    static void lookAcross(double down_deg, double width_deg, FitChain& chain) {
        for (double& bearing : chain.sonar.bearings_deg)
            bearing = std::copysign(std::clamp(std::abs(bearing) - down_deg, 5.0, 89.0), bearing);
        if (!chain.sonar.beam_pattern) chain.sonar.beam_pattern.emplace();
        acoustics::BeamLaw& law = chain.sonar.beam_pattern->receive.azimuth.emplace();
        law.weighting = acoustics::Weighting::Gaussian;
        law.width_deg = std::min(width_deg, 170.0);
        chain.sonar.beam_width_deg = std::max(*chain.sonar.beam_width_deg, uncut_deg);
    }
    static void setElevation(double width_deg, FitChain& chain) {
        sonar::BeamPatternConfig& pattern =
            chain.sonar.beam_pattern ? *chain.sonar.beam_pattern : chain.sonar.beam_pattern.emplace();
        acoustics::BeamLaw& law =
            pattern.transmit.elevation ? *pattern.transmit.elevation : pattern.transmit.elevation.emplace();
        if (!law.weighting) law.weighting = acoustics::Weighting::Gaussian;
        law.aperture_m.reset();
        law.width_deg = width_deg;
        chain.sonar.beam_height_deg = std::max(chain.sonar.beam_height_deg, std::min(90.0, 4 * width_deg));
    }

    double gainDb(const Values& values, double range) const {
        receiver::TvgConfig tvg = chain_.receiver.tvg.value_or(receiver::TvgConfig{});
        tvg.log_coefficient = values[log_coefficient];
        tvg.db_per_m = values[tvg_slope];
        return receiver::tvgDb(tvg, axis_ * range);
    }

    /** Returns the level that the codes of a block state, relative to the max code [dB]. */
    double stated(const Values& values, size_t block, size_t slice) const {
        const double r = recorded_.ranges[slice];
        double echo = toPower(echoes_.at(block, slice));
        if (fits_water_) echo += toPower(water_.at(block, slice) + values[water_strength]);
        const double both = toDb(echo * toPower(-2 * values[absorption] * r) + toPower(values[noise_level]));
        return response_(both + gainDb(values, r) - values[full_scale]);
    }

    LevelBlocks modelled(const Values& values) const {
        LevelBlocks blocks = recorded_;
        for (size_t block = 0; block < blocks.beam_blocks; ++block)
            for (size_t slice = 0; slice < blocks.slices; ++slice)
                blocks.level[block * blocks.slices + slice] = stated(values, block, slice);
        return blocks;
    }

    /** Returns recorded minus modelled levels [dB]. */
    std::vector<double> residuals(const Values& values) const {
        std::vector<double> all;
        for (size_t slice = first_slice; slice < recorded_.slices; ++slice) {
            std::vector<double> across;
            for (size_t block = 0; block < recorded_.beam_blocks; ++block) {
                across.push_back(stated(values, block, slice));
                if (!by_median_) all.push_back(computeOff(block, slice, across.back()));
            }
            if (by_median_) all.push_back(recorded_level_[slice] - medianLevel(across));
        }
        return all;
    }
    /** Returns the deviations from the priors, in standard deviations. */
    std::vector<double> pulls(const Values& values) const {
        std::vector<double> all{(values[log_coefficient] - before_[log_coefficient]) / 30,
                                (values[tvg_slope] - before_[tvg_slope]) * 2 * range_ / 60,
                                (values[absorption] - before_[absorption]) * 2 * range_ / (rough_ ? 2 : 3)};
        if (fits_water_) all.push_back((values[water_strength] - before_[water_strength]) / water_deviation);
        if (fits_scene_) {
            all.push_back(values[pitch] / 20);
            all.push_back(values[height] / (0.5 * range_));
            all.push_back(values[elevation] - std::log(elevation_before));
        }
        return all;
    }
    double cost(const Values& values) const {
        double sum = 0;
        for (const double r : residuals(values)) {
            const double size = std::abs(r);
            sum += size < huber_db ? r * r : huber_db * (2 * size - huber_db);
        }
        for (const double pull : pulls(values)) sum += pull_weight_ * pull * pull;
        for (const size_t not_negative : {size_t{log_coefficient}, size_t{tvg_slope}, size_t{absorption}})
            sum += values[not_negative] < 0 ? 1e3 * values[not_negative] * values[not_negative] * range_ * range_ : 0;
        return sum;
    }
    double range() const { return range_; }
    /** Number of slices of each block in a fit. Neighbouring slices are one entry of `residuals` apart, or one
     *  block. */
    size_t rows() const { return recorded_.slices - first_slice; }
    const FitChain& chain() const { return chain_; }

    double pullWeight() const { return pull_weight_; }
    /** Weights the priors by the variance of independent residuals: a scene that differs slightly from the recorded
     *  scene must not overrule the priors. */
    void weighPulls(double variance) { pull_weight_ = std::max(1.0, variance); }

private:
    bool isOpenWater(size_t block, size_t slice) const { return echoes_.at(block, slice) <= silent_db; }
    /** Returns recorded minus modelled level; in the water before the floor, with the recorded level of the quieter
     *  side. */
    double computeOff(size_t block, size_t slice, double modelled) const {
        if (!chain_.isSideScan() || !isOpenWater(block, slice)) return recorded_.at(block, slice) - modelled;
        return is_loud_[block] ? 0 : (water_recorded_ ? *water_recorded_ : recorded_).at(block, slice) - modelled;
    }
    /** Finds the blocks of a side-scan's lines whose water is ignored. Sources that a rough scene lacks (fish, wakes,
     *  other sonars) only add energy, so the quietest quarter of the blocks shows noise and water. */
    void findLoudBlocks() {
        is_loud_.assign(recorded_.beam_blocks, false);
        if (!rough_ || !chain_.isSideScan()) return;
        std::vector<std::pair<double, size_t>> blocks;
        for (size_t block = 0; block < recorded_.beam_blocks; ++block) {
            double sum = 0, count = 0;
            for (size_t slice = first_slice; slice < recorded_.slices; ++slice) {
                bool is_open = true;  // in all blocks, so that they are comparable
                for (size_t other = 0; other < recorded_.beam_blocks; ++other) is_open &= isOpenWater(other, slice);
                if (is_open) sum += (water_recorded_ ? *water_recorded_ : recorded_).at(block, slice), ++count;
            }
            if (count > 0) blocks.emplace_back(sum / count, block);
        }
        std::ranges::sort(blocks);
        for (size_t i = (blocks.size() + 3) / 4; i < blocks.size(); ++i) is_loud_[blocks[i].second] = true;
    }
    void render(const FitChain& chain) {
        const types::Sonar echoes = meanEchoes(rough_ ? thinned(chain) : chain);
        echoes_ = makeBlocks(echoes);
        const double slices = static_cast<double>(recorded_.slices);
        axis_ = echoes.binStart(echoes.bin_count) / (recorded_.ranges.back() * slices / (slices - 0.5));
        if (!fits_water_) return;
        constexpr double strength_db = -40;  // far above the rounding of the difference
        FitChain filled = thinned(chain);
        filled.sonar.volume.emplace_back().strength_db = strength_db;
        water_ = makeBlocks(meanEchoes(filled));
        for (size_t i = 0; i < water_.level.size(); ++i)
            water_.level[i] = toDb(toPower(water_.level[i]) - toPower(echoes_.level[i])) - strength_db;
    }
    std::vector<double> overBeams(const LevelBlocks& blocks) const {
        std::vector<double> levels;
        for (size_t slice = 0; slice < blocks.slices; ++slice) {
            std::vector<double> across;
            for (size_t block = 0; block < blocks.beam_blocks; ++block) across.push_back(blocks.at(block, slice));
            levels.push_back(medianLevel(std::move(across)));
        }
        return levels;
    }

    const LevelBlocks& recorded_;
    std::optional<LevelBlocks> water_recorded_;
    CodeResponse response_;
    FitChain chain_;
    bool rough_, by_median_, fits_water_, fits_scene_;
    double range_;
    std::vector<bool> is_loud_;  ///< One for each block, see findLoudBlocks().
    double pull_weight_ = 1;
    double axis_ = 1;  ///< Ranges of a simulated sample, with bins of whole microseconds, over true ranges [1].
    Values before_;
    LevelBlocks echoes_;
    LevelBlocks water_;  ///< Levels of water with 0 dB re 1/m, without absorption.
    std::vector<double> recorded_level_;
};

/** Minimises the cost over the chosen values. */
Values moving(const Chosen& chosen, const LevelModel& model, Values values, int evaluations, int rounds,
              const std::function<double(const Values&)>& cost) {
    const Values all_steps = model.steps();
    std::vector<double> x, steps;
    for (const size_t i : chosen) x.push_back(values[i]), steps.push_back(all_steps[i]);
    const auto at = [&](const double* moved) {
        Values tried = values;
        for (size_t i = 0; i < chosen.size(); ++i) tried[chosen[i]] = moved[i];
        return tried;
    };
    x = minimum(std::move(x), steps, evaluations, rounds, [&](const double* moved) { return cost(at(moved)); });
    return at(x.data());
}

/** Fits the level parameters at a fixed attitude. */
Values fitInner(const LevelModel& model, const Values& values, int evaluations, int rounds) {
    return moving(model.levels(), model, values, evaluations, rounds,
                  [&](const Values& tried) { return model.cost(tried); });
}

/** Returns poses of the sonar from which the fit of the scene may begin: pitch [deg] and height [m], both relative to
 *  the chain's. */
std::vector<std::array<double, 2>> beginnings(const FitChain& chain, double range) {
    std::vector<std::array<double, 2>> all{{0, 0}};
    if (chain.isSideScan()) return all;
    const std::optional<double> floor = floorBelow(chain);
    if (!floor) return all;
    const glm::dvec3 axis = chain.snapshot.sonar.orientation * glm::dvec3(1, 0, 0);
    const double down = types::degrees(std::asin(std::clamp(-axis.z, -1.0, 1.0)));
    for (const double share : {0.15, 0.3, 0.5})
        for (const double depression : {15.0, 30.0, 50.0}) all.push_back({depression - down, share * range - *floor});
    return all;
}

/** Fits pitch, height and elevation width, each with the best level parameters. */
Values fitScene(LevelModel& model, const Values& values, const std::function<void()>& progress) {
    Values best = values;
    double lowest = std::numeric_limits<double>::infinity();
    const auto costAt = [&](Values tried, bool anew) {
        if (std::abs(tried[elevation] - std::log(elevation_before)) > 2.5 || std::abs(tried[pitch]) > 60) return 1e9;
        model.look(tried);
        if (anew && !model.fitsWater()) std::ranges::copy_n(model.start().begin(), pitch, tried.begin());
        tried = fitInner(model, tried, 150, 1);
        progress();
        const double found = model.cost(tried);
        if (found < lowest) {
            lowest = found;
            best = tried;
        }
        return found;
    };
    for (const auto& [turn, rise] : beginnings(model.chain(), model.range())) {
        Values tried = values;
        tried[pitch] = turn, tried[height] = rise, tried[elevation] = std::log(elevation_before);
        costAt(tried, true);
    }
    moving(model.looks(), model, best, 60, 2, [&](const Values& looking) {
        Values tried = best;
        for (const size_t i : model.looks()) tried[i] = looking[i];
        return costAt(tried, false);
    });
    model.look(best);
    return fitInner(model, best, 1500, 3);
}

/** Returns the factor by which correlation of neighbouring residuals raises the variance of their mean, for a
 *  first-order process (Priestley 1981). */
double alike(const std::vector<double>& residuals, size_t stride) {
    double squares = 0, products = 0, pairs = 0;
    for (size_t i = 0; i < residuals.size(); ++i) {
        squares += residuals[i] * residuals[i] / static_cast<double>(residuals.size());
        if (i + stride < residuals.size()) products += residuals[i] * residuals[i + stride], ++pairs;
    }
    if (!(squares > 0) || pairs == 0) return 1;
    const double correlation = std::clamp(products / pairs / squares, 0.0, 0.95);
    return (1 + correlation) / (1 - correlation);
}

/** Returns the variance of a residual as if all were independent [dB^2]. */
double computeVariance(const LevelModel& model, const Values& at) {
    const std::vector<double> residuals = model.residuals(at);
    double sum = 0;
    for (const double r : residuals) sum += r * r;
    const auto fitted = static_cast<double>(model.levels().size() + model.looks().size());
    const double freedom = std::max(1.0, static_cast<double>(residuals.size()) - fitted);
    return sum / freedom * alike(residuals, residuals.size() / model.rows());
}

/** Returns the derivatives of residuals and priors by each chosen value; for attitude by rendering again. */
cv::Mat jacobian(LevelModel& model, const Values& at, const Chosen& chosen) {
    const auto all = [&](const Values& values) {
        std::vector<double> rows = model.residuals(values);
        for (const double pull : model.pulls(values)) rows.push_back(pull);
        return rows;
    };
    const double range = model.range();
    const Values steps{0.05, 0.05, 0.05, 0.05 / range, 0.05 / range, 0.05, 0.2, 0.005 * range, 0.02};
    const std::vector<double> here = all(at);
    cv::Mat derivatives(static_cast<int>(here.size()), static_cast<int>(chosen.size()), CV_64F);
    for (size_t column = 0; column < chosen.size(); ++column) {
        Values there = at;
        there[chosen[column]] += steps[chosen[column]];
        if (chosen[column] >= pitch) model.look(there);
        const std::vector<double> changed = all(there);
        for (size_t row = 0; row < here.size(); ++row)
            derivatives.at<double>(static_cast<int>(row), static_cast<int>(column)) =
                (changed[row] - here[row]) / steps[chosen[column]];
    }
    model.look(at);
    return derivatives;
}

/** Minimises the cost near some values over all chosen values at once: Levenberg and Marquardt's steps (Marquardt 1963)
 *  with the weights of cost(). The nested simplex, whose inner fits are approximate, ends next to the minimum. */
Values polished(LevelModel& model, Values at, const Chosen& chosen, const std::function<void()>& progress) {
    constexpr int max_steps = 20;
    model.look(at);
    double lowest = model.cost(at), damping = 1e-3;
    for (int step = 0; step < max_steps && damping < 1e4; ++step) {
        const std::vector<double> off = model.residuals(at), pulls = model.pulls(at);
        cv::Mat derivatives = jacobian(model, at, chosen),
                right(static_cast<int>(off.size() + pulls.size()), 1, CV_64F);
        for (int row = 0; row < right.rows; ++row) {
            const auto i = static_cast<size_t>(row);
            const double value = i < off.size() ? off[i] : pulls[i - off.size()];
            const double weight = i < off.size() ? std::sqrt(std::min(1.0, huber_db / std::max(std::abs(value), 1e-9)))
                                                 : std::sqrt(model.pullWeight());
            derivatives.row(row) *= weight;
            right.at<double>(row) = -weight * value;
        }
        cv::Mat normal = derivatives.t() * derivatives, gradient = derivatives.t() * right, change;
        for (int i = 0; i < normal.rows; ++i) normal.at<double>(i, i) *= 1 + damping;
        cv::solve(normal, gradient, change, cv::DECOMP_SVD);
        Values tried = at;
        for (size_t i = 0; i < chosen.size(); ++i) tried[chosen[i]] += change.at<double>(static_cast<int>(i));
        model.look(tried);
        progress();
        const double cost = model.cost(tried);
        if (!(cost < lowest)) {
            damping *= 10;
            model.look(at);
            continue;
        }
        const bool is_there = lowest - cost < 1e-6 * lowest;
        lowest = cost, at = tried, damping /= 10;
        if (is_there) break;
    }
    model.look(at);
    return at;
}

Fitted around(double value, double deviation) { return {value, value - z_95 * deviation, value + z_95 * deviation}; }

/** Returns the values with their intervals. */
LevelFit makeFit(LevelModel& model, const Values& at) {
    Chosen chosen = model.levels();
    for (const size_t i : model.looks()) chosen.push_back(i);
    const std::vector<double> residuals = model.residuals(at);
    const double variance = computeVariance(model, at);
    double sum = 0;
    for (const double r : residuals) sum += r * r;
    cv::Mat derivatives = jacobian(model, at, chosen);
    for (int row = 0; row < static_cast<int>(residuals.size()); ++row)
        derivatives.row(row) /= std::sqrt(std::max(variance, 1e-6));
    cv::Mat covariance;
    cv::invert(derivatives.t() * derivatives, covariance, cv::DECOMP_SVD);
    const auto deviation = [&](size_t i) {
        const auto place = static_cast<int>(std::ranges::find(chosen, i) - chosen.begin());
        return std::sqrt(std::max(0.0, covariance.at<double>(place, place)));
    };
    const auto fitted = [&](size_t i) { return around(at[i], deviation(i)); };
    LevelFit fit{.full_scale_db = fitted(full_scale),
                 .noise_db = fitted(noise_level),
                 .log_coefficient = fitted(log_coefficient),
                 .db_per_m = fitted(tvg_slope),
                 .absorption_db_per_m = fitted(absorption),
                 .rms_db = std::sqrt(sum / static_cast<double>(residuals.size()))};
    fit.modelled = model.modelled(at);
    const double r = model.range();
    const std::array<double, 2> gain{1.0, 2 * 0.9 * r};  // of log coefficient and slope, from a tenth of the range on
    double span_variance = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            span_variance += gain[static_cast<size_t>(i)] * gain[static_cast<size_t>(j)] *
                             covariance.at<double>(log_coefficient + i, log_coefficient + j);
    fit.tvg_span_db = around(model.gainDb(at, r) - model.gainDb(at, 0.1 * r), std::sqrt(std::max(0.0, span_variance)));
    if (std::ranges::count(chosen, water_strength) > 0) fit.water_db = fitted(water_strength);
    if (model.looks().empty()) return fit;
    fit.pitch_deg = fitted(pitch);
    if (!model.chain().isSideScan()) fit.height_m = fitted(height);
    const Fitted logarithm = fitted(elevation);
    fit.elevation_deg = {std::exp(logarithm.value), std::exp(logarithm.low), std::exp(logarithm.high)};
    return fit;
}

}  // namespace

FitChain LevelFit::applied(const FitChain& chain) const {
    FitChain fitted = chain;
    receiver::TvgConfig tvg = fitted.receiver.tvg.value_or(receiver::TvgConfig{});
    tvg.log_coefficient = std::max(0.0, log_coefficient.value);
    tvg.db_per_m = std::max(0.0, db_per_m.value);
    fitted.receiver.tvg = tvg;
    receiver::CodeConfig code = fitted.code();
    code.full_scale_db = full_scale_db.value + fitted.receiver.gain_db;
    fitted.receiver.code = code;
    fitted.noise.ambient =
        noise::AmbientConfig{.level_db = noise_db.value, .wind_m_s = {}, .bandwidth_khz = {}, .source_level_db = {}};
    sonar::AbsorptionConfig absorption;
    absorption.db_per_m = std::max(0.0, absorption_db_per_m.value);
    fitted.sonar.absorption = absorption;
    if (water_db) {
        fitted.sonar.volume = {sonar::VolumeLayer{.top_m = {}, .bottom_m = {}, .strength_db = {}}};
        fitted.sonar.volume.front().strength_db = std::clamp(water_db->value, -200.0, 0.0);
    }
    if (pitch_deg && fitted.isSideScan()) {
        LevelModel::lookAcross(pitch_deg->value, elevation_deg->value, fitted);
    } else if (pitch_deg) {
        fitted.snapshot.sonar = moved(fitted.snapshot.sonar, types::radians(pitch_deg->value), height_m->value);
        LevelModel::setElevation(elevation_deg->value, fitted);
    }
    return fitted;
}

double LevelFit::echoShare(double level_db, double range) const {
    const double gain = log_coefficient.value * std::log10(std::max(range, 1e-3)) + 2 * db_per_m.value * range;
    return std::clamp(1 - toPower(noise_db.value + gain - full_scale_db.value - level_db), 0.0, 1.0);
}

LevelFit fitLevels(const LevelBlocks& recorded, const CodedPing& law, const FitChain& chain,
                   const LevelOptions& options, const std::function<void()>& progress) {
    LevelModel model(recorded, law, chain, options);
    Values values = fitInner(model, model.start(), 1500, 3);
    if (model.fitsWater()) {
        const Values in_water = fitInner(model, model.startInWater(), 1500, 3);
        if (model.cost(in_water) < model.cost(values)) values = in_water;
    }
    model.weighPulls(computeVariance(model, values));
    if (model.looks().empty()) {
        values = fitInner(model, values, 1500, 2);
    } else {
        values = fitScene(model, values, progress);
        model.weighPulls(computeVariance(model, values));
        values = fitInner(model, values, 1500, 2);
        Chosen all = model.levels();
        for (const size_t i : model.looks()) all.push_back(i);
        values = polished(model, values, all, progress);
    }
    progress();
    return makeFit(model, values);
}

}  // namespace insonify::study
