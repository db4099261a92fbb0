#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "components/sonar/plan/EchoRules.hpp"

namespace insonify::sonar {

/** Converts the sum of a bin into the intensity that reaches the receiver.
 *
 *  For `physical`, A_j = sum of mu cos(theta) dOmega (r_j/r)^2 over the samples of bin j, r_j being its centre, and 10
 *  log10(E_j/S0) = 10 log10 A_j - 20 log10 r_j - 2 alpha r_j. For `cerqueira2017`, A_j is the mean of S and is not
 *  changed. */
class BinLevels {
public:
    BinLevels(const SonarConfig& config, const BinGrid& grid);

    /** Returns the intensity of bin j [1/m^2, relative to the source's at 1 m], at most the largest float. An A_j that
     *  is not positive is no echo. */
    float intensity(size_t j, double accumulated) const {
        constexpr double maximum = static_cast<double>(std::numeric_limits<float>::max());
        return accumulated > 0 ? static_cast<float>(std::min(accumulated * factor_[j], maximum)) : 0.0f;
    }

    /** Returns spreading and absorption of bin j, of intensity [1/m^2]. */
    double factor(size_t j) const { return factor_[j]; }

    /** Returns the loss of energy in the water, one way [Np/m]. */
    double lossOfWater() const { return loss_; }

    /** Fills one beam's bins from its sums in quanta, EchoRules::sumCount() of them, for cells of `solid_angle` [sr].
     *  Returns whether there is any echo. Allocates nothing. */
    bool fill(const EchoRules& rules, const uint64_t* sums, double solid_angle, std::span<float> bins) const;

private:
    double loss_ = 0;             ///< lossOfWater() [Np/m].
    std::vector<double> factor_;  ///< Spreading and absorption of each bin [1].
};

}  // namespace insonify::sonar
