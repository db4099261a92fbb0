#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "components/sonar/bins/Detection.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::withEcho;

/** The detection of one ping, whose levels are its bins unless rules say otherwise. */
struct Found {
    Found(const DetectionConfig& config, const types::Sonar& given, const DetectionRules& rules = {}) : ping(given) {
        detector.take(ping, config, rules);
    }
    auto strongest(uint32_t beam) const { return detector.strongest(beam); }
    auto first(uint32_t beam) const { return detector.first(beam); }
    types::Sonar ping;
    Detector detector;
};

TEST(DetectionTest, TheStrongestReturnIsAtTheCentreOfMassOfItsBins) {
    types::Sonar ping = makePing(1, 20, 0);
    ping = withEcho(withEcho(withEcho(ping, 0, 9, 1), 0, 10, 2), 0, 11, 1);
    ping = withEcho(ping, 0, 3, 1.9f);  // another surface, weaker
    const auto found = Found({}, ping).strongest(0);
    ASSERT_TRUE(found);
    const auto power = [](int n) { return std::pow(9.5, n) + 2 * std::pow(10.5, n) + std::pow(11.5, n); };
    EXPECT_NEAR(found->range, power(3) / power(2) * 0.1, 1e-9);
    EXPECT_EQ(found->intensity, 2);
}

TEST(DetectionTest, BinsBelowTheGateDoNotShiftTheReturn) {
    types::Sonar ping = withEcho(withEcho(makePing(1, 20, 0), 0, 10, 1), 0, 11, 0.09f);
    EXPECT_NEAR(Found({}, ping).strongest(0)->range, 1.05, 1e-9);
    DetectionConfig wide;
    wide.gate_db = 20;
    EXPECT_GT(Found(wide, ping).strongest(0)->range, 1.05 + 0.005);
}

TEST(DetectionTest, TheFirstReturnIsTheFirstBinThatReachesTheThreshold) {
    const types::Sonar ping = withEcho(withEcho(makePing(1, 20, 0), 0, 4, 0.05f), 0, 12, 1);
    DetectionConfig config;
    config.threshold_db = -10;
    EXPECT_NEAR(Found(config, ping).first(0)->range, 1.25, 1e-9);
    config.threshold_db = -20;
    EXPECT_NEAR(Found(config, ping).first(0)->range, 0.45, 1e-9);
}

/** The bin that `range_min` divides has echoes of its farther part. */
TEST(DetectionTest, AReturnIsNotNearerThanTheMinRange) {
    DetectionRules rules;
    for (const double range_min : {0.81, 0.85, 0.88, 0.899}) {
        rules.returns.range_min = range_min;
        for (const auto& [bin, expected] : {std::pair{8u, std::max(0.85, range_min)}, {9u, 0.95}}) {
            const Found found({}, withEcho(withEcho(makePing(1, 20, 0), 0, 7, 5), 0, bin), rules);
            EXPECT_NEAR(found.strongest(0)->range, expected, 1e-9) << range_min;
            EXPECT_NEAR(found.first(0)->range, expected, 1e-9) << range_min;
        }
    }
}

TEST(DetectionTest, AWeakBeamInThePingOrBelowTheFloorHasNoReturn) {
    const types::Sonar ping = withEcho(withEcho(makePing(2, 20, 0), 0, 4, 1), 1, 4, 1e-4f);
    DetectionConfig config;
    config.threshold_db = -50;
    EXPECT_TRUE(Found(config, ping).strongest(1));
    config.threshold_db = -30;
    EXPECT_FALSE(Found(config, ping).strongest(1));
    EXPECT_FALSE(Found(config, ping).first(1));
    config.floor_db = 10;
    EXPECT_FALSE(Found(config, ping).strongest(0));
}

TEST(DetectionTest, SilentAndUnknownBinsAreNoReturns) {
    types::Sonar ping = makePing(1, 20, 0);
    EXPECT_FALSE(Found({}, ping).strongest(0));
    EXPECT_FALSE(Found({}, ping).first(0));
    ping = withEcho(withEcho(ping, 0, 2, std::numeric_limits<float>::quiet_NaN()), 0, 8, 1);
    EXPECT_NEAR(Found({}, ping).strongest(0)->range, 0.85, 1e-9);
    EXPECT_NEAR(Found({}, ping).first(0)->range, 0.85, 1e-9);
    ping.bins.assign(20, std::numeric_limits<float>::quiet_NaN());
    EXPECT_FALSE(Found({}, ping).strongest(0));
}

TEST(DetectionTest, SpreadingAndAbsorptionAreRemovedFirst) {
    types::Sonar ping = makePing(1, 200, 0);  // bins of 0.1 m
    for (size_t k = 0; k < 200; ++k) {        // uniform water of level -60 dB without spreading
        const double range = 0.1 * (static_cast<double>(k) + 0.5);
        ping.bins[k] = static_cast<float>(1e-6 / (range * range) * std::pow(10, -0.05 * range));
    }
    ping = withEcho(ping, 0, 150, 1e-3f / (15.05f * 15.05f) * std::pow(10.0f, -0.05f * 15.05f));
    DetectionConfig config;
    config.threshold_db = -20;
    EXPECT_LT(Found(config, ping).first(0)->range, 1) << "the near water is louder";
    const DetectionRules rules{{.spreads = true, .loss_db_per_m = 0.25}, {}};
    EXPECT_NEAR(Found(config, ping, rules).first(0)->range, 15.05, 1e-9);
    EXPECT_NEAR(Found(config, ping, rules).strongest(0)->range, 15.05, 1e-9);
}

TEST(DetectionTest, RingDownBlankedBinsAndWaterAreNoReturns) {
    types::Sonar ping = makePing(1, 100, 0);
    const DetectionRules rules{{.range_min = 0.5, .ring_down_db = 20, .ring_down_db_per_m = 20},
                               std::vector<float>(100, 1e-3f)};
    const double decay = 2 * std::numbers::ln10;  // of intensity [1/m]
    for (size_t k = 0; k < 100; ++k) {
        const double from = 0.1 * static_cast<double>(k), to = from + 0.1;
        const double rung = 100 * (std::exp(-decay * from) - std::exp(-decay * to)) / (decay * 0.1);
        ping.bins[k] = static_cast<float>(rung + 0.9e-3);
    }
    EXPECT_FALSE(Found({}, ping, rules).first(0));
    EXPECT_FALSE(Found({}, ping, rules).strongest(0));
    ping.bins[3] += 1e4f;  // blanked
    ping.bins[6] += 0.1f;  // below the ring-down, which is 5 there
    ping.bins[60] += 2e-3f;
    EXPECT_NEAR(Found({}, ping, rules).first(0)->range, 6.05, 1e-9);
    EXPECT_NEAR(Found({}, ping, rules).strongest(0)->range, 6.05, 1e-9);
}

}  // namespace
}  // namespace insonify::sonar
