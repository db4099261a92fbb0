// Values and rates between keys, against closed forms and differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "components/scene/motion/Animation.hpp"

namespace insonify::scene {
namespace {

template <size_t n>
struct Sample {
    std::array<double, n> value{}, rate{};
};

template <size_t n>
Sample<n> sampleAt(const KeyFrames& keys, double time) {
    Sample<n> sample;
    keys.at(time, sample.value, sample.rate);
    return sample;
}

TEST(KeyFramesTest, LinearKeysAreJoinedByLines) {
    const KeyFrames keys{Interpolation::Linear, false, 3, {1, 3}, {0, 10, -4, 2, 20, 4}};
    const auto half = sampleAt<3>(keys, 2);
    EXPECT_EQ(half.value, (std::array<double, 3>{1, 15, 0}));
    EXPECT_EQ(half.rate, (std::array<double, 3>{1, 5, 4}));
}

TEST(KeyFramesTest, BeforeTheFirstKeyAndAfterTheLastValuesStay) {
    const KeyFrames keys{Interpolation::Linear, false, 3, {1, 3}, {0, 10, -4, 2, 20, 4}};
    EXPECT_EQ(sampleAt<3>(keys, 0.5).value, (std::array<double, 3>{0, 10, -4}));
    EXPECT_EQ(sampleAt<3>(keys, 0.5).rate, (std::array<double, 3>{0, 0, 0}));
    EXPECT_EQ(sampleAt<3>(keys, 3).value, (std::array<double, 3>{2, 20, 4}));
    EXPECT_EQ(sampleAt<3>(keys, 9).value, (std::array<double, 3>{2, 20, 4}));
    EXPECT_EQ(sampleAt<3>(keys, 9).rate, (std::array<double, 3>{0, 0, 0}));
}

TEST(KeyFramesTest, StepsHoldTheKeyBefore) {
    const KeyFrames keys{Interpolation::Step, false, 1, {0, 1, 2}, {5, 6, 7}};
    EXPECT_EQ(sampleAt<1>(keys, 0.999).value[0], 5);
    EXPECT_EQ(sampleAt<1>(keys, 1).value[0], 6);
    EXPECT_EQ(sampleAt<1>(keys, 1.5).rate[0], 0);
}

/** Appendix C of glTF 2.0: p = (2t^3 - 3t^2 + 1) p0 + d (t^3 - 2t^2 + t) m0 + (3t^2 - 2t^3) p1 + d (t^3 - t^2) m1. */
TEST(KeyFramesTest, ACubicSplineIsHermites) {
    const KeyFrames keys{Interpolation::CubicSpline, false, 1, {0, 2}, {9, 1, 3, -1, 4, 9}};
    const double t = 0.25, d = 2;
    const double expected = (2 * t * t * t - 3 * t * t + 1) * 1 + d * (t * t * t - 2 * t * t + t) * 3 +
                            (3 * t * t - 2 * t * t * t) * 4 + d * (t * t * t - t * t) * -1;
    EXPECT_NEAR(sampleAt<1>(keys, 0.5).value[0], expected, 1e-14);
    EXPECT_NEAR(sampleAt<1>(keys, 1e-9).rate[0], 3, 1e-7);
    EXPECT_NEAR(sampleAt<1>(keys, 2 - 1e-9).rate[0], -1, 1e-7);
}

TEST(KeyFramesTest, RotationsTurnTheShorterWayAtAConstantRate) {
    const double half = std::sin(0.4), rest = std::cos(0.4);  // 0.8 rad about y, as -q
    const KeyFrames keys{Interpolation::Linear, true, 4, {0, 2}, {0, 0, 0, 1, 0, -half, 0, -rest}};
    const auto sample = sampleAt<4>(keys, 0.5);
    EXPECT_NEAR(sample.value[1], std::sin(0.1), 1e-15);
    EXPECT_NEAR(sample.value[3], std::cos(0.1), 1e-15);
    NodeShape shape;
    shape.rotation = {sample.value[3], sample.value[0], sample.value[1], sample.value[2]};
    shape.rotation_rate = {sample.rate[3], sample.rate[0], sample.rate[1], sample.rate[2]};
    const glm::dmat4 rate = shape.matrixRate();  // 0.4 rad/s about y
    EXPECT_NEAR(rate[0][0], -0.4 * std::sin(0.2), 1e-15);
    EXPECT_NEAR(rate[0][2], -0.4 * std::cos(0.2), 1e-15);
}

TEST(KeyFramesTest, RatesAreThoseOfDifferences) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int trial = 0; trial < 300; ++trial) {
        KeyFrames keys;
        keys.is_rotation = trial % 2 == 0;
        keys.width = keys.is_rotation ? 4 : 3;
        keys.interpolation = trial % 3 == 0 ? Interpolation::CubicSpline : Interpolation::Linear;
        const size_t per_key = trial % 3 == 0 ? 3 : 1;
        for (int i = 0; i < 4; ++i) keys.times.push_back(i + 0.4 * number(random));
        for (size_t i = 0; i < 4 * per_key * keys.width; ++i) keys.values.push_back(number(random));
        for (size_t key = 0; keys.is_rotation && per_key == 1 && key < 4; ++key) {
            double square = 0;
            for (size_t k = 0; k < 4; ++k) square += keys.values[4 * key + k] * keys.values[4 * key + k];
            for (size_t k = 0; k < 4; ++k) keys.values[4 * key + k] /= std::sqrt(square);
        }
        const double time = 1.5 + number(random), step = 1e-6;
        const auto near = [&](double key) { return std::abs(key - time) < 2 * step; };
        if (std::ranges::any_of(keys.times, near)) continue;
        const auto before = sampleAt<4>(keys, time - step), now = sampleAt<4>(keys, time),
                   after = sampleAt<4>(keys, time + step);
        for (size_t k = 0; k < keys.width; ++k)
            EXPECT_NEAR(now.rate[k], (after.value[k] - before.value[k]) / (2 * step),
                        1e-4 * (1 + std::abs(now.rate[k])))
                << trial;
    }
}

}  // namespace
}  // namespace insonify::scene
