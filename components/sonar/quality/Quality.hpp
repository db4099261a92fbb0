#pragma once
#include <limits>
#include <vector>

#include "components/sonar/SonarRenderer.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Samples per beam, and the resulting error. */
struct Quality {
    int rows = 64, columns_per_beam = 2;
    /** Relative L2 error of bin energies after a gain of 50 log10(r) (`physical`), of bins (`cerqueira2017`); NaN: not
     *  predicted [1]. */
    double error = std::numeric_limits<double>::quiet_NaN();

    double samples() const { return static_cast<double>(rows) * columns_per_beam; }  ///< Samples of one beam [1].
    bool operator==(const Quality& other) const {
        return rows == other.rows && columns_per_beam == other.columns_per_beam;
    }
};

/** The error estimated at one quality, in two parts that are inversely proportional to rows and to columns. Both fall
 *  at least this fast where surfaces are resolved. Elsewhere the next estimate corrects the model. */
struct ErrorModel {
    Quality at;
    double of_rows = 0, of_columns = 0;  ///< [1]

    double error(int rows, int columns_per_beam) const;
    double error() const { return error(at.rows, at.columns_per_beam); }
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

private:
    std::vector<int> rows_, columns_;
};

/** Estimates the error of pings by comparing them with cheaper pings of the same snapshot.
 *
 *  Uses three fifths of the rows rather than half, because an edge along the rows may be equally wrong at half the
 *  rows. Halves the columns. Assumes that the two errors are independent and proportional to the spacing of the
 *  samples. */
class ErrorEstimator {
public:
    explicit ErrorEstimator(const SonarConfig& config);
    /** Estimates the errors of rows and of columns separately; costs 1.1 pings. */
    ErrorModel model(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                     const Quality& quality);
    /** Estimates the error of both together [1]; costs 0.3 pings. */
    double error(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                 const Quality& quality);

    /** Returns the samples per beam of all pings rendered for estimates [1]. */
    double rendered() const { return rendered_; }

private:
    double change(const std::vector<float>& coarse, const std::vector<float>& fine) const;
    double changeBy(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping, int rows,
                    int columns_per_beam);

    std::vector<double> weights_;  ///< Weights of the squares of a beam's bins [1].
    types::Sonar coarse_;
    double rendered_ = 0;
};

/** Goal of the choice of a quality. */
struct QualityGoal {
    double target = 0;                                             ///< Error [1].
    double max_samples = std::numeric_limits<double>::infinity();  ///< Max samples per beam [1].
    bool trades = true;  ///< Whether rows may be traded for columns, and vice versa, at the max samples.
};

/** Raises the quality from `start`, at which `ping` has been rendered, until the estimated error is at most the target,
 *  or the max samples are reached.
 *
 *  Each step uses the estimate of the step before and at most four times its samples. All steps together thus take
 *  about the time of three pings at the last quality. Renders `ping` again where the quality has changed, and leaves
 *  the renderer at the new quality. Rows and columns are not lowered, except in exchange for each other. */
ErrorModel climb(ErrorEstimator& estimator, const QualityLadder& ladder, SonarRenderer& renderer,
                 const types::Snapshot& scene, const Quality& start, const QualityGoal& goal, types::Sonar& ping);

/** Goal of a new choice, when the error was above the target or a lower quality suffices [1 of the target]. */
constexpr double target_share = 0.8;

/** Returns the quality that a sonar chooses in one snapshot, for its configuration's target and max samples. */
Quality chooseQuality(const SonarConfig& config, const types::Snapshot& scene);

}  // namespace insonify::sonar
