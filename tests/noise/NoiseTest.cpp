#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/noise/Noise.hpp"

namespace insonify::noise {
namespace {

types::Sonar pingOf(uint32_t beams, uint32_t bins, float value = 1, int64_t time = 1000000) {
    types::Sonar ping;
    ping.time.microseconds = time;
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bearings.assign(beams, types::Angle{0});
    ping.bins.assign(size_t{beams} * bins, value);
    return ping;
}

types::Sonar noisyOf(const NoiseConfig& config, const types::Sonar& clean) {
    types::Sonar noisy;
    Noise(config).add(clean, noisy);
    return noisy;
}

NoiseConfig withSpeckle(const SpeckleConfig& speckle, uint64_t seed = 1) {
    NoiseConfig config;
    config.seed = seed;
    config.speckle = speckle;
    return config;
}

NoiseConfig rayleigh(uint64_t seed = 1) { return withSpeckle({}, seed); }
NoiseConfig gaussian(double mean, double deviation) {
    return withSpeckle({.law = SpeckleLaw::Gaussian, .mean = mean, .deviation = deviation});
}
NoiseConfig gammaOf(double looks) { return withSpeckle({.law = SpeckleLaw::Gamma, .looks = looks}); }
NoiseConfig kOf(double shape) { return withSpeckle({.law = SpeckleLaw::K, .shape = shape}); }
NoiseConfig background(double level_db) {
    NoiseConfig config;
    config.additive = AdditiveConfig{level_db};
    return config;
}
NoiseConfig withSea(NoiseConfig config, double level_db) {
    config.ambient.emplace().level_db = level_db;
    return config;
}

double meanOf(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double varianceOf(const std::vector<float>& values) {
    const double mean = meanOf(values);
    double sum = 0;
    for (const float value : values) sum += (value - mean) * (value - mean);
    return sum / static_cast<double>(values.size());
}

double correlation(const float* a, const float* b, size_t count) {
    const std::vector<float> first(a, a + count), second(b, b + count);
    const double first_mean = meanOf(first), second_mean = meanOf(second);
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += (first[i] - first_mean) * (second[i] - second_mean);
    return sum / static_cast<double>(count) / std::sqrt(varianceOf(first) * varianceOf(second));
}

/** Values as shares of a distribution: uniform in [0, 1] if they follow it. */
template <class Cdf>
std::vector<double> shares(const std::vector<float>& values, Cdf cdf) {
    std::vector<double> all;
    for (const float value : values) all.push_back(cdf(value));
    std::sort(all.begin(), all.end());
    return all;
}

/** Largest distance between the empirical and the true distribution, times sqrt(n); above 1.95 in 1 case of 1000. */
double kolmogorovSmirnov(const std::vector<double>& sorted) {
    const double count = static_cast<double>(sorted.size());
    double worst = 0;
    for (size_t i = 0; i < sorted.size(); ++i)
        worst = std::max(
            {worst, sorted[i] - static_cast<double>(i) / count, static_cast<double>(i + 1) / count - sorted[i]});
    return worst * std::sqrt(count);
}

/** Pearson's statistic over 20 equally probable cells: 19 degrees of freedom, above 43.8 in 1 case of 1000. */
double chiSquare20(const std::vector<double>& all) {
    std::array<double, 20> cells{};
    for (const double share : all) cells[std::min<size_t>(19, static_cast<size_t>(share * 20))] += 1;
    const double expected = static_cast<double>(all.size()) / 20;
    double sum = 0;
    for (const double cell : cells) sum += (cell - expected) * (cell - expected) / expected;
    return sum;
}

double exponentialCdf(double x) { return 1 - std::exp(-x); }
double normalCdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

constexpr double ks_limit = 1.95, chi_limit = 43.8;

TEST(NoiseTest, RayleighSpeckleIsExponentialInIntensityWithUnitMean) {
    const types::Sonar noisy = noisyOf(rayleigh(), pingOf(256, 500));
    EXPECT_NEAR(meanOf(noisy.bins), 1, 4 / std::sqrt(128000.0));
    EXPECT_NEAR(varianceOf(noisy.bins), 1, 4 * std::sqrt(8 / 128000.0));  // the scintillation index of one look
    const auto all = shares(noisy.bins, exponentialCdf);
    EXPECT_LT(kolmogorovSmirnov(all), ks_limit);
    EXPECT_LT(chiSquare20(all), chi_limit);
    double decibels = 0;
    for (const float value : noisy.bins) decibels += 10 * std::log10(value) / 128000;
    EXPECT_NEAR(decibels, -2.507, 4 * 5.57 / std::sqrt(128000.0));
}

TEST(NoiseTest, TheDistributionTestsRejectTheWrongLaw) {
    const types::Sonar noisy = noisyOf(gaussian(1, 1), pingOf(256, 500));
    const auto all = shares(noisy.bins, exponentialCdf);
    EXPECT_GT(kolmogorovSmirnov(all), 10 * ks_limit);
    EXPECT_GT(chiSquare20(all), 10 * chi_limit);
}

TEST(NoiseTest, GaussianSpeckleIsThePublishedNormalFactor) {
    const types::Sonar noisy = noisyOf(gaussian(0.4, 0.15), pingOf(256, 500));
    EXPECT_NEAR(meanOf(noisy.bins), 0.4, 4 * 0.15 / std::sqrt(128000.0) + 1e-4);  // clamping lifts the mean a little
    EXPECT_NEAR(varianceOf(noisy.bins) / (0.4 * 0.4), 0.14, 0.003);
    const auto clamped = std::count(noisy.bins.begin(), noisy.bins.end(), 0.0f);
    EXPECT_NEAR(static_cast<double>(clamped) / 128000, 3.8e-3, 6e-4);
}

TEST(NoiseTest, TheGaussianFactorFollowsTheNormalLaw) {
    const types::Sonar noisy = noisyOf(gaussian(10, 1), pingOf(256, 500));  // so far from 0 that nothing is clamped
    const auto all = shares(noisy.bins, [](double x) { return normalCdf(x - 10); });
    EXPECT_LT(kolmogorovSmirnov(all), ks_limit);
    EXPECT_LT(chiSquare20(all), chi_limit);
}

/** Of the mean of `looks` exponential variates: Erlang's law. */
double gammaCdf(double x, int looks) {
    double term = 1, sum = 1;
    for (int k = 1; k < looks; ++k) sum += term *= looks * x / k;
    return 1 - std::exp(-looks * x) * sum;
}

/** Of an exponential variate of gamma distributed mean: 1 - 2/Gamma(nu) (nu x)^(nu/2) K_nu(2 sqrt(nu x)). */
double kCdf(double x, double shape) {
    if (!(x > 0)) return 0;
    return 1 - 2 * std::exp(shape / 2 * std::log(shape * x) - std::lgamma(shape)) *
                   std::cyl_bessel_k(shape, 2 * std::sqrt(shape * x));
}

constexpr double ks_one_percent = 1.628;

TEST(NoiseTest, GammaSpeckleIsTheMeanOfItsLooks) {
    for (const int looks : {1, 2, 4, 16, 100}) {
        const types::Sonar noisy = noisyOf(gammaOf(looks), pingOf(256, 500));
        EXPECT_NEAR(meanOf(noisy.bins), 1, 4 / std::sqrt(128000.0 * looks)) << looks;
        EXPECT_NEAR(varianceOf(noisy.bins) * looks, 1, 4 * std::sqrt((2 + 6.0 / looks) / 128000)) << looks;
        const auto all = shares(noisy.bins, [&](double x) { return gammaCdf(x, looks); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << looks;
        EXPECT_LT(chiSquare20(all), chi_limit) << looks;
    }
}

TEST(NoiseTest, KSpeckleIsAnExponentialOfGammaDistributedMean) {
    for (const double shape : {0.3, 1.0, 2.5, 20.0}) {
        const types::Sonar noisy = noisyOf(kOf(shape), pingOf(256, 500));
        const double second = 2 * (1 + 1 / shape);  // moments of a product are products of moments
        const double fourth = 24 * (1 + 1 / shape) * (1 + 2 / shape) * (1 + 3 / shape);
        double square = 0;
        for (const float value : noisy.bins) square += double{value} * value / 128000;
        EXPECT_NEAR(meanOf(noisy.bins), 1, 4 * std::sqrt((second - 1) / 128000)) << shape;
        EXPECT_NEAR(square, second, 4 * std::sqrt((fourth - second * second) / 128000)) << shape;
        const auto all = shares(noisy.bins, [&](double x) { return kCdf(x, shape); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << shape;
        EXPECT_LT(chiSquare20(all), chi_limit) << shape;
    }
}

TEST(NoiseTest, TheOtherLawsAreHeldToOnePercentToo) {
    const auto distance = [](const NoiseConfig& config, auto cdf) {
        return kolmogorovSmirnov(shares(noisyOf(config, pingOf(256, 500)).bins, cdf));
    };
    EXPECT_LT(distance(rayleigh(), exponentialCdf), ks_one_percent);
    EXPECT_LT(distance(gaussian(10, 1), [](double x) { return normalCdf(x - 10); }), ks_one_percent);
    EXPECT_GT(distance(gammaOf(2), exponentialCdf), 10 * ks_one_percent);
    EXPECT_GT(distance(kOf(2), exponentialCdf), 10 * ks_one_percent);
}

TEST(NoiseTest, TheSeaIsHeardAsAnExponentialIntensityAtEveryRange) {
    for (const NoiseConfig& config : {withSea({}, -20), withSea(gammaOf(4), -20), withSea(rayleigh(), -20)}) {
        const types::Sonar noisy = noisyOf(config, pingOf(256, 500, 0));
        EXPECT_NEAR(meanOf(noisy.bins), 0.01, 4 * 0.01 / std::sqrt(128000.0));
        const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 0.01); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent);
        EXPECT_LT(chiSquare20(all), chi_limit);
    }
}

TEST(NoiseTest, EchoAndSeaAddAsFieldsWhereTheSpeckleIsOne) {
    const types::Sonar noisy = noisyOf(withSea(rayleigh(), 0), pingOf(256, 500, 2));
    const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 3); });
    EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent);
    const types::Sonar looks = noisyOf(withSea(gammaOf(16), 0), pingOf(256, 500, 2));
    EXPECT_NEAR(meanOf(looks.bins), 3, 0.02);
    EXPECT_NEAR(varianceOf(looks.bins), 4.0 / 16 + 1, 0.03) << "an echo of 16 looks, and a noise of one";
}

TEST(NoiseTest, AdditiveNoiseIsExponentialWithTheMeanOfItsLevel) {
    const types::Sonar noisy = noisyOf(background(-20), pingOf(256, 500, 0));
    EXPECT_NEAR(meanOf(noisy.bins), 0.01, 4 * 0.01 / std::sqrt(128000.0));
    const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 0.01); });
    EXPECT_LT(kolmogorovSmirnov(all), ks_limit);
    EXPECT_LT(chiSquare20(all), chi_limit);
}

