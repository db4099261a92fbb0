// The laws of the noise, compared by moments and by tests of their distributions.
#include <gmock/gmock.h>

#include "tests/noise/Distributions.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::noise {
namespace {

TEST(SpeckleTest, RayleighSpeckleIsExponentialInIntensityWithUnitMean) {
    const types::Sonar noisy = makeNoisy(rayleigh(), makePing(256, 500));
    EXPECT_NEAR(computeMean(noisy.bins), 1, 4 / std::sqrt(128000.0));
    EXPECT_NEAR(computeVariance(noisy.bins), 1, 4 * std::sqrt(8 / 128000.0));  // the scintillation index of one look
    const auto all = shares(noisy.bins, exponentialCdf);
    EXPECT_LT(kolmogorovSmirnov(all), ks_limit);
    EXPECT_LT(chiSquare20(all), chi_limit);
    double decibels = 0;
    for (const float value : noisy.bins) decibels += 10 * std::log10(value) / 128000;
    EXPECT_NEAR(decibels, -2.507, 4 * 5.57 / std::sqrt(128000.0));
}

TEST(SpeckleTest, TheDistributionTestsRejectTheWrongLaw) {
    const types::Sonar noisy = makeNoisy(gaussian(1, 1), makePing(256, 500));
    const auto all = shares(noisy.bins, exponentialCdf);
    EXPECT_GT(kolmogorovSmirnov(all), 10 * ks_limit);
    EXPECT_GT(chiSquare20(all), 10 * chi_limit);
}

TEST(SpeckleTest, GaussianSpeckleIsThePublishedNormalFactor) {
    const types::Sonar noisy = makeNoisy(gaussian(0.4, 0.15), makePing(256, 500));
    EXPECT_NEAR(computeMean(noisy.bins), 0.4,
                4 * 0.15 / std::sqrt(128000.0) + 1e-4);  // clamping lifts the mean a little
    EXPECT_NEAR(computeVariance(noisy.bins) / (0.4 * 0.4), 0.14, 0.003);
    const auto clamped = std::count(noisy.bins.begin(), noisy.bins.end(), 0.0f);
    EXPECT_NEAR(static_cast<double>(clamped) / 128000, 3.8e-3, 6e-4);
}

TEST(SpeckleTest, GammaSpeckleIsTheMeanOfItsLooks) {
    for (const int looks : {1, 2, 4, 16, 100}) {
        const types::Sonar noisy = makeNoisy(gamma(looks), makePing(256, 500));
        EXPECT_NEAR(computeMean(noisy.bins), 1, 4 / std::sqrt(128000.0 * looks)) << looks;
        EXPECT_NEAR(computeVariance(noisy.bins) * looks, 1, 4 * std::sqrt((2 + 6.0 / looks) / 128000)) << looks;
        const auto all = shares(noisy.bins, [&](double x) { return gammaCdf(x, looks); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << looks;
        EXPECT_LT(chiSquare20(all), chi_limit) << looks;
    }
}

TEST(SpeckleTest, KSpeckleIsAnExponentialOfGammaDistributedMean) {
    for (const double shape : {0.3, 1.0, 2.5, 20.0}) {
        const types::Sonar noisy = makeNoisy(makeK(shape), makePing(256, 500));
        const double second = 2 * (1 + 1 / shape);  // moments of a product are products of moments
        const double fourth = 24 * (1 + 1 / shape) * (1 + 2 / shape) * (1 + 3 / shape);
        double square = 0;
        for (const float value : noisy.bins) square += double{value} * value / 128000;
        EXPECT_NEAR(computeMean(noisy.bins), 1, 4 * std::sqrt((second - 1) / 128000)) << shape;
        EXPECT_NEAR(square, second, 4 * std::sqrt((fourth - second * second) / 128000)) << shape;
        const auto all = shares(noisy.bins, [&](double x) { return kCdf(x, shape); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent) << shape;
        EXPECT_LT(chiSquare20(all), chi_limit) << shape;
    }
}

TEST(SpeckleTest, EachLawHasOnlyItsOwnParameters) {
    using testing::ElementsAre, test::countRefusals;
    for (const SpeckleConfig& complete :
         {SpeckleConfig{.law = SpeckleLaw::Gamma, .looks = 4}, {.law = SpeckleLaw::K, .shape = 2}, {}})
        EXPECT_THAT(countRefusals(complete), testing::IsEmpty());
    EXPECT_THAT(countRefusals(SpeckleConfig{.law = SpeckleLaw::Gamma}),
                ElementsAre("looks: is absent; law: gamma needs it"));
    EXPECT_THAT(countRefusals(SpeckleConfig{.law = SpeckleLaw::K}), ElementsAre("shape: is absent; law: k needs it"));
    EXPECT_THAT(countRefusals(SpeckleConfig{.looks = 4}), ElementsAre("looks: is given; it belongs to law: gamma"));
    EXPECT_THAT(countRefusals(SpeckleConfig{.shape = 4}), ElementsAre("shape: is given; it belongs to law: k"));
}

TEST(SpeckleTest, TheNoiseOfTheSeaIsExponentialAtEveryRange) {
    for (const NoiseConfig& config : {withSea({}, -20), withSea(gamma(4), -20), withSea(rayleigh(), -20)}) {
        const types::Sonar noisy = makeNoisy(config, makePing(256, 500, 0));
        EXPECT_NEAR(computeMean(noisy.bins), 0.01, 4 * 0.01 / std::sqrt(128000.0));
        const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 0.01); });
        EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent);
        EXPECT_LT(chiSquare20(all), chi_limit);
    }
}

TEST(SpeckleTest, EchoAndSeaAddAsFieldsIfTheSpeckleIsAField) {
    const types::Sonar noisy = makeNoisy(withSea(rayleigh(), 0), makePing(256, 500, 2));
    const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 3); });
    EXPECT_LT(kolmogorovSmirnov(all), ks_one_percent);
    const types::Sonar looks = makeNoisy(withSea(gamma(16), 0), makePing(256, 500, 2));
    EXPECT_NEAR(computeMean(looks.bins), 3, 0.02);
    EXPECT_NEAR(computeVariance(looks.bins), 4.0 / 16 + 1, 0.03) << "an echo of 16 looks, and noise of one look";
}

TEST(SpeckleTest, AdditiveNoiseIsExponentialWithTheMeanOfItsLevel) {
    const types::Sonar noisy = makeNoisy(background(-20), makePing(256, 500, 0));
    EXPECT_NEAR(computeMean(noisy.bins), 0.01, 4 * 0.01 / std::sqrt(128000.0));
    const auto all = shares(noisy.bins, [](double x) { return exponentialCdf(x / 0.01); });
    EXPECT_LT(kolmogorovSmirnov(all), ks_limit);
    EXPECT_LT(chiSquare20(all), chi_limit);
}

}  // namespace
}  // namespace insonify::noise
