#include <gtest/gtest.h>

#include <algorithm>

#include "components/noise/Random.hpp"

namespace insonify::noise {
namespace {

TEST(RandomTest, PhiloxMatchesThePublishedAnswers) {
    constexpr uint32_t items = 0xFFFFFFFF;
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({items, items, items, items}, {items, items}),
              (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

/** -ln((bits + 0.5) / 2^32) in double precision, also where u is near 1. */
double exactExponential(uint32_t bits) {
    return bits > 0x80000000u ? -std::log1p(-(static_cast<double>(~bits) + 0.5) * 0x1p-32)
                              : -std::log((static_cast<double>(bits) + 0.5) * 0x1p-32);
}

TEST(RandomTest, TheExponentialIsExactToAMillionthOverItsWholeRange) {
    double worst = 0;
    const auto compare = [&](uint64_t bits) {
        const double exact = exactExponential(static_cast<uint32_t>(bits));
        worst = std::max(worst, std::abs(exponential(static_cast<uint32_t>(bits)) / exact - 1));
    };
    for (uint64_t bits = 0; bits < (uint64_t{1} << 32); bits += 9973) compare(bits);
    for (uint64_t bits = 0; bits < 10000; ++bits)
        compare(bits), compare(0xFFFFFFFF - bits), compare(0xB504F333 + bits - 5000);
    EXPECT_LT(worst, 1e-6);
}

TEST(RandomTest, TheExponentialIsFiniteAndPositiveAtBothEnds) {
    EXPECT_NEAR(exponential(0), 22.9, 0.1);
    EXPECT_GT(exponential(0xFFFFFFFF), 0);
    for (const uint32_t bits : {1u, 0x7fffffffu, 0x80000000u, 0xfffffffeu})
        EXPECT_TRUE(exponential(bits) > 0 && std::isfinite(exponential(bits))) << bits;
}

TEST(RandomTest, NormalsAreOnTheCircleOfBoxAndMuller) {
    double worst = 0;
    for (uint64_t bits = 0; bits < (uint64_t{1} << 32); bits += 99991) {
        const Normals drawn = normals(0x80000000, static_cast<uint32_t>(bits));
        const double radius = std::sqrt(2 * exactExponential(0x80000000));
        const double angle = 2 * std::numbers::pi * (static_cast<double>(bits) + 0.5) * 0x1p-32;
        worst = std::max({worst, std::abs(drawn.first - radius * std::cos(angle)),
                          std::abs(drawn.second - radius * std::sin(angle))});
    }
    EXPECT_LT(worst, 1e-6);
}

}  // namespace
}  // namespace insonify::noise