TEST(NoiseTest, AdditiveNoiseDoesNotFollowTheSpeckle) {
    const types::Sonar added = noisyOf(background(0), pingOf(1, 4096, 0));
    const types::Sonar speckle = noisyOf(rayleigh(), pingOf(1, 4096));
    EXPECT_LT(std::abs(correlation(added.bins.data(), speckle.bins.data(), 4096)), 4 / std::sqrt(4096.0));
}

TEST(NoiseTest, TheSameSeedAndPingGiveTheSameNoise) {
    for (const uint64_t seed : {uint64_t{0}, uint64_t{7}, std::numeric_limits<uint64_t>::max()}) {
        const types::Sonar clean = pingOf(8, 300);
        EXPECT_EQ(noisyOf(rayleigh(seed), clean).bins, noisyOf(rayleigh(seed), clean).bins) << seed;
    }
}

TEST(NoiseTest, BeamsPingsSeedsAndBinsAreUncorrelated) {
    constexpr size_t count = 4096;
    const types::Sonar one = noisyOf(rayleigh(0), pingOf(2, count + 1));
    const types::Sonar later = noisyOf(rayleigh(0), pingOf(2, count + 1, 1, 1000001));
    const types::Sonar other = noisyOf(rayleigh(std::numeric_limits<uint64_t>::max()), pingOf(2, count + 1));
    const types::Sonar high_word = noisyOf(rayleigh(uint64_t{1} << 32), pingOf(2, count + 1));
    const float* bins = one.bins.data();
    const float* others[] = {bins + count + 1, bins + 1, later.bins.data(), other.bins.data(), high_word.bins.data()};
    for (const float* compared : others)
        EXPECT_LT(std::abs(correlation(bins, compared, count)), 4 / std::sqrt(static_cast<double>(count)));
}

