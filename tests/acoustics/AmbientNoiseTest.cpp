#include <gtest/gtest.h>

#include <cmath>

#include "components/acoustics/AmbientNoise.hpp"

namespace insonify::acoustics {
namespace {

TEST(AmbientNoiseTest, ThermalNoiseOfMellenRemainsAtSonarFrequencies) {
    for (const auto& [frequency, level] : {std::pair(300.0, 34.6), {700.0, 41.9}, {1200.0, 46.6}}) {
        EXPECT_NEAR(coatesSpectrumDb(frequency, 5, 0.5), level, 0.06) << frequency;
        EXPECT_GE(coatesSpectrumDb(frequency, 5, 0.5), -75 + 20 * std::log10(1e3 * frequency)) << frequency;
    }
}

TEST(AmbientNoiseTest, WindShipsAndTurbulenceDominateTheirBands) {
    EXPECT_GT(coatesSpectrumDb(10, 15, 0.5), coatesSpectrumDb(10, 0, 0.5) + 20);
    EXPECT_GT(coatesSpectrumDb(0.1, 0, 1), coatesSpectrumDb(0.1, 0, 0) + 15);
    EXPECT_NEAR(coatesSpectrumDb(0.001, 0, 0), 17 + 90, 1);
}

}  // namespace
}  // namespace insonify::acoustics
