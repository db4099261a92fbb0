#pragma once
#include <limits>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Samples per beam, and the resulting error. */
struct Quality {
    int rows = 64, columns_per_beam = 2;
    /** Relative L2 error of bin energies after a gain of 50 log10(r) (`physical`), of bins (`cerqueira2017`), which the
     *  error exceeds in at most one of 20 scenes; NaN: not predicted [1]. */
    double error = std::numeric_limits<double>::quiet_NaN();

    double samples() const { return static_cast<double>(rows) * columns_per_beam; }  ///< Samples of one beam [1].
    bool operator==(const Quality& other) const {
        return rows == other.rows && columns_per_beam == other.columns_per_beam;
    }
};

/** Returns the quality before the first echo, at which a search begins: 64 rows, and columns of at most 1.5 deg, so
 * that a wide beam finds a small body alone in the water; 2 at least, and no more than its max samples allow. */
Quality firstQuality(const SonarConfig& config);

/** The error predicted at one quality, in two parts that are inversely proportional to rows and to columns. */
struct ErrorModel {
    Quality at;
    double of_rows = 0, of_columns = 0;  ///< [1]

    double error(int rows, int columns_per_beam) const;
    /** Returns the model moved to another quality, whose error it predicts. */
    ErrorModel movedTo(const Quality& other) const;
    /** Returns the model with all errors multiplied by `factor`. */
    ErrorModel scaled(double factor) const;
    /** Returns the model with this error at its quality; in equal parts, where it has none. */
    ErrorModel withError(double error) const;
};

/** The available qualities: 64 to 2048 rows, 9 % apart, with 2, 3, 4, 6, 8, 12 ... 256 columns per beam, up to what a
 *  device can rasterise. */
class QualityLadder {
public:
    explicit QualityLadder(const SonarConfig& config);
    /** Returns the quality with the fewest samples whose error is at most `target`, else that with the smallest error.
     *  It has at least the rows and columns of `least`, and at most `max_samples` per beam; `least` itself where there
     *  is none. Its error is that of `model`. */
    Quality choose(const ErrorModel& model, double target, double max_samples, const Quality& minimum = {}) const;
    int maxColumns() const { return columns_.back(); }

private:
    std::vector<int> rows_, columns_;
};

/** Measures the error of pings by comparing them with other pings of the same snapshot.
 *
 *  A ping's error is the larger of its differences to two finer pings, of about 2 and 3 times its rows and columns,
 *  with a margin of a fifth; for `cerqueira2017` of a half, as a bin on an edge is any mean of two surfaces. Two,
 *  because samples at multiples of each other may miss the same thing. Where both differ from it in the same direction,
 *  as at a disc's edge that fills a part of a bin, the finest has an error as well: of a first-order error a third
 *  remains at 3 times the samples, twice of what changes from 2 to 3 times (Richardson's extrapolation), so the margin
 *  grows to two at most. Where no finer ping can be rasterised, the difference to a coarser one is added. */
class ErrorEstimator {
public:
    /** `least`: the smallest error that is predicted where there is an echo [1]. */
    ErrorEstimator(const SonarConfig& config, double least);
    /** Forgets the finest ping that was rendered to measure. Call it for each new snapshot. */
    void begin() { finest_yet_ = {}; }
    /** Measures the error of a ping of this quality, and its parts; costs 15 pings. Its difference to the finest ping
     *  since begin() counts as well: a coarse ping and those next to it may miss a small body. Leaves the renderer at
     *  another quality. */
    ErrorModel measure(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                       const Quality& quality);
    /** Returns the difference to a ping of three fifths of the rows and half the columns, relative to the ping; costs
     *  0.3 pings. Leaves the renderer at that quality. */
    double changeToCoarser(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                           const Quality& quality);
    /** Returns the smallest error that is predicted for a ping: a surface between all samples may be missed. For
     *  `cerqueira2017` it is that of the brightest bin, which the smallest piece of a surface can fill [1]. */
    double least(const types::Sonar& ping) const;

    /** Returns the samples per beam of all pings rendered to measure [1]. */
    double rendered() const { return rendered_; }

private:
    double change(const std::vector<float>& coarse, const std::vector<float>& fine) const;
    /** Returns how far a ping of 2 times the samples is behind one of 3 times, along the difference of `coarse` to the
     *  latter [1 of this difference]: 0.25 for an error of first order, about 0.05 for a random one. */
    double lag(const std::vector<float>& coarse, const std::vector<float>& finer,
               const std::vector<float>& finest) const;
    void render(SonarRenderer& renderer, const types::Snapshot& scene, int rows, int columns_per_beam,
                types::Sonar& ping);

    SonarConfig config_;
    double least_;
    std::vector<double> weights_;  ///< Weights of the squares of a beam's bins [1].
    types::Sonar finest_, other_, reference_;
    Quality finest_yet_{0, 0};  ///< Of `reference_`.
    double rendered_ = 0;
};

/** Goal of the choice of a quality. */
struct QualityGoal {
    double target = 0;                                             ///< Error [1].
    double max_samples = std::numeric_limits<double>::infinity();  ///< Max samples per beam [1].
    Quality minimum = {};                                          ///< At least these rows and these columns.
};

/** Finds the quality with the fewest samples whose measured error is at most the target, or with the smallest error
 *  within the max samples, from `start`, at which `ping` has been rendered.
 *
 *  Each step goes where the parts of the last measured error lead, to at most four times its samples. All steps
 *  together take the time of 25 to 75 pings at the last quality. Leaves `ping` rendered at the quality that it returns
 *  with its error, and the renderer at any. */
ErrorModel climb(ErrorEstimator& estimator, const QualityLadder& ladder, SonarRenderer& renderer,
                 const types::Snapshot& scene, const Quality& start, const QualityGoal& goal, types::Sonar& ping);

/** Error that a step aims at [1 of the target]. */
constexpr double target_share = 0.92;

/** Smallest error that is predicted [1 of the target], and without a target [1]. */
constexpr double min_share = 0.2, min_error = 0.01;

/** Returns the quality that a sonar chooses in one snapshot, for its configuration's target and max samples. */
Quality chooseQuality(const SonarConfig& config, const types::Snapshot& scene);

}  // namespace insonify::sonar
