#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/sonar/echo/Detection.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::sonar {
namespace {

using test::pingOf;
using test::withEcho;

TEST(DetectionTest, TheStrongestReturnIsAtTheCentreOfMassOfItsBins) {
    types::Sonar ping = pingOf(1, 20, 0);
    ping = withEcho(withEcho(withEcho(ping, 0, 9, 1), 0, 10, 2), 0, 11, 1);
    ping = withEcho(ping, 0, 3, 1.9f);  // another surface, weaker
    const auto found = Detector({}, ping).strongest(0);
    ASSERT_TRUE(found);
    const auto power = [](int n) { return std::pow(9.5, n) + 2 * std::pow(10.5, n) + std::pow(11.5, n); };
    EXPECT_NEAR(found->range, power(3) / power(2) * 0.1, 1e-9);
    EXPECT_EQ(found->intensity, 2);
}

TEST(DetectionTest, BinsBelowTheGateDoNotShiftTheReturn) {
    types::Sonar ping = withEcho(withEcho(pingOf(1, 20, 0), 0, 10, 1), 0, 11, 0.09f);
    EXPECT_NEAR(Detector({}, ping).strongest(0)->range, 1.05, 1e-9);
    DetectionConfig wide;
    wide.gate_db = 20;
    EXPECT_GT(Detector(wide, ping).strongest(0)->range, 1.05 + 0.005);
}

TEST(DetectionTest, TheFirstReturnIsTheFirstBinThatReachesTheThreshold) {
    const types::Sonar ping = withEcho(withEcho(pingOf(1, 20, 0), 0, 4, 0.05f), 0, 12, 1);
    DetectionConfig config;
    config.threshold_db = -10;
    EXPECT_NEAR(Detector(config, ping).first(0)->range, 1.25, 1e-9);
    config.threshold_db = -20;
    EXPECT_NEAR(Detector(config, ping).first(0)->range, 0.45, 1e-9);
}

TEST(DetectionTest, AWeakBeamInThePingOrBelowTheFloorHasNoReturn) {
    const types::Sonar ping = withEcho(withEcho(pingOf(2, 20, 0), 0, 4, 1), 1, 4, 1e-4f);
    DetectionConfig config;
    config.threshold_db = -50;
    EXPECT_TRUE(Detector(config, ping).strongest(1));
    config.threshold_db = -30;
    EXPECT_FALSE(Detector(config, ping).strongest(1));
    EXPECT_FALSE(Detector(config, ping).first(1));
    config.floor_db = 10;
    EXPECT_FALSE(Detector(config, ping).strongest(0));
}

TEST(DetectionTest, SilentAndUnknownBinsAreNoReturns) {
    types::Sonar ping = pingOf(1, 20, 0);
    EXPECT_FALSE(Detector({}, ping).strongest(0));
    EXPECT_FALSE(Detector({}, ping).first(0));
    ping = withEcho(withEcho(ping, 0, 2, std::numeric_limits<float>::quiet_NaN()), 0, 8, 1);
    EXPECT_NEAR(Detector({}, ping).strongest(0)->range, 0.85, 1e-9);
    EXPECT_NEAR(Detector({}, ping).first(0)->range, 0.85, 1e-9);
    ping.bins.assign(20, std::numeric_limits<float>::quiet_NaN());
    EXPECT_FALSE(Detector({}, ping).strongest(0));
}

}  // namespace
}  // namespace insonify::sonar
