#pragma once
#include <array>
#include <vector>

#include "components/study/CodedPing.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** What speckle makes of the bins of a ping: each one's intensity over the mean that it would have without. */
struct SpeckleField {
    size_t beam_count = 0, bin_count = 0;
    std::vector<double> relative;  ///< Beam-first [1]; NaN where nothing can be said of a bin.

    double at(size_t beam, size_t bin) const { return relative[beam * bin_count + bin]; }
};

/** Over means that are known: bins of the same ping without speckle. NaN where these are 0.
 *  @throws std::invalid_argument for pings of different shape */
SpeckleField overMeans(const types::Sonar& ping, const types::Sonar& means);

/** Over the mean of the 16 x 16 bins about each, where these are one kind of bottom: quarters of such a patch differ by
 *  a quarter at most, and 2 % of it at most is at code 0 or the largest. Other patches are NaN. A mean that is
 *  estimated from so few takes 2 over the number of independent bins in a patch off the scintillation index.
 *  @param alike in place of the quarter: patches that differ more by their few scatterers are lost with it */
SpeckleField overPatches(const CodedPing& ping, double alike = 0.25);
SpeckleField overPatches(const types::Sonar& intensities);

/** Echoes and noise have different shares at different ranges: a field is told of by eighths of the range. */
constexpr size_t speckle_slices = 8;
/** The same field, NaN but for one eighth of its bins. */
SpeckleField sliceOf(const SpeckleField& field, size_t slice);
/** The eighth with the highest mean intensity, in which noise has the least share. */
size_t loudestSlice(const CodedPing& ping);
size_t loudestSlice(const types::Sonar& intensities);

constexpr size_t speckle_lags = 9;  ///< Of a curve of correlation, from 0 on.
using LagCurve = std::array<double, speckle_lags>;

/** A number, and one standard error of it, by the jackknife over blocks of 16 x 16 bins. */
struct Estimate {
    double value, error;
};

/** Statistics of a field. */
struct SpeckleFigures {
    double bins = 0;           ///< In which there is something to count [1].
    double independent = 0;    ///< The same, less what neighbours share: over the sums of both curves below.
    double contrast = 0;       ///< Deviation over mean of the amplitude; Rayleigh 0.523.
    Estimate scintillation{};  ///< Variance over squared mean of the intensity; Rayleigh 1.
    /** 1 / shape of the K law, by <I ln I> / <I> - <ln I> - 1 (Blacknell and Tough 2001): 0 for Rayleigh, below it for
     *  what has averaged looks. Less of the tail than the scintillation index, and no bound at 20. */
    Estimate texture{};
    double rayleigh_distance = 0;  ///< Kolmogorov and Smirnov's, of the exponential law, times sqrt(independent).
    LagCurve along{}, across{};    ///< Correlation of intensities so many bins and beams apart.

    double shape() const { return 1 / texture.value; }  ///< Of the K law; negative: none.
};

/** @throws std::invalid_argument where fewer than four blocks of a field have bins */
SpeckleFigures figuresOf(const SpeckleField& field);

/** What two pings have in common: the correlation of amplitudes, and of intensities, of the same bins. */
struct Likewise {
    double amplitudes = 0, intensities = 0;

    double frozen() const { return amplitudes; }
    /** Share of the mean intensity that is new in each ping, where both shares are complex Gaussian fields, of which
     *  the intensities of a sum correlate by the square of what is common. */
    double noiseShare() const;
};

/** Of bins that both fields tell of. */
Likewise likewise(const SpeckleField& a, const SpeckleField& b);

/** Of the exponential law at 1 %: above it in one case of 100. */
inline constexpr double rayleigh_distance_limit = 1.628;

}  // namespace insonify::study
