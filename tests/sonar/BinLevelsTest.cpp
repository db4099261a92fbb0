#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BinLevels.hpp"

namespace insonify::sonar {
namespace {

SonarConfig sonarOf(double range, int bins) {
    SonarConfig config;
    config.range = range;
    config.bin_count = bins;
    config.range_rounding = RangeRounding::Exact;
    return config;
}

std::vector<float> levels(const SonarConfig& config, const std::vector<double>& accumulated) {
    std::vector<float> bins(accumulated.size());
    BinLevels(config, makeBinGrid(config)).apply(accumulated, bins);
    return bins;
}

TEST(BinLevelsTest, IntensityFallsWithSpreadingAndAbsorption) {
    SonarConfig config = sonarOf(4, 2);  // middles at 1 and 3 m
    config.absorption.emplace().db_per_m = 0.5;
    const auto bins = levels(config, {0.2, 0.2});
    EXPECT_NEAR(bins[0], 0.2 * std::pow(10, -0.1), 1e-7);
    EXPECT_NEAR(bins[1], 0.2 / 9 * std::pow(10, -0.3), 1e-8);
}

TEST(BinLevelsTest, TwoMegahertzAtFourHundredMetresKeepsItsLevel) {
    SonarConfig config = sonarOf(400, 800);
    config.water = WaterConfig{10, 35, 10, 8.1};
    config.absorption = AbsorptionConfig{{}, AbsorptionLaw::FrancoisGarrison, 2000};
    config.output = Output::LevelDb;
    const float level = levels(config, std::vector<double>(800, 0.01)).back();
    const double r = 399.75;
    const double expected = -20 - 20 * std::log10(r) - 2 * francoisGarrison(2000, *config.water) * r;
    EXPECT_LT(expected, -1000);
    EXPECT_NEAR(level, expected, 0.01);
}

TEST(BinLevelsTest, GainThatMakesUpForAThousandDecibelsStaysFinite) {
    SonarConfig config = sonarOf(400, 800);
    config.absorption.emplace().db_per_m = 1.25;
    config.tvg = TvgConfig{.log_coefficient = 20, .db_per_m = 1.25, .max_db = 1000};
    for (const float bin : levels(config, std::vector<double>(800, 0.01))) {
        EXPECT_TRUE(std::isfinite(bin));
        EXPECT_GE(bin, 0);
    }
    // Where the gain is not clamped it makes up for spreading and absorption to the last digit.
    EXPECT_NEAR(levels(config, std::vector<double>(800, 0.01))[600], 0.01, 1e-8);
}

TEST(BinLevelsTest, AtGainOneHalfACellOfSandFaceOnIsOneAtEveryRange) {
    SonarConfig config = sonarOf(40, 400);
    config.beam_count = 120;  // of 1 deg
    const double mu = std::pow(10, -1.67), width = std::numbers::pi / 180;
    std::vector<double> sand;
    for (int j = 0; j < 400; ++j) sand.push_back(mu * width * 0.1 / ((j + 0.5) * 0.1));  // a flat bottom is sin^2 of it
    for (const double gain : {0.5, 0.25, 0.0}) {
        config.gain = gain;
        for (const float bin : levels(config, sand)) EXPECT_NEAR(bin, 2 * gain, 1e-5);
    }
    config.gain = 0.5;
    config.absorption.emplace().db_per_m = 0.3;
    EXPECT_NEAR(levels(config, sand).back(), std::pow(10, -0.06 * 39.95), 1e-6) << "absorption is not made up for";
    config.absorption.reset();
    for (double& strong : sand) strong *= 20;
    for (const float bin : levels(config, sand)) EXPECT_EQ(bin, 1);
}

TEST(BinLevelsTest, ThePublishedModelIsScaledByTwiceTheGainAndClippedAtOne) {
    SonarConfig config = sonarOf(4, 3);
    config.model = Model::Cerqueira2017;
    config.gain = 0.75;
    EXPECT_EQ(levels(config, {0, 0.5, 0.9}), (std::vector<float>{0, 0.75f, 1}));
}

TEST(BinLevelsTest, HugeGainIsClamped) {
    SonarConfig config = sonarOf(100, 10);
    config.tvg = TvgConfig{.log_coefficient = 1000, .db_per_m = 1000, .max_db = 40};
    const BinLevels clamped(config, makeBinGrid(config));
    EXPECT_NEAR(clamped.levelDb(9), 40 - 20 * std::log10(95), 1e-9);
    config.tvg->max_db = 1000;
    EXPECT_EQ(levels(config, std::vector<double>(10, 1.0)).back(), std::numeric_limits<float>::max());
}

TEST(BinLevelsTest, NoEchoIsTheFloorInDecibelsAndZeroInIntensity) {
    SonarConfig config = sonarOf(100, 1);
    EXPECT_EQ(levels(config, {0})[0], 0);
    config.output = Output::LevelDb;
    EXPECT_EQ(levels(config, {0})[0], -3000);
    config.absorption.emplace().db_per_m = 1000;
    EXPECT_EQ(levels(config, {1})[0], -3000);
}

TEST(BinLevelsTest, ReceivedLevelAddsTheSourceLevel) {
    SonarConfig config = sonarOf(20, 1);
    config.source_level_db = 210;
    config.output = Output::ReceivedLevelDb;
    EXPECT_NEAR(levels(config, {0.1})[0], 210 - 10 - 20, 1e-4);
    config.output = Output::LevelDb;
    EXPECT_NEAR(levels(config, {0.1})[0], -10 - 20, 1e-4);
}

TEST(BinLevelsTest, NeutralAbsorptionAndGainEqualNone) {
    SonarConfig neutral = sonarOf(50, 100);
    neutral.absorption.emplace().db_per_m = 0;
    neutral.tvg = TvgConfig{};
    const std::vector<double> accumulated(100, 0.3);
    EXPECT_EQ(levels(neutral, accumulated), levels(sonarOf(50, 100), accumulated));
}

TEST(BinLevelsTest, MeansOfThePublishedModelPassThrough) {
    SonarConfig config = sonarOf(50, 3);
    config.model = Model::Cerqueira2017;
    config.absorption.emplace().db_per_m = 1;
    config.tvg = TvgConfig{.log_coefficient = 40};
    EXPECT_EQ(levels(config, {0, 0.25, 1}), (std::vector<float>{0, 0.25f, 1}));
}

}  // namespace
}  // namespace insonify::sonar
