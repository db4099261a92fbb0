#pragma once
#include <array>
#include <vector>

#include "components/study/CodedPing.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::study {

/** The speckle of a ping: each bin's intensity relative to its mean without speckle. */
struct SpeckleField {
    size_t beam_count = 0, bin_count = 0;
    std::vector<double> relative;  ///< Beam-first [1]; NaN for bins without a known mean.

    double at(size_t beam, size_t bin) const { return relative[beam * bin_count + bin]; }
};

/** Divides by known means: bins of the same ping without speckle. NaN where these are 0.
 *  @throws std::invalid_argument for pings of different shape */
SpeckleField overMeans(const types::Sonar& ping, const types::Sonar& means);

/** Divides by the mean of the surrounding patch of 16 x 16 bins, if it is one kind of bottom: its quarters differ by at
 *  most a quarter, and at most 2 % of its bins have code 0 or the max code. Other patches are NaN. Because the mean is
 *  an estimate, the scintillation index is too low by 2 over the number of independent bins in a patch.
 *  @param alike replaces the quarter: with a quarter, patches that differ more because of few scatterers are lost */
SpeckleField overPatches(const CodedPing& ping, double alike = 0.25);
SpeckleField overPatches(const types::Sonar& intensities);

/** Echoes and noise have different shares at different ranges, so a field is described by eighths of the range. */
constexpr size_t speckle_slices = 8;
/** Returns the same field, NaN except in one eighth of its bins. */
SpeckleField getSlice(const SpeckleField& field, size_t slice);
/** Returns the eighth with the max mean intensity, in which the share of noise is smallest. */
size_t loudestSlice(const CodedPing& ping);
size_t loudestSlice(const types::Sonar& intensities);

constexpr size_t speckle_lags = 9;  ///< Number of lags of a correlation curve, from 0 on.
using LagCurve = std::array<double, speckle_lags>;

/** A number and its standard error, by the jackknife over blocks of 16 x 16 bins. */
struct Estimate {
    double value, error;
};

/** Statistics of a field. */
struct SpeckleFigures {
    double bins = 0;           ///< Number of bins with a value [1].
    double independent = 0;    ///< The number of independent bins: `bins` over the sums of both curves below.
    double contrast = 0;       ///< Deviation over mean of the amplitude; Rayleigh 0.523.
    Estimate scintillation{};  ///< Variance over squared mean of the intensity; Rayleigh 1.
    /** 1 / shape of the K law, by <I ln I> / <I> - <ln I> - 1 (Blacknell and Tough 2001): 0 for Rayleigh, negative for
     *  averaged looks. Depends less on the tail than the scintillation index, and has no bound at 20. */
    Estimate texture{};
    double rayleigh_distance = 0;  ///< Kolmogorov-Smirnov distance from the exponential law, times sqrt(independent).
    LagCurve along{}, across{};    ///< Correlation of intensities at each lag of bins and of beams.

    double shape() const { return 1 / texture.value; }  ///< Shape of the K law; negative: none.
};

/** @throws std::invalid_argument if fewer than four blocks of a field have bins */
SpeckleFigures computeFigures(const SpeckleField& field);

/** The correlation of amplitudes, and of intensities, of the same bins of two pings. */
struct Likewise {
    double amplitudes = 0, intensities = 0;

    double frozen() const { return amplitudes; }
    /** Returns the fraction of the mean intensity that is new in each ping. It assumes that the common and the new part
     *  are complex Gaussian fields; the intensities of their sum correlate by the square of the common fraction. */
    double noiseShare() const;
};

/** Compares the bins that both fields have. */
Likewise likewise(const SpeckleField& a, const SpeckleField& b);

/** Critical value of the exponential law at 1 %: exceeded in one case of 100. */
inline constexpr double rayleigh_distance_limit = 1.628;

}  // namespace insonify::study
