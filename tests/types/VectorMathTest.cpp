// Functions for vector loops.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "types/geometry/VectorMath.hpp"

namespace insonify::types {
namespace {

TEST(VectorMathTest, TheExponentialIsThatOfTheLibraryToTheLastBit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> wide(-110, 88), near(-1, 0.1f);
    int off = 0;
    constexpr int tries = 100000;
    for (int i = 0; i < tries; ++i) {
        const float x = i % 2 == 0 ? wide(random) : near(random);
        const auto exact = static_cast<float>(std::exp(double{x}));
        const float got = exponential(x);
        ASSERT_LE(std::abs(got - exact), std::max(2e-7f * exact, std::numeric_limits<float>::denorm_min())) << x;
        off += got != exact;
    }
    EXPECT_LT(off, tries / 1000);
}

TEST(VectorMathTest, TheExponentialOfExtremesIsFinite) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(exponential(0), 1);
    EXPECT_EQ(exponential(-0.0f), 1);
    for (const float x : {-104.0f, -1000.0f, -1e30f, -infinity}) EXPECT_EQ(exponential(x), 0) << x;
    EXPECT_GT(exponential(-103), 0);
    EXPECT_TRUE(std::isnan(exponential(std::numeric_limits<float>::quiet_NaN())));
}

}  // namespace
}  // namespace insonify::types
