#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {
namespace {

SonarConfig rangedSonar(double range, int bins) {
    SonarConfig config;
    config.range = range;
    config.bin_count = bins;
    config.range_rounding = RangeRounding::Exact;
    return config;
}

std::vector<float> levels(const SonarConfig& config, const std::vector<double>& accumulated) {
    std::vector<float> bins(accumulated.size());
    const BinLevels levels(config, makeBinGrid(config));
    for (size_t j = 0; j < bins.size(); ++j) bins[j] = levels.intensity(j, accumulated[j]);
    return bins;
}

TEST(BinLevelsTest, IntensityFallsWithSpreadingAndAbsorption) {
    SonarConfig config = rangedSonar(4, 2);  // middles at 1 and 3 m
    config.absorption.emplace().db_per_m = 0.5;
    const auto bins = levels(config, {0.2, 0.2});
    EXPECT_NEAR(bins[0], 0.2 * std::pow(10, -0.1), 1e-7);
    EXPECT_NEAR(bins[1], 0.2 / 9 * std::pow(10, -0.3), 1e-8);
}

TEST(BinLevelsTest, AnEchoBelowTheRangeOfFloatsIsZero) {
    SonarConfig config = rangedSonar(400, 800);
    config.water = acoustics::Water{10, 35, 10, 8.1};
    config.absorption = AbsorptionConfig{{}, acoustics::AbsorptionLaw::FrancoisGarrison, 2000};
    const double r = 399.75;
    const double expected = -20 * std::log10(r) - 2 * francoisGarrison(2000, *config.water) * r;
    EXPECT_LT(expected, -1000);
    EXPECT_EQ(levels(config, std::vector<double>(800, 0.01)).back(), 0);
}

TEST(BinLevelsTest, AnIntensityIsAtMostTheMaxFloat) {
    EXPECT_EQ(levels(rangedSonar(0.2, 2), {1e60, 1}).front(), std::numeric_limits<float>::max());
}

TEST(BinLevelsTest, NoEchoIsZero) { EXPECT_EQ(levels(rangedSonar(100, 2), {0, -1}), (std::vector<float>{0, 0})); }

TEST(BinLevelsTest, NeutralAbsorptionEqualsNone) {
    SonarConfig neutral = rangedSonar(50, 100);
    neutral.absorption.emplace().db_per_m = 0;
    const std::vector<double> accumulated(100, 0.3);
    EXPECT_EQ(levels(neutral, accumulated), levels(rangedSonar(50, 100), accumulated));
}

TEST(BinLevelsTest, MeansOfThePublishedModelPassThrough) {
    SonarConfig config = rangedSonar(50, 3);
    config.model = Model::Cerqueira2017;
    config.absorption.emplace().db_per_m = 1;
    EXPECT_EQ(levels(config, {0, 0.25, 1}), (std::vector<float>{0, 0.25f, 1}));
}

}  // namespace
}  // namespace insonify::sonar
