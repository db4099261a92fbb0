// Errors of sensors, compared with the closed forms of IEEE Std 952-1997.
#include <gmock/gmock.h>

#include "components/nav/ErrorModel.hpp"
#include "tests/nav/Allan.hpp"

namespace insonify::nav {
namespace {

std::vector<double> makeSeries(Axis& axis, size_t count, double step, double truth = 0) {
    std::vector<double> series(count);
    for (size_t i = 0; i < count; ++i)
        series[i] = axis.measure(truth, 0, types::Time::fromSeconds(static_cast<double>(i + 1) * step), step);
    return series;
}

/** Returns five standard deviations of an Allan deviation, as a share of it, for a number of averages (IEEE Std
 *  952-1997, C.1). */
double fiveDeviations(size_t count, size_t average) {
    return 5 / std::sqrt(2 * (static_cast<double>(count) / static_cast<double>(average) - 1));
}

TEST(ErrorModelTest, RandomNumbersAreNormalAndChannelsAreIndependent) {
    constexpr int count = 200'000;
    double sum = 0, squares = 0, fourths = 0, product = 0;
    for (int64_t i = 1; i <= count; ++i) {
        const double x = normal(7, 3, {i * 10'000}), y = normal(7, 4, {i * 10'000});
        sum += x, squares += x * x, fourths += x * x * x * x, product += x * y;
    }
    const double share = std::sqrt(1.0 / count);
    EXPECT_NEAR(sum / count, 0, 5 * share);
    EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2) * share);
    EXPECT_NEAR(fourths / count, 3, 5 * std::sqrt(96) * share);
    EXPECT_NEAR(product / count, 0, 5 * share);
    EXPECT_EQ(normal(7, 3, {10'000}), normal(7, 3, {10'000}));
    EXPECT_NE(normal(7, 3, {10'000}), normal(8, 3, {10'000}));
}

TEST(ErrorModelTest, WhiteNoiseHasTheAllanDeviationOfItsDensity) {
    constexpr double density = 2e-4, step = 0.01;
    constexpr size_t count = 300'000;
    Axis axis({.noise_density = density}, 1, 0);
    const std::vector<double> series = makeSeries(axis, count, step);
    for (const size_t average : {1, 10, 100, 1000, 3000}) {
        const double expected = allanOfNoise(density, step * static_cast<double>(average));
        EXPECT_NEAR(allanDeviation(series, average) / expected, 1, fiveDeviations(count, average)) << average;
    }
}

TEST(ErrorModelTest, AWanderingBiasHasTheAllanDeviationOfGaussAndMarkov) {
    constexpr double deviation = 3e-5, time = 100, step = 1;
    constexpr size_t count = 1'000'000;
    Axis axis({.bias_deviation = deviation, .bias_time = time}, 5, 2);
    const std::vector<double> series = makeSeries(axis, count, step);
    for (const size_t average : {10, 50, 189, 1000, 5000}) {
        const double expected = allanOfBias(deviation, time, step * static_cast<double>(average));
        EXPECT_NEAR(allanDeviation(series, average) / expected, 1, fiveDeviations(count, average) + 0.002) << average;
    }
    EXPECT_NEAR(allanOfBias(1, 100, 189), 0.618, 1e-3) << "its highest";
    EXPECT_GT(allanOfBias(1, 100, 189), allanOfBias(1, 100, 170));
    EXPECT_GT(allanOfBias(1, 100, 189), allanOfBias(1, 100, 210));
}

TEST(ErrorModelTest, ABiasWandersTheSameWayInStepsOfAnyLength) {
    constexpr double deviation = 2, time = 5;
    for (const double step : {0.5, 5.0, 50.0}) {
        WanderingBias bias(deviation, time, 11, 1);
        double squares = 0, product = 0, before = 0;
        constexpr int count = 100'000;
        for (int i = 1; i <= count; ++i) {
            const double now = bias.at(types::Time::fromSeconds(i * step));
            squares += now * now, product += before * now;
            before = now;
        }
        const double kept = std::exp(-step / time), independent = (1 - kept) / (1 + kept) * count;
        EXPECT_NEAR(squares / count / (deviation * deviation), 1, 5 * std::sqrt(2 / independent));
        EXPECT_NEAR(product / count / (deviation * deviation), kept, 5 * std::sqrt(2 / independent));
    }
}

TEST(ErrorModelTest, ABiasIsConstantWhileTimeIs) {
    WanderingBias bias(1, 10, 3, 0);
    const double first = bias.at({1'000'000});
    EXPECT_EQ(bias.at({1'000'000}), first);
    EXPECT_EQ(bias.at({500'000}), first);
    EXPECT_NE(bias.at({2'000'000}), first);
}

TEST(ErrorModelTest, ReadingsAreWholeStepsWithinTheRange) {
    Axis axis({.resolution = 0.25, .range = 2}, 1, 0);
    EXPECT_EQ(axis.measure(1.1, 0, {1}, 1), 1.0);
    EXPECT_EQ(axis.measure(-1.2, 0, {2}, 1), -1.25);
    EXPECT_EQ(axis.measure(1e300, 0, {3}, 1), 2.0);
    EXPECT_EQ(axis.measure(-1e300, 0, {4}, 1), -2.0);
    EXPECT_EQ(axis.measure(1.1, 0.5, {5}, 1), 1.5) << "a bias that stays";
    EXPECT_EQ(Axis({.resolution = 0.4, .range = 1}, 1, 0).measure(5, 0, {1}, 1), 0.8) << "the last step within it";
    Axis exact({}, 1, 0);
    EXPECT_EQ(exact.measure(1.1, 0, {1}, 1), 1.1);
}

TEST(ErrorModelTest, TheVarianceMatchesTheReadings) {
    const AxisErrors errors{.noise_density = 0.02, .bias_deviation = 0.1, .bias_time = 0.1, .resolution = 0.2};
    Axis axis(errors, 9, 0);
    constexpr size_t count = 100'000;
    constexpr double step = 0.02, truth = 0.35;
    double squares = 0;
    for (const double reported : makeSeries(axis, count, step, truth)) squares += std::pow(reported - truth, 2);
    EXPECT_NEAR(squares / count / computeVariance(errors, step), 1, 0.03);
}

TEST(ErrorModelTest, ABiasWandersOnAfterTheClockIsSetBack) {
    WanderingBias bias(2, 5, 11, 1);
    const double before = bias.at(types::Time::fromSeconds(1000));
    EXPECT_EQ(bias.at(types::Time::fromSeconds(400)), before);
    EXPECT_NE(bias.at(types::Time::fromSeconds(401)), before);
}

}  // namespace
}  // namespace insonify::nav
