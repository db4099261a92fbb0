#pragma once
#include <optional>
#include <vector>

#include "components/study/FitLevels.hpp"
#include "components/study/SpeckleStatistics.hpp"

namespace insonify::study {

/** A statistic, and its deviation by the jackknife over sectors of beams; NaN where too few bins tell of it. */
struct Measured {
    double value = NAN, error = NAN;

    bool isKnown() const { return std::isfinite(value) && std::isfinite(error); }
    /** Whether neighbours share more than nothing, where it is a correlation. */
    bool isMoreThanChance() const { return isKnown() && value > z_95 * error && value > 0.02; }
};

/** What neighbouring bins of recordings have in common, and how far their speckle is from Rayleigh's. Correlations are
 *  sums over the first three lags of intensities. */
struct SpeckleMoments {
    Measured echo_beams = {}, echo_bins = {};    ///< Where echoes are at least three quarters of the intensity [1].
    Measured noise_beams = {}, noise_bins = {};  ///< Where noise is at least three quarters, at lag 1 alone [1].
    Measured texture = {};                       ///< 1 / shape of the K law, of echoes and noise as they are [1].
    double echo_share = 1;                       ///< Mean share of echoes where the texture comes from [1].
    double range = 0;                            ///< Mean range of these bins [m].
};

/** Moments of several pings, each with equal weight. @param levels by which echoes and noise are told apart
 *  @param with_errors false: errors are 0, in a tenth of the time */
SpeckleMoments momentsOf(const std::vector<CodedPing>& pings, const LevelFit& levels, bool with_errors);

/** Highest sidelobe of a beam relative to its axis [dB]: the strongest level of beams beside isolated targets, beyond
 * the main lobe; the median of all targets. NaN where no target stands 25 dB above what is around it, unclipped, so
 * that its sidelobes stand 6 dB above it. @param width_beams of the main lobe at -3 dB [distances of beams] */
Measured sidelobesOf(const std::vector<CodedPing>& pings, double width_beams);

/** Sum of the correlations of intensities of beams 1, 2 and 3 spacings apart, of echoes from many places: the square of
 *  the autocorrelation of the beam's field (van Cittert and Zernike; Goodman 2007). @param spacing [rad] */
double beamCorrelation(const acoustics::BeamLaw& law, double spacing);
/** The same of bins along the range. @param bin [m] @param speed_of_sound [m/s] */
double binCorrelation(const acoustics::PulseConfig& pulse, double bin, double speed_of_sound);

/** The largest or smallest argument in [low, high] at which a falling or rising function has a value, by bisection on
 *  the logarithm of the argument. */
template <class Function>
double argumentAt(double value, double low, double high, const Function& function) {
    const bool rises = function(high) > function(low);
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (function(middle) < value) == rises ? low = middle : high = middle;
    }
    return std::sqrt(low * high);
}

}  // namespace insonify::study
