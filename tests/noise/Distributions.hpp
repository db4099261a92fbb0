#pragma once
// Pings with noise, and tests of the distribution of their bins.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "components/noise/Noise.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::noise {

using test::makePing;

inline types::Sonar makeNoisy(const NoiseConfig& config, const types::Sonar& clean) {
    types::Sonar noisy;
    Noise(config).add(clean, noisy);
    return noisy;
}

inline NoiseConfig withSpeckle(const SpeckleConfig& speckle, uint64_t seed = 1) {
    NoiseConfig config;
    config.seed = seed;
    config.speckle = speckle;
    return config;
}

inline NoiseConfig rayleigh(uint64_t seed = 1) { return withSpeckle({}, seed); }
inline NoiseConfig gaussian(double mean, double deviation) {
    return withSpeckle({.law = SpeckleLaw::Gaussian, .mean = mean, .deviation = deviation});
}
inline NoiseConfig gamma(double looks) { return withSpeckle({.law = SpeckleLaw::Gamma, .looks = looks}); }
inline NoiseConfig makeK(double shape) { return withSpeckle({.law = SpeckleLaw::K, .shape = shape}); }
inline NoiseConfig background(double level_db) {
    NoiseConfig config;
    config.additive = AdditiveConfig{level_db};
    return config;
}
inline NoiseConfig withSea(NoiseConfig config, double level_db) {
    config.ambient.emplace().level_db = level_db;
    return config;
}

inline double computeMean(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

inline double computeVariance(const std::vector<float>& values) {
    const double mean = computeMean(values);
    double sum = 0;
    for (const float value : values) sum += (value - mean) * (value - mean);
    return sum / static_cast<double>(values.size());
}

inline double correlation(const float* a, const float* b, size_t count) {
    const std::vector<float> first(a, a + count), second(b, b + count);
    const double first_mean = computeMean(first), second_mean = computeMean(second);
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += (first[i] - first_mean) * (second[i] - second_mean);
    return sum / static_cast<double>(count) / std::sqrt(computeVariance(first) * computeVariance(second));
}

/** Returns values as shares of a distribution: uniform in [0, 1] if they follow it. */
std::vector<double> shares(const std::vector<float>& values, auto cdf) {
    std::vector<double> all;
    for (const float value : values) all.push_back(cdf(value));
    std::sort(all.begin(), all.end());
    return all;
}

/** Returns the max distance between the empirical and the true distribution, times sqrt(n); above 1.95 in 1 case of
 *  1000. */
inline double kolmogorovSmirnov(const std::vector<double>& sorted) {
    const double count = static_cast<double>(sorted.size());
    double worst = 0;
    for (size_t i = 0; i < sorted.size(); ++i)
        worst = std::max(
            {worst, sorted[i] - static_cast<double>(i) / count, static_cast<double>(i + 1) / count - sorted[i]});
    return worst * std::sqrt(count);
}

/** Returns Pearson's statistic over 20 equally probable cells: 19 degrees of freedom, above 43.8 in 1 case of 1000. */
inline double chiSquare20(const std::vector<double>& all) {
    std::array<double, 20> cells{};
    for (const double share : all) cells[std::min<size_t>(19, static_cast<size_t>(share * 20))] += 1;
    const double expected = static_cast<double>(all.size()) / 20;
    double sum = 0;
    for (const double cell : cells) sum += (cell - expected) * (cell - expected) / expected;
    return sum;
}

inline double exponentialCdf(double x) { return 1 - std::exp(-x); }
inline double normalCdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

inline constexpr double ks_limit = 1.95, chi_limit = 43.8;

/** Distribution of the mean of `looks` exponential variates: Erlang's law. */
inline double gammaCdf(double x, int looks) {
    double term = 1, sum = 1;
    for (int k = 1; k < looks; ++k) sum += term *= looks * x / k;
    return 1 - std::exp(-looks * x) * sum;
}

/** Distribution of an exponential variate of gamma distributed mean: 1 - 2/Gamma(nu) (nu x)^(nu/2) K_nu(2 sqrt(nu
 *  x)). */
inline double kCdf(double x, double shape) {
    if (!(x > 0)) return 0;
    return 1 - 2 * std::exp(shape / 2 * std::log(shape * x) - std::lgamma(shape)) *
                   std::cyl_bessel_k(shape, 2 * std::sqrt(shape * x));
}

/** Bounds of the statistics, exceeded in 1 case of 100. */
inline constexpr double ks_one_percent = 1.628, chi_one_percent = 36.19;

}  // namespace insonify::noise
