#pragma once
#include <span>
#include <vector>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/SonarConfig.hpp"

namespace insonify::sonar {

/** Turns what was accumulated in a bin into the configured output, so that nothing under- or overflows on the way.
 *
 *  For `physical`, A_j = sum of mu cos(theta) dOmega (r_j/r)^2 over the samples of bin j, r_j being its centre, and
 *  10 log10(E_j/S0) = 10 log10 A_j - 20 log10 r_j - 2 alpha r_j + TVG(r_j). For `cerqueira2017`, A_j is the mean of
 *  S and passes through.
 *
 *  A `gain` g scales both for a display of 0 to 1: S times 2 g; A_j times 2 g r_j / (mu_s w dR), which at g = 0.5 is
 * the echo of a cell of medium sand (mu_s), one beam wide (w) and one bin deep (dR), seen face on. */
class BinLevels {
public:
    BinLevels(const SonarConfig& config, const BinGrid& grid);

    /** One beam: bin_count accumulated values in, as many outputs out. Levels have a floor of -3000 dB, intensities
     *  a ceiling of the largest float; a value that is not positive is no echo. Allocates nothing. */
    void apply(std::span<const double> accumulated, std::span<float> bins) const;

    /** Spreading, absorption and gain of bin j [dB]. */
    double levelDb(int j) const { return level_db_[static_cast<size_t>(j)]; }

private:
    Output output_;
    double ceiling_;  ///< Of intensities [1].
    double source_level_db_ = 0;
    std::vector<double> level_db_;  ///< [dB]
    std::vector<double> factor_;    ///< The same, linear [1].
};

}  // namespace insonify::sonar