TEST(NoiseTest, ABinsNoiseDoesNotDependOnTheNumberOfBeamsOrBins) {
    const types::Sonar small = noisyOf(rayleigh(), pingOf(3, 70)), large = noisyOf(rayleigh(), pingOf(5, 1000));
    for (size_t beam = 0; beam < 3; ++beam)
        for (size_t bin = 0; bin < 70; ++bin) EXPECT_EQ(small.bins[beam * 70 + bin], large.bins[beam * 1000 + bin]);
}

TEST(NoiseTest, AFactorThatWouldBeNegativeIsClampedAndCounted) {
    types::Sonar noisy;
    const uint64_t clamped = Noise(gaussian(0.4, 10)).add(pingOf(100, 100), noisy);
    EXPECT_NEAR(static_cast<double>(clamped) / 10000, normalCdf(-0.04), 0.02);
    EXPECT_GE(*std::min_element(noisy.bins.begin(), noisy.bins.end()), 0);
    EXPECT_EQ(clamped, static_cast<uint64_t>(std::count(noisy.bins.begin(), noisy.bins.end(), 0.0f)));
}

TEST(NoiseTest, NeutralValuesGiveThePingItself) {
    types::Sonar clean = pingOf(4, 300);
    for (size_t i = 0; i < clean.bins.size(); ++i) clean.bins[i] = static_cast<float>(i) * 0.37f;
    for (const NoiseConfig& neutral : {NoiseConfig{}, gaussian(1, 0), background(-3000), withSea({}, -3000)})
        EXPECT_EQ(noisyOf(neutral, clean).bins, clean.bins);
}

