#include <gtest/gtest.h>

#include <cmath>

#include "components/noise/Ambient.hpp"

namespace insonify::noise {
namespace {

AmbientConfig windy(double wind_m_s) {
    AmbientConfig config;
    config.wind_m_s = wind_m_s;
    config.frequency_khz = 700;
    config.bandwidth_khz = 30;
    config.directivity_index_db = 25;
    config.source_level_db = 210;
    return config;
}

double levelDb(const AmbientConfig& config) { return 10 * std::log10(ambientIntensity(config)); }

TEST(AmbientTest, AtSonarFrequenciesTheThermalNoiseOfMellenIsLeft) {
    for (const auto& [frequency, level] : {std::pair(300.0, 34.6), {700.0, 41.9}, {1200.0, 46.6}}) {
        EXPECT_NEAR(coatesSpectrumDb(frequency, 5, 0.5), level, 0.06) << frequency;
        EXPECT_GE(coatesSpectrumDb(frequency, 5, 0.5), -75 + 20 * std::log10(1e3 * frequency)) << frequency;
    }
}

TEST(AmbientTest, WindShipsAndTurbulenceEachRuleTheirBand) {
    EXPECT_GT(coatesSpectrumDb(10, 15, 0.5), coatesSpectrumDb(10, 0, 0.5) + 20);
    EXPECT_GT(coatesSpectrumDb(0.1, 0, 1), coatesSpectrumDb(0.1, 0, 0) + 15);
    EXPECT_NEAR(coatesSpectrumDb(0.001, 0, 0), 17 + 90, 1);
}

TEST(AmbientTest, ABinHoldsTheBandsNoiseLessTheDirectivityRelativeToTheSource) {
    const double spectrum = coatesSpectrumDb(700, 5, 0.5);
    EXPECT_NEAR(levelDb(windy(5)), spectrum + 10 * std::log10(30e3) - 25 - 210, 1e-9);
    AmbientConfig given;
    given.level_db = -112.5;
    EXPECT_NEAR(levelDb(given), -112.5, 1e-9);
}

TEST(AmbientTest, ALevelOrAllThatTheFormulaNeedsAndNotBoth) {
    const auto faults = [](const AmbientConfig& config) {
        types::Diagnostics diagnostics;
        config.check(diagnostics);
        return diagnostics;
    };
    EXPECT_TRUE(faults(windy(0)).empty());
    ASSERT_EQ(faults({}).size(), 1u);
    EXPECT_EQ(faults({})[0].message, "has no value; give level_db, or wind_m_s, bandwidth_khz and source_level_db");
    AmbientConfig both = windy(3), half = windy(3);
    both.level_db = -100;
    EXPECT_EQ(faults(both).size(), 3u);
    half.bandwidth_khz.reset();
    ASSERT_EQ(faults(half).size(), 1u);
    EXPECT_EQ(faults(half)[0].message, "has no bandwidth_khz; without level_db it must");
}

}  // namespace
}  // namespace insonify::noise
