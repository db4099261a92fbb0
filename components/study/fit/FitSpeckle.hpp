#pragma once
#include <vector>

#include "components/study/SpeckleStatistics.hpp"
#include "components/study/fit/FitLevels.hpp"

namespace insonify::study {

/** A statistic and its standard deviation, by the jackknife over sectors of beams; NaN for too few bins. */
struct Measured {
    double value = NAN, error = NAN;

    bool isKnown() const { return std::isfinite(value) && std::isfinite(error); }
    /** Returns whether a correlation of neighbours differs significantly from zero. */
    bool isMoreThanChance() const { return isKnown() && value > z_95 * error && value > 0.02; }
};

/** Correlations of neighbouring bins of recordings, and the deviation of their speckle from Rayleigh's. Correlations
 *  are sums over the first three lags of intensities. */
struct SpeckleMoments {
    Measured echo_beams = {}, echo_bins = {};  ///< In bins with at least three quarters of echoes in the intensity [1].
    Measured noise_beams = {}, noise_bins = {};  ///< In bins with at least three quarters of noise, at lag 1 only [1].
    Measured texture = {};                       ///< 1 / shape of the K law, of echoes and noise together [1].
    double echo_share = 1;                       ///< Mean fraction of echoes in the bins of the texture [1].
    double range = 0;                            ///< Mean range of these bins [m].
};

/** Returns the moments of several pings with equal weight. @param levels separates echoes and noise
 *  @param with_errors false: errors are 0, in a tenth of the time */
SpeckleMoments computeMoments(const std::vector<CodedPing>& pings, const LevelFit& levels, bool with_errors);

/** Returns the highest sidelobe of a beam relative to its axis [dB]: the max level of beams next to isolated targets,
 *  beyond the main lobe; the median over all targets. A target must be unclipped and 25 dB above its surroundings, its
 *  sidelobes 6 dB above them; NaN without a target. @param width_beams of the main lobe at -3 dB [distances of
 *  beams] */
Measured sidelobes(const std::vector<CodedPing>& pings, double width_beams);

/** Returns the sum of the correlations of intensities of beams 1, 2 and 3 spacings apart, for echoes from many places.
 *  It is the square of the autocorrelation of the beam's field (van Cittert and Zernike; Goodman 2007). @param spacing
 *  [rad] */
double beamCorrelation(const acoustics::BeamLaw& law, double spacing);
/** Returns the same for bins along the range. @param bin [m] @param speed_of_sound [m/s] */
double binCorrelation(const acoustics::PulseConfig& pulse, double bin, double speed_of_sound);

/** Returns the argument in [low, high] at which a monotonic function has a value, by bisection on the logarithm of the
 *  argument. */
double argumentAt(double value, double low, double high, const auto& function) {
    const bool rises = function(high) > function(low);
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (function(middle) < value) == rises ? low = middle : high = middle;
    }
    return std::sqrt(low * high);
}

}  // namespace insonify::study
