#include "components/study/FitLevels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/optim.hpp>

#include "components/receiver/Receiver.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

constexpr size_t beam_blocks = 8, range_slices_of_fit = 64;
constexpr size_t first_slice = 3;  ///< Nearer, transmitters ring, and the gain changes within a slice.
constexpr double silent_db = -400;
constexpr double huber_db = 3;  ///< Residuals beyond this count by their size, not their square.
constexpr double response_low = -140, response_high = 60, response_step = 0.25;  // [dB]
constexpr double z_95 = 1.96;
constexpr double elevation_before = 15;  ///< Width of a beam in elevation of which nothing is known [deg].

double toDb(double power) { return power > 1e-40 ? 10 * std::log10(power) : silent_db; }
double toPower(double db) { return std::pow(10, db / 10); }

double medianLevel(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<long>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

template <class Intensity>
LevelBlocks blocksBy(size_t beams, size_t bins, double resolution, const Intensity& intensity) {
    LevelBlocks blocks{.beam_blocks = std::min(beam_blocks, beams), .slices = std::min(range_slices_of_fit, bins)};
    for (size_t slice = 0; slice < blocks.slices; ++slice)
        blocks.ranges.push_back(resolution * static_cast<double>(bins) * (static_cast<double>(slice) + 0.5) /
                                static_cast<double>(blocks.slices));
    for (size_t block = 0; block < blocks.beam_blocks; ++block)
        for (size_t slice = 0; slice < blocks.slices; ++slice) {
            const size_t b0 = block * beams / blocks.beam_blocks, b1 = (block + 1) * beams / blocks.beam_blocks;
            const size_t k0 = slice * bins / blocks.slices, k1 = (slice + 1) * bins / blocks.slices;
            double sum = 0;
            for (size_t beam = b0; beam < b1; ++beam)
                for (size_t bin = k0; bin < k1; ++bin) sum += intensity(beam, bin);
            blocks.level.push_back(toDb(sum / static_cast<double>((b1 - b0) * (k1 - k0))));
        }
    return blocks;
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

/** The minimum from `x` on, with so large first steps; begun anew from there until it stays. */
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

/** The same with a few of the beams, whose median is that of all. */
FitChain thinned(FitChain chain) {
    if (chain.isSideScan()) return chain;
    constexpr size_t few = 32;
    const std::vector<double> all = std::move(chain.sonar.bearings_deg);
    const size_t step = std::max<size_t>(1, all.size() / few);
    chain.sonar.bearings_deg.clear();
    for (size_t i = step / 2; i < all.size(); i += step) chain.sonar.bearings_deg.push_back(all[i]);
    return chain;
}

/** What is fitted, in this order. */
enum Parameter : size_t { full_scale, noise_level, log_coefficient, tvg_slope, absorption, scene_parameters };
constexpr size_t pitch = scene_parameters, height = pitch + 1, elevation = pitch + 2, all_parameters = pitch + 3;
using Values = std::vector<double>;

/** Levels of the blocks by the values, and how far they are from the recorded ones. */
class LevelModel {
public:
    LevelModel(const LevelBlocks& recorded, const CodedPing& law, const FitChain& chain, bool rough)
        : recorded_(recorded), response_(law), chain_(chain), rough_(rough), range_(recorded.ranges.back()) {
        const receiver::TvgConfig tvg = chain.receiver.tvg.value_or(receiver::TvgConfig{});
        const double absorbed = sonar::makeAbsorption(chain.sonar).db_per_m;
        before_ = {chain.code().full_scale_db - chain.receiver.gain_db, -100, tvg.log_coefficient, tvg.db_per_m,
                   absorbed};
        const types::Sonar echoes = meanEchoes(rough ? thinned(chain) : chain);
        echoes_ = blocksOf(echoes);
        const double slices = static_cast<double>(recorded.slices);
        axis_ = echoes.binStart(echoes.bin_count) / (recorded.ranges.back() * slices / (slices - 0.5));
        if (rough) recorded_level_ = overBeams(recorded);
    }

    /** Values to begin with: full scale and noise from the loudest and faintest slices. */
    Values start() const {
        Values values = before_;
        const std::vector<double> recorded = overBeams(recorded_), echoes = overBeams(echoes_);
        const size_t loudest = static_cast<size_t>(std::ranges::max_element(recorded) - recorded.begin());
        const double echo = *std::ranges::max_element(echoes);
        values[full_scale] = echo + gainDb(values, recorded_.ranges[loudest]) - recorded[loudest];
        std::vector<double> floors;
        for (size_t i = 0; i < recorded.size(); ++i)
            floors.push_back(recorded[i] + values[full_scale] - gainDb(values, recorded_.ranges[i]));
        std::ranges::sort(floors);
        values[noise_level] = floors[floors.size() / 16];
        return values;
    }
    std::vector<double> steps() const { return {6, 6, 10, 10 / range_, 5 / range_}; }

    /** Renders the scene as these values see it; of a rough one alone. */
    void look(const Values& values) {
        if (!rough_ || values.size() < all_parameters) return;
        echoes_ = blocksOf(meanEchoes(thinned(seen(values))));
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
    /** Turns the beams of a side-scan down and makes them as wide across the track. */
    static void lookAcross(double down_deg, double width_deg, FitChain& chain) {
        for (double& bearing : chain.sonar.bearings_deg)
            bearing = std::copysign(std::clamp(std::abs(bearing) - down_deg, 5.0, 89.0), bearing);
        if (!chain.sonar.beam_pattern) chain.sonar.beam_pattern.emplace();
        acoustics::BeamLaw& law = chain.sonar.beam_pattern->receive.azimuth.emplace();
        law.weighting = acoustics::Weighting::Gaussian;
        law.width_deg = std::min(width_deg, 170.0);
        chain.sonar.beam_width_deg = std::clamp(2.5 * width_deg, *chain.sonar.beam_width_deg, 110.0);
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

    /** What the codes of a block state, relative to the largest code [dB]. */
    double stated(const Values& values, size_t block, size_t slice) const {
        const double r = recorded_.ranges[slice];
        const double echo = echoes_.at(block, slice) - 2 * values[absorption] * r;
        const double both = toDb(toPower(echo) + toPower(values[noise_level]));
        return response_(both + gainDb(values, r) - values[full_scale]);
    }

    LevelBlocks modelled(const Values& values) const {
        LevelBlocks blocks = recorded_;
        for (size_t block = 0; block < blocks.beam_blocks; ++block)
            for (size_t slice = 0; slice < blocks.slices; ++slice)
                blocks.level[block * blocks.slices + slice] = stated(values, block, slice);
        return blocks;
    }

    /** Recorded less modelled levels, then how far the values are from those before in what is loosely known [dB]. */
    std::vector<double> residuals(const Values& values) const {
        std::vector<double> all;
        for (size_t slice = first_slice; slice < recorded_.slices; ++slice) {
            std::vector<double> across;
            for (size_t block = 0; block < recorded_.beam_blocks; ++block) {
                across.push_back(stated(values, block, slice));
                if (!rough_) all.push_back(recorded_.at(block, slice) - across.back());
            }
            if (rough_) all.push_back(recorded_level_[slice] - medianLevel(across));
        }
        return all;
    }
    /** Pulls of what is known before, in standard deviations. */
    std::vector<double> pulls(const Values& values) const {
        std::vector<double> all{(values[log_coefficient] - before_[log_coefficient]) / 30,
                                (values[tvg_slope] - before_[tvg_slope]) * 2 * range_ / 60,
                                (values[absorption] - before_[absorption]) * 2 * range_ / (rough_ ? 2 : 3)};
        if (values.size() == all_parameters) {
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
        for (const double pull : pulls(values)) sum += pull * pull;
        for (const size_t not_negative : {size_t{log_coefficient}, size_t{tvg_slope}, size_t{absorption}})
            sum += values[not_negative] < 0 ? 1e3 * values[not_negative] * values[not_negative] * range_ * range_ : 0;
        return sum;
    }
    double range() const { return range_; }
    const FitChain& chain() const { return chain_; }

private:
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
    CodeResponse response_;
    const FitChain& chain_;
    bool rough_;
    double range_;
    double axis_ = 1;  ///< Ranges of a simulated sample, whose bins last whole microseconds, over true ones [1].
    Values before_;
    LevelBlocks echoes_;
    std::vector<double> recorded_level_;
};

/** The best level parameters for the scene as it is looked at. */
Values fitInner(const LevelModel& model, Values values, int evaluations, int rounds) {
    const Values scene(values.begin() + std::min<long>(static_cast<long>(values.size()), scene_parameters),
                       values.end());
    values.resize(scene_parameters);
    const auto whole = [&](const double* x) {
        Values all(x, x + scene_parameters);
        all.insert(all.end(), scene.begin(), scene.end());
        return all;
    };
    values = minimum(std::move(values), model.steps(), evaluations, rounds,
                     [&](const double* x) { return model.cost(whole(x)); });
    return whole(values.data());
}

/** Places of the sonar over its scene from which the fit of the scene may begin: pitch [deg] and height [m], both
 *  relative to the chain's. */
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

/** The best pitch, height and beam in elevation, each with the best level parameters. */
Values fitScene(LevelModel& model, Values values, const std::function<void()>& progress) {
    values.resize(all_parameters);
    values[elevation] = std::log(elevation_before);
    Values best = values;
    double least = std::numeric_limits<double>::infinity();
    const auto costAt = [&](Values tried, bool anew) {
        if (std::abs(tried[elevation] - std::log(elevation_before)) > 2.5 || std::abs(tried[pitch]) > 60) return 1e9;
        model.look(tried);
        if (anew) std::ranges::copy(model.start(), tried.begin());
        tried = fitInner(model, tried, 150, 1);
        progress();
        const double found = model.cost(tried);
        if (found < least) {
            least = found;
            best = tried;
        }
        return found;
    };
    for (const auto& [turn, rise] : beginnings(model.chain(), model.range()))
        costAt({0, 0, 0, 0, 0, turn, rise, std::log(elevation_before)}, true);
    const auto cost = [&](const double* x) {
        Values tried = best;
        for (size_t i = 0; i < 3; ++i) tried[pitch + i] = x[i];
        return costAt(tried, false);
    };
    minimum({best[pitch], best[height], best[elevation]}, {8, -0.1 * model.range(), 0.4}, 60, 2, cost);
    model.look(best);
    return fitInner(model, best, 1500, 3);
}

/** Derivatives of residuals and pulls by each value; of scenes by rendering anew. */
cv::Mat jacobian(LevelModel& model, const Values& at) {
    const auto all = [&](const Values& values) {
        std::vector<double> rows = model.residuals(values);
        for (const double pull : model.pulls(values)) rows.push_back(pull);
        return rows;
    };
    const Values steps{0.05, 0.05, 0.05, 0.05 / model.range(), 0.05 / model.range(), 0.2, 0.005 * model.range(), 0.02};
    const std::vector<double> here = all(at);
    cv::Mat derivatives(static_cast<int>(here.size()), static_cast<int>(at.size()), CV_64F);
    for (size_t i = 0; i < at.size(); ++i) {
        Values there = at;
        there[i] += steps[i];
        if (i >= scene_parameters) model.look(there);
        const std::vector<double> changed = all(there);
        for (size_t row = 0; row < here.size(); ++row)
            derivatives.at<double>(static_cast<int>(row), static_cast<int>(i)) = (changed[row] - here[row]) / steps[i];
    }
    model.look(at);
    return derivatives;
}

Fitted around(double value, double deviation) { return {value, value - z_95 * deviation, value + z_95 * deviation}; }

/** Values with their intervals. */
LevelFit fitOf(LevelModel& model, const Values& at) {
    const std::vector<double> residuals = model.residuals(at);
    double sum = 0;
    for (const double r : residuals) sum += r * r;
    const double freedom = std::max(1.0, static_cast<double>(residuals.size()) - static_cast<double>(at.size()));
    const double variance = sum / freedom;
    cv::Mat derivatives = jacobian(model, at);
    for (int row = 0; row < static_cast<int>(residuals.size()); ++row)
        derivatives.row(row) /= std::sqrt(std::max(variance, 1e-6));
    cv::Mat covariance;
    cv::invert(derivatives.t() * derivatives, covariance, cv::DECOMP_SVD);
    const auto deviation = [&](size_t i) {
        return std::sqrt(std::max(0.0, covariance.at<double>(static_cast<int>(i), static_cast<int>(i))));
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
    if (at.size() < all_parameters) return fit;
    fit.pitch_deg = fitted(pitch);
    fit.height_m = fitted(height);
    const Fitted logarithm = fitted(elevation);
    fit.elevation_deg = {std::exp(logarithm.value), std::exp(logarithm.low), std::exp(logarithm.high)};
    return fit;
}

}  // namespace

CodeResponse::CodeResponse(const CodedPing& law) {
    constexpr int quantiles = 128;
    const double largest = std::pow(2, law.bits) - 1;
    const auto codeOf = [&](double intensity) {
        const double exponent = (law.law.law == receiver::CodeLaw::Sqrt ? 0.5 : 1.0) * law.law.gamma;
        const double share = law.law.law == receiver::CodeLaw::Log ? 1 + toDb(intensity) / law.law.dynamic_range_db
                                                                   : std::pow(intensity, exponent);
        return static_cast<float>(std::round(std::clamp(share, 0.0, 1.0) * largest) / largest);
    };
    for (double level = response_low; level <= response_high; level += response_step) {
        double sum = 0;
        for (int i = 0; i < quantiles; ++i) {
            const double factor = -std::log((i + 0.5) / quantiles);
            sum += toPower(law.levelDb(codeOf(toPower(level) * factor))) / quantiles;
        }
        stated_db_.push_back(toDb(sum));
    }
}

double CodeResponse::operator()(double level_db) const {
    const double place =
        std::clamp((level_db - response_low) / response_step, 0.0, static_cast<double>(stated_db_.size()) - 1.001);
    const auto i = static_cast<size_t>(place);
    const double part = place - static_cast<double>(i);
    return (1 - part) * stated_db_[i] + part * stated_db_[i + 1];
}

LevelBlocks blocksOf(const CodedPing& ping) {
    return blocksBy(ping.beam_count, ping.bin_count, ping.resolution,
                    [&](size_t beam, size_t bin) { return toPower(ping.levelDb(ping.code(beam, bin))); });
}

LevelBlocks blocksOf(const types::Sonar& intensities) {
    return blocksBy(intensities.beam_count, intensities.bin_count, intensities.binStart(1),
                    [&](size_t beam, size_t bin) {
                        return static_cast<double>(intensities.bins[beam * intensities.bin_count + bin]);
                    });
}

LevelBlocks meanOf(const std::vector<LevelBlocks>& all) {
    LevelBlocks mean = all.front();
    for (size_t i = 0; i < mean.level.size(); ++i) {
        double sum = 0;
        for (const LevelBlocks& each : all) sum += toPower(each.level[i]);
        mean.level[i] = toDb(sum / static_cast<double>(all.size()));
    }
    return mean;
}

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
    LevelModel model(recorded, law, chain, options.rough);
    Values values = fitInner(model, model.start(), 1500, 3);
    if (options.rough && options.fits_scene) values = fitScene(model, values, progress);
    progress();
    return fitOf(model, values);
}

}  // namespace insonify::study
