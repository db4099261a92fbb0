// Each law of the speckle compared with its own distribution, at 1 %, and with those of the other laws, which must
// fail.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "tests/noise/Distributions.hpp"

namespace insonify::noise {
namespace {

constexpr double count = 128000;
constexpr double decibels_per_neper = 10 / std::numbers::ln10;

/** Returns psi(x) = d ln Gamma / dx by its recurrence and, above 20, its asymptotic series. */
double digamma(double x) {
    double sum = 0;
    for (; x < 20; x += 1) sum -= 1 / x;
    return sum + std::log(x) - 1 / (2 * x) - 1 / (12 * x * x) + 1 / (120 * x * x * x * x);
}

double trigamma(double x) {
    double sum = 0;
    for (; x < 20; x += 1) sum += 1 / (x * x);
    return sum + 1 / x + 1 / (2 * x * x) + 1 / (6 * x * x * x) - 1 / (30 * x * x * x * x * x);
}

/** A law, and its theoretical moments. */
struct Law {
    std::string name;
    NoiseConfig config;
    std::function<double(double)> cdf;
    double scintillation;                 ///< Variance over the mean squared.
    double decibel_mean, decibel_spread;  ///< Mean and deviation of 10 log10 of the factor [dB].
};

Law rayleighLaw() {
    return {"rayleigh",
            rayleigh(),
            exponentialCdf,
            1,
            decibels_per_neper * digamma(1),
            decibels_per_neper * std::sqrt(trigamma(1))};
}
Law gammaLaw(int looks) {
    return {"gamma " + std::to_string(looks),
            gamma(looks),
            [looks](double x) { return gammaCdf(x, looks); },
            1.0 / looks,
            decibels_per_neper * (digamma(looks) - std::log(looks)),
            decibels_per_neper * std::sqrt(trigamma(looks))};
}
Law kLaw(double shape) {
    return {"k " + std::to_string(shape),
            makeK(shape),
            [shape](double x) { return kCdf(x, shape); },
            1 + 2 / shape,
            decibels_per_neper * (digamma(1) + digamma(shape) - std::log(shape)),
            decibels_per_neper * std::sqrt(trigamma(1) + trigamma(shape))};
}

std::vector<Law> laws() {
    return {rayleighLaw(), gammaLaw(2), gammaLaw(4), gammaLaw(8), gammaLaw(16), kLaw(1), kLaw(2.5), kLaw(8)};
}

std::vector<float> drawn(const NoiseConfig& config) { return makeNoisy(config, makePing(256, 500)).bins; }

TEST(LawsTest, EachLawFollowsOnlyItsOwnDistribution) {
    for (const Law& law : laws()) {
        const std::vector<float> values = drawn(law.config);
        for (const Law& other : laws()) {
            const auto all = shares(values, other.cdf);
            const std::string which = law.name + " as " + other.name;
            if (law.name == other.name) {
                EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << which;
                EXPECT_LT(chiSquare20(all), chi_one_percent) << which;
            } else {
                EXPECT_GT(kolmogorovSmirnov(all), 3 * ks_one_percent) << which;
                EXPECT_GT(chiSquare20(all), 3 * chi_one_percent) << which;
            }
        }
    }
}

TEST(LawsTest, TheGaussianFactorIsTheNormalLawClampedAtZero) {
    const auto all = [](double mean, double deviation) {
        return shares(drawn(gaussian(10, 1)), [=](double x) { return normalCdf((x - mean) / deviation); });
    };
    EXPECT_LT(kolmogorovSmirnov(all(10, 1)), ks_one_percent);
    EXPECT_LT(chiSquare20(all(10, 1)), chi_one_percent);
    EXPECT_GT(kolmogorovSmirnov(all(10.02, 1)), 2 * ks_one_percent);
    EXPECT_GT(chiSquare20(all(10, 1.02)), 2 * chi_one_percent);
    const std::vector<float> clamped = drawn(gaussian(0.4, 0.4));  // from the mean down to 0 is one deviation
    for (const double x : {0.0, 0.1, 0.4, 0.9})
        EXPECT_NEAR(static_cast<double>(std::ranges::count_if(clamped, [&](float f) { return f <= x; })) / count,
                    normalCdf((x - 0.4) / 0.4), 4 * 0.5 / std::sqrt(count))
            << x;
}

/** Mean and variance, and four standard errors of each. */
struct Moments {
    double mean = 0, variance = 0, mean_bound = 0, variance_bound = 0;
};

Moments computeMoments(const std::vector<double>& values) {
    Moments moments;
    double fourth = 0;
    for (const double value : values) moments.mean += value / count;
    for (const double value : values) moments.variance += std::pow(value - moments.mean, 2) / count;
    for (const double value : values) fourth += std::pow(value - moments.mean, 4) / count;
    moments.mean_bound = 4 * std::sqrt(moments.variance / count);
    moments.variance_bound = 4 * std::sqrt((fourth - moments.variance * moments.variance) / count);
    return moments;
}

TEST(LawsTest, ScintillationAndDecibelsMatchTheory) {
    for (const Law& law : laws()) {
        std::vector<double> factors, levels;
        for (const float value : drawn(law.config)) {
            factors.push_back(value);
            levels.push_back(10 * std::log10(static_cast<double>(value)));
        }
        const Moments factor = computeMoments(factors), level = computeMoments(levels);
        EXPECT_NEAR(factor.mean, 1, factor.mean_bound) << law.name;
        EXPECT_NEAR(factor.variance, law.scintillation, factor.variance_bound) << law.name;
        EXPECT_NEAR(level.mean, law.decibel_mean, level.mean_bound) << law.name;
        EXPECT_NEAR(level.variance, law.decibel_spread * law.decibel_spread, level.variance_bound) << law.name;
    }
}

TEST(LawsTest, QuotedFiguresAreCorrect) {
    EXPECT_NEAR(rayleighLaw().decibel_mean, -2.507, 5e-4);
    EXPECT_NEAR(rayleighLaw().decibel_spread, 5.570, 5e-4);
    for (const auto& [looks, spread] : {std::pair(2, 3.49), {4, 2.31}, {8, 1.58}, {16, 1.10}})
        EXPECT_NEAR(gammaLaw(looks).decibel_spread, spread, 6e-3) << looks;
    double amplitude = 0;
    for (const float value : drawn(rayleigh())) amplitude += std::sqrt(static_cast<double>(value)) / count;
    EXPECT_NEAR(amplitude, 0.8862, 4 * 0.4633 / std::sqrt(count)) << "mean over rms of the amplitude";
    EXPECT_NEAR(std::sqrt(1 - amplitude * amplitude) / amplitude, 0.5227, 0.005) << "its deviation over its mean";
}

/** Returns the share of values above x times the mean. */
double tail(const std::vector<float>& values, double x) {
    return static_cast<double>(std::ranges::count_if(values, [&](float value) { return value > x; })) / count;
}

TEST(LawsTest, TheTailOfKMatchesItsFormulaAndIsFarAboveTheExponential) {
    for (const double shape : {1.0, 2.5, 8.0}) {
        const std::vector<float> values = drawn(makeK(shape));
        for (const double x : {3.0, 6.0, 10.0}) {
            const double expected = 1 - kCdf(x, shape);
            EXPECT_NEAR(tail(values, x), expected, 4 * std::sqrt(expected / count)) << shape << " beyond " << x;
        }
        EXPECT_GT(tail(values, 10), 5 * std::exp(-10.0)) << shape;
    }
    const double beyond_six = std::exp(-6.0);
    EXPECT_NEAR(tail(drawn(rayleigh()), 6), beyond_six, 4 * std::sqrt(beyond_six / count));
}

TEST(LawsTest, ExtremeShapesAreFiniteWithAnExtremeTailOrExponential) {
    const std::vector<float> patchy = drawn(makeK(1e-3));
    EXPECT_TRUE(std::ranges::all_of(patchy, [](float value) { return value >= 0 && std::isfinite(value); }));
    EXPECT_GT(std::ranges::max(patchy), 1e3f);
    EXPECT_LT(tail(patchy, 1e-3), 0.02) << "nearly all is nothing";
    EXPECT_LT(kolmogorovSmirnov(shares(drawn(makeK(1e6)), exponentialCdf)), ks_one_percent);
    const std::vector<float> smooth = drawn(gamma(1e4));
    EXPECT_NEAR(computeVariance(smooth), 1e-4, 0.02e-4);
    EXPECT_LT(kolmogorovSmirnov(shares(smooth, [](double x) { return normalCdf((x - 1) * 1e2); })), 3)
        << "a skew of 0.02 remains";
}

/** Returns the rank correlation of two lists of values, which is insensitive to long tails. */
double rankCorrelation(const Law& law, const float* a, const float* b, size_t size) {
    std::vector<float> first, second;
    for (size_t i = 0; i < size; ++i) {
        first.push_back(static_cast<float>(law.cdf(static_cast<double>(a[i]))));
        second.push_back(static_cast<float>(law.cdf(static_cast<double>(b[i]))));
    }
    return correlation(first.data(), second.data(), size);
}

TEST(LawsTest, BeamsAndPingsOfEveryLawAreIndependent) {
    constexpr uint32_t bins = 4096;
    const double bound = 4 / std::sqrt(static_cast<double>(bins));
    for (const Law& law : laws()) {
        const types::Sonar now = makeNoisy(law.config, makePing(9, bins)),
                           next = makeNoisy(law.config, makePing(9, bins, 1, makePing(1, 1).time.microseconds + 1));
        double worst = 0;
        for (size_t beam = 0; beam < 9; ++beam) {
            const float* here = &now.bins[beam * bins];
            worst = std::max(worst, std::abs(rankCorrelation(law, here, &next.bins[beam * bins], bins)));
            if (beam > 0) worst = std::max(worst, std::abs(rankCorrelation(law, here, &now.bins[0], bins)));
            worst = std::max(worst, std::abs(rankCorrelation(law, here, here + 1, bins - 1)));
        }
        EXPECT_LT(worst, bound) << law.name;
        EXPECT_GT(rankCorrelation(law, &now.bins[0], &now.bins[0], bins), 0.999) << law.name;
    }
}

}  // namespace
}  // namespace insonify::noise
