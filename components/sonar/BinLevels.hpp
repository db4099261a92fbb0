#pragma once
#include <span>
#include <vector>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/SonarConfig.hpp"

namespace insonify::sonar {

/** Turns what was accumulated in a bin into the intensity that reaches the receiver.
 *
 *  For `physical`, A_j = sum of mu cos(theta) dOmega (r_j/r)^2 over the samples of bin j, r_j being its centre, and
 *  10 log10(E_j/S0) = 10 log10 A_j - 20 log10 r_j - 2 alpha r_j. For `cerqueira2017`, A_j is the mean of S and passes
 *  through. */
class BinLevels {
public:
    BinLevels(const SonarConfig& config, const BinGrid& grid);

    /** One beam: bin_count accumulated values in, as many intensities out, at most the largest float; a value that is
     *  not positive is no echo. Allocates nothing. */
    void apply(std::span<const double> accumulated, std::span<float> bins) const;

    /** Spreading and absorption of bin j [dB]. */
    double levelDb(int j) const { return level_db_[static_cast<size_t>(j)]; }

private:
    std::vector<double> level_db_;  ///< [dB]
    std::vector<double> factor_;    ///< The same, linear [1].
};

}  // namespace insonify::sonar
