#include <gmock/gmock.h>

#include <algorithm>

#include "components/sonar/beams/HeadScan.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::sonar {
namespace {

using ::testing::ElementsAre;

std::vector<double> bearings(const HeadConfig& config, int pings) {
    HeadScan scan(config);
    std::vector<double> all;
    for (int i = 0; i < pings; ++i) {
        all.push_back(scan.bearingDeg());
        scan.advance();
    }
    return all;
}

TEST(HeadScanTest, ASectorStartsAtItsLeftLimitAndTurnsBackWithoutADoubledPing) {
    EXPECT_THAT(
        bearings({.left_deg = 20, .right_deg = -20, .step_deg = 20, .continuous = {}, .speed_deg_per_s = {}}, 9),
        ElementsAre(20, 0, -20, 0, 20, 0, -20, 0, 20));
}

TEST(HeadScanTest, StaysInASectorThatTheStepDoesNotDivide) {
    EXPECT_THAT(
        bearings({.left_deg = 10, .right_deg = -15, .step_deg = 10, .continuous = {}, .speed_deg_per_s = {}}, 6),
        ElementsAre(10, 0, -10, 0, 10, 0));
}

TEST(HeadScanTest, NoBearingOfASectorIsPingedTwiceInARow) {
    const std::vector<double> all =
        bearings({.left_deg = 45, .right_deg = -45, .step_deg = 0.9, .continuous = {}, .speed_deg_per_s = {}}, 1000);
    EXPECT_THAT(all, testing::Each(testing::AllOf(testing::Le(45), testing::Ge(-45))));
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

TEST(HeadScanTest, AStepOfTheWidthOfTheSectorAlternatesBetweenItsLimits) {
    EXPECT_THAT(bearings({.left_deg = 5, .right_deg = -5, .step_deg = 10, .continuous = {}, .speed_deg_per_s = {}}, 4),
                ElementsAre(5, -5, 5, -5));
}

TEST(HeadScanTest, AFullTurnContinuesToStarboard) {
    EXPECT_THAT(
        bearings({.left_deg = 180, .right_deg = -180, .step_deg = 90, .continuous = {}, .speed_deg_per_s = {}}, 6),
        ElementsAre(180, 90, 0, -90, 180, 90));
}

TEST(HeadScanTest, AContinuousHeadDoesNotLookAtItsRightLimit) {
    const HeadConfig published{
        .left_deg = -180, .right_deg = 179.9, .step_deg = 90, .continuous = true, .speed_deg_per_s = {}};
    EXPECT_THAT(test::countRefusals(published), testing::IsEmpty());
    EXPECT_THAT(bearings(published, 5), ElementsAre(-180, -270, -360, -450, -180));
    EXPECT_EQ(HeadScan(published).pingsPerTurn(), 4);
}

TEST(HeadScanTest, AFullTurnMayTurnBackToo) {
    EXPECT_THAT(
        bearings({.left_deg = 180, .right_deg = -180, .step_deg = 180, .continuous = false, .speed_deg_per_s = {}}, 5),
        ElementsAre(180, 0, -180, 0, 180));
}

TEST(HeadScanTest, BearingsDoNotDriftInAMillionPings) {
    HeadScan scan(HeadConfig{});
    for (int i = 0; i < 1'000'000; ++i) scan.advance();
    EXPECT_NEAR(scan.bearingDeg(), 180, 1e-6);  // 200 steps of 1.8 deg to a turn
}

TEST(HeadScanTest, AStepTakesTimeAtTheHeadsSpeed) {
    HeadConfig config;
    EXPECT_EQ(stepDuration(config), 0);
    config.speed_deg_per_s = 18;
    EXPECT_DOUBLE_EQ(stepDuration(config), 0.1);
}

TEST(HeadScanTest, AHeadStandsOffItsBearingsByTheDeviationAndAgainByTheSameAtEachVisit) {
    HeadConfig config;
    EXPECT_EQ(findStandingDeg(config, 12.6), 12.6);
    config.error_deg = 0.4;
    double sum = 0, squares = 0;
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
        const double bearing = -180 + 0.09 * i, off = findStandingDeg(config, bearing) - bearing;
        sum += off, squares += off * off;
        EXPECT_NEAR(findStandingDeg(config, bearing + 360) - bearing - 360, off, 1e-9);
    }
    EXPECT_NEAR(sum / count, 0, 4 * 0.4 / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count), 0.4, 0.02);
}

}  // namespace
}  // namespace insonify::sonar
