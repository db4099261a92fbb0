// Numbers as pairs of floats, and shares of a cell as sums of positive terms, which replace doubles in the compute
// shader.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "components/sonar/bins/Estimators.hpp"

namespace insonify::sonar {
namespace {

uint32_t floatBitsToUint(float number) { return std::bit_cast<uint32_t>(number); }
float uintBitsToFloat(uint32_t bits) { return std::bit_cast<float>(bits); }
#define precise
#include "shaders/pair.glsl"
#undef precise

double getValue(Pair pair) { return static_cast<double>(pair.high) + static_cast<double>(pair.low); }

/** Numbers of any sign between 1e-6 and 1e6, as pairs and as doubles. */
struct RandomPairs {
    std::mt19937 random{7};
    double number() {
        std::uniform_real_distribution<double> exponent(-6, 6), sign(-1, 1);
        const double size = std::pow(10, exponent(random));
        return sign(random) < 0 ? -size : size;
    }
    static Pair readPair(double number) {
        const auto high = static_cast<float>(number);
        return {high, static_cast<float>(number - static_cast<double>(high))};
    }
};

TEST(PairTest, SumsOfTwoFloatsAreExact) {
    RandomPairs pairs;
    for (int i = 0; i < 10000; ++i) {
        const auto a = static_cast<float>(pairs.number()), b = static_cast<float>(pairs.number());
        const double sum = static_cast<double>(a) + static_cast<double>(b);
        EXPECT_NEAR(getValue(exactSum(a, b)), sum, std::abs(sum) * 0x1p-52) << a << " + " << b;
    }
}

TEST(PairTest, ArithmeticHas44Bits) {
    RandomPairs pairs;
    for (int i = 0; i < 10000; ++i) {
        const Pair a = RandomPairs::readPair(pairs.number()), b = RandomPairs::readPair(pairs.number());
        const double x = getValue(a), y = getValue(b), maximum = std::max(std::abs(x), std::abs(y));
        EXPECT_NEAR(getValue(computeSum(a, b)), x + y, maximum * 0x1p-44);
        EXPECT_NEAR(getValue(product(a, b)), x * y, std::abs(x * y) * 0x1p-44);
        EXPECT_NEAR(getValue(quotient(a, b)), x / y, std::abs(x / y) * 0x1p-44);
        EXPECT_EQ(getValue(negative(a)), -x);
        if (x > 0) {
            EXPECT_NEAR(getValue(root(a)), std::sqrt(x), std::sqrt(x) * 0x1p-44);
        }
    }
}

TEST(PairTest, TheDifferenceToACloseOriginHasAllBitsOfAFloat) {
    RandomPairs pairs;
    for (int i = 0; i < 10000; ++i) {
        const double number = pairs.number();
        const Pair pair = RandomPairs::readPair(number);
        const auto origin = static_cast<float>(number * (1 + 1e-4 * i / 10000));
        const double expected = getValue(pair) - static_cast<double>(origin);
        EXPECT_NEAR(static_cast<double>(beyond(pair, origin)), expected, std::abs(expected) * 0x1p-23) << number;
    }
}

TEST(PairTest, APartOfACellHasTheDifferenceOfItsShares) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> u(0, 1);
    for (int i = 0; i < 10000; ++i) {
        const double wide = std::pow(10, -4 * u(random)),
                     narrow = wide * (i % 10 == 0 ? 1 : std::pow(10, -6 * u(random)));
        const Footprint cell = trapezoidFootprint(1, 1, wide, narrow, 2, 10, 0, 10, 0, 1);
        const double from = wide * (2.4 * u(random) - 1.2), to = from + wide * u(random) * (i % 2 == 0 ? 1e-3 : 1);
        const double expected = trapezoidShare(cell, to) - trapezoidShare(cell, from);
        const double share = partShare(cell, from, to, to - from);
        EXPECT_NEAR(share, expected, 1e-13) << from << " to " << to << " of " << wide << " by " << narrow;
        EXPECT_GE(share, 0);
    }
}

TEST(PairTest, TheEndOfACornerIsNotLostInSinglePrecision) {
    const Footprint cell = trapezoidFootprint(1, 1, 1e-2, 1e-2, 2, 10, 0, 10, 0, 1);
    const double outer = 0.5 * (cell.wide + cell.narrow), tail = 1e-5 * outer;
    const auto far = static_cast<float>(trapezoidShare(cell, outer)),
               near = static_cast<float>(trapezoidShare(cell, outer - tail));
    const double expected = tail * tail * cell.steepness;
    EXPECT_NEAR(partShare(cell, outer - tail, outer, tail), expected, 1e-6 * expected);
    EXPECT_GT(std::abs(static_cast<double>(far - near) - expected), 0.1 * expected)
        << "as a difference of floats it is";
}

}  // namespace
}  // namespace insonify::sonar
