#pragma once
// Allan deviations, of series and in closed form.
#include <cmath>
#include <vector>

namespace insonify::nav {

/** Returns the Allan deviation of a series, from all overlapping averages of a number of samples (IEEE Std 952-1997,
 *  C.1). */
inline double allanDeviation(const std::vector<double>& series, size_t average) {
    std::vector<double> sums(series.size() + 1, 0);
    for (size_t i = 0; i < series.size(); ++i) sums[i + 1] = sums[i] + series[i];
    double squares = 0;
    const size_t count = series.size() - 2 * average + 1;
    for (size_t i = 0; i < count; ++i) {
        const double step = (sums[i + 2 * average] - 2 * sums[i + average] + sums[i]) / static_cast<double>(average);
        squares += step * step;
    }
    return std::sqrt(squares / (2 * static_cast<double>(count)));
}

/** Returns the Allan deviation of white noise over averages of `time` [s]. */
inline double allanOfNoise(double noise_density, double time) { return noise_density / std::sqrt(time); }

/** Returns the Allan deviation of a first-order Gauss-Markov bias over averages of `time` [s]: IEEE Std 952-1997,
 *  C.1. */
inline double allanOfBias(double deviation, double correlation_time, double time) {
    const double x = time / correlation_time;
    return deviation * std::sqrt(2 / x * (1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x)));
}

}  // namespace insonify::nav