TEST(NoiseTest, UnknownBinsStayUnknownAndEmptyOnesEmpty) {
    types::Sonar clean = pingOf(1, 10, 0);
    clean.bins[3] = std::numeric_limits<float>::quiet_NaN();
    for (const NoiseConfig& config :
         {rayleigh(), gammaOf(4), kOf(2), gaussian(0.4, 0.15), background(-20), withSea({}, -20)})
        EXPECT_TRUE(std::isnan(noisyOf(config, clean).bins[3]));
    EXPECT_EQ(noisyOf(rayleigh(), clean).bins[2], 0);
}

TEST(NoiseTest, EverythingButTheBinsIsKept) {
    types::Sonar clean = pingOf(2, 3);
    clean.timestamps = {{1}, {2}};
    clean.bin_duration = {33};
    clean.beam_width = types::Angle{0.1};
    clean.beam_height = types::Angle{0.2};
    clean.bearings = {types::Angle{0.3}, types::Angle{-0.3}};
    clean.speed_of_sound = 1480;
    const types::Sonar noisy = noisyOf(rayleigh(), clean);
    EXPECT_EQ(noisy.time, clean.time);
    EXPECT_EQ(noisy.timestamps, clean.timestamps);
    EXPECT_EQ(noisy.bin_duration, clean.bin_duration);
    EXPECT_EQ(noisy.beam_width.rad, 0.1);
    EXPECT_EQ(noisy.beam_height.rad, 0.2);
    EXPECT_EQ(noisy.bearings[1].rad, -0.3);
    EXPECT_EQ(noisy.speed_of_sound, 1480);
    EXPECT_EQ(noisy.bin_count, 3u);
    EXPECT_EQ(noisy.beam_count, 2u);
}

}  // namespace
}  // namespace insonify::noise
