#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "components/sonar/SonarRenderer.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Samples per beam, and the error that they leave. */
struct Quality {
    int rows = 64, columns_per_beam = 2;
    /** Relative L2 of bin energies after a gain of 50 log10(r) (`physical`), of bins (`cerqueira2017`); NaN: not
     *  predicted [1]. */
    double error = std::numeric_limits<double>::quiet_NaN();

    double samples() const { return static_cast<double>(rows) * columns_per_beam; }  ///< Of one beam [1].
    bool operator==(const Quality& other) const {
        return rows == other.rows && columns_per_beam == other.columns_per_beam;
    }
};

/** The error as it was estimated at one quality, in two parts that fall in proportion to rows and to columns. Both fall
 *  at least so fast where surfaces are resolved; where they are not, the next estimate puts it right. */
struct ErrorModel {
    Quality at;
    double of_rows = 0, of_columns = 0;  ///< [1]

    double error(int rows, int columns_per_beam) const;
    double error() const { return error(at.rows, at.columns_per_beam); }
};

/** The qualities that are chosen from: 64 to 2048 rows, 9 % apart, with 2, 3, 4, 6, 8, 12 ... 256 columns per beam as
 *  far as a device can draw them. */
class QualityLadder {
public:
    explicit QualityLadder(const SonarConfig& config);
    /** The one of fewest samples whose error is at most `target`, else the one of least error; of at least the rows and
     *  columns of `least` and at most `max_samples` per beam, `least` itself where there is none. Its error is
     *  `model`'s. */
    Quality choose(const ErrorModel& model, double target, double max_samples, const Quality& least = {}) const;

private:
    std::vector<int> rows_, columns_;
};

/** Tells the error of pings by comparing them with cheaper ones of the same snapshot. Three fifths of the rows are
 *  compared rather than half: an edge along the rows may lie as wrong at half as many. Columns are halved. The
 *  difference is taken for that of two errors that do not depend on each other and are in proportion to the spacing of
 *  the samples. */
class ErrorEstimator {
public:
    explicit ErrorEstimator(const SonarConfig& config);
    /** Of rows and columns apart, for 1.1 pings' time. */
    ErrorModel model(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                     const Quality& quality);
    /** Of both at once, for 0.3 pings' time [1]. */
    double error(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping,
                 const Quality& quality);

    /** Samples per beam of all that has been rendered to tell errors [1]. */
    double rendered() const { return rendered_; }

private:
    double change(const std::vector<float>& coarse, const std::vector<float>& fine) const;
    double changeBy(SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping, int rows,
                    int columns_per_beam);

    std::vector<double> weights_;  ///< Of the squares of a beam's bins [1].
    types::Sonar coarse_;
    double rendered_ = 0;
};

/** What a quality is chosen for. */
struct QualityGoal {
    double target = 0;                                             ///< Error [1].
    double max_samples = std::numeric_limits<double>::infinity();  ///< Per beam [1].
    bool trades = true;  ///< Whether rows may go for columns, and columns for rows, where no more samples are allowed.
};

/** Climbs from `start`, at which `ping` has been rendered, until the estimated error is at most the target or the most
 *  samples are reached: each step is found from the estimate of the one before and takes at most four times its
 *  samples, so that all steps together take about three pings' time of the last. `ping` is rendered again where the
 *  quality is another one, and the renderer left at it. Rows and columns are not lowered, except for each other. */
ErrorModel climb(ErrorEstimator& estimator, const QualityLadder& ladder, SonarRenderer& renderer,
                 const types::Snapshot& scene, const Quality& start, const QualityGoal& goal, types::Sonar& ping);

/** The error that is aimed at when more than the target was found, or less is enough [1 of the target]. */
constexpr double aim_share = 0.8;

/** What a sonar chooses for what it sees in one snapshot, for its configuration's target and most samples. */
Quality chooseQuality(const SonarConfig& config, const types::Snapshot& scene);

}  // namespace insonify::sonar
