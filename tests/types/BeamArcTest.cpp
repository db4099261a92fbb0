#include <gmock/gmock.h>

#include <limits>

#include "tests/support/Fans.hpp"
#include "types/geometry/BeamArc.hpp"

namespace insonify::types {
namespace {

using test::apart;
using test::emptyPing;
using testing::ElementsAre;

Sonar pingAt(const std::vector<double>& bearings_deg, double width_deg) {
    Sonar ping = test::makePing(static_cast<uint32_t>(bearings_deg.size()), 1);
    for (size_t i = 0; i < bearings_deg.size(); ++i) ping.bearings[i] = Angle::fromDeg(bearings_deg[i]);
    ping.beam_width = Angle::fromDeg(width_deg);
    return ping;
}

TEST(BeamArcTest, OrdersBeamsFromStarboardToPortWithoutUnknownBearings) {
    Sonar ping = emptyPing(90, 3);
    ping.bearings = {Angle{0.5}, Angle{}, Angle{-0.5}};
    const BeamArc arc(ping);
    EXPECT_THAT(arc.beams, ElementsAre(2, 0));
    EXPECT_THAT(arc.bearings, ElementsAre(-0.5, 0.5));
    EXPECT_FALSE(BeamArc(Sonar{}).placeAt(0));
}

TEST(BeamArcTest, EdgesAreHalfABeamBeyondTheOutermostCentres) {
    Sonar ping = emptyPing(120, 60);
    EXPECT_NEAR(BeamArc(ping).left, radians(60), 1e-12);
    ping.beam_width = Angle{};
    EXPECT_NEAR(BeamArc(ping).right, -radians(60), 1e-12);
    EXPECT_TRUE(BeamArc(emptyPing(360, 10)).fullCircle());
    EXPECT_FALSE(BeamArc(emptyPing(350, 10)).fullCircle());
}

TEST(BeamArcTest, AFanAcrossTheSeamIsOneArcAstern) {
    const BeamArc arc(pingAt({-155, 155, 165, 175, -175, -165}, 10));
    EXPECT_THAT(arc.beams, ElementsAre(1, 2, 3, 4, 5, 0));
    EXPECT_NEAR(degrees(arc.right), 150, 1e-9);
    EXPECT_NEAR(degrees(arc.left), 210, 1e-9);
    EXPECT_EQ(arc.beamAt(radians(179)), 3u);
    EXPECT_EQ(arc.beamAt(radians(-179)), 4u);
    EXPECT_EQ(arc.beamAt(radians(-151)), 0u);
    EXPECT_FALSE(arc.beamAt(0));
}

TEST(BeamArcTest, NormalisesBearingsAndTreatsInfiniteBearingsAsUnknown) {
    Sonar ping = emptyPing(30, 3);
    ping.bearings = {Angle{0.1 + 4 * std::numbers::pi}, Angle{std::numeric_limits<double>::infinity()}, Angle{0}};
    const BeamArc arc(ping);
    EXPECT_THAT(arc.beams, ElementsAre(2, 0));
    EXPECT_NEAR(arc.bearings[1], 0.1, 1e-12);
}

TEST(BeamArcTest, ABearingBetweenTwoCentresIsAFractionOfABeam) {
    Sonar ping = emptyPing(1, 3);
    ping.bearings = {Angle{-0.4}, Angle{0}, Angle{0.1}};
    ping.beam_width = {};
    const BeamArc arc(ping);
    EXPECT_DOUBLE_EQ(*arc.placeAt(-0.1), 0.75);
    EXPECT_DOUBLE_EQ(*arc.placeAt(0.05), 1.5);
    EXPECT_DOUBLE_EQ(*arc.placeAt(-0.5), 0);
    EXPECT_DOUBLE_EQ(*arc.placeAt(0.2), 2);
    EXPECT_FALSE(arc.placeAt(1));
}

TEST(BeamArcTest, SectorsMeetHalfWayAndLeaveGapsEmpty) {
    const auto sectors = BeamArc(pingAt({40, -10, 0, 14}, 10)).sectors();
    const double expected[][2] = {{-15, -5}, {-5, 7}, {7, 19}, {35, 45}};
    ASSERT_EQ(sectors.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(degrees(sectors[i].right), expected[i][0], 1e-9) << i;
        EXPECT_NEAR(degrees(sectors[i].left), expected[i][1], 1e-9) << i;
    }
}

TEST(BeamArcTest, EachBearingOfARandomFanHasTheNearestBeamAndGapsHaveNone) {
    for (const test::RandomFan& fan : test::randomFans(20, 1)) {
        const BeamArc arc(fan.ping);
        const auto sectors = arc.sectors();
        for (double bearing = -3.14; bearing < 3.15; bearing += 0.001) {
            const double nearest = test::nearestBeam(fan.ping, bearing);
            const auto beam = arc.beamAt(bearing);
            const auto place = std::ranges::find_if(sectors, [&](const BeamArc::Sector& sector) {
                return arc.turned(bearing) >= sector.right && arc.turned(bearing) < sector.left;
            });
            ASSERT_TRUE(beam || nearest > arc.width / 2 - 1e-9) << fan.name << " " << bearing;
            ASSERT_TRUE(!beam || nearest < arc.width + 1e-9) << fan.name << " " << bearing;
            ASSERT_TRUE(!beam || apart(fan.ping.bearings[*beam].rad, bearing) < nearest + 1e-9) << fan.name;
            if (place == sectors.end()) continue;
            const uint32_t shown = arc.beams[static_cast<size_t>(place - sectors.begin())];
            ASSERT_NEAR(apart(fan.ping.bearings[shown].rad, bearing), nearest, 2e-9) << fan.name;
        }
    }
}

TEST(BeamArcTest, SectorsOfARandomFanAscendWithoutOverlapWithinOneTurn) {
    for (const test::RandomFan& fan : test::randomFans(20, 1)) {
        const BeamArc arc(fan.ping);
        const auto sectors = arc.sectors();
        EXPECT_LE(sectors.back().left - sectors.front().right, 2 * std::numbers::pi + 4e-9) << fan.name;
        for (size_t i = 0; i < sectors.size(); ++i) {
            EXPECT_LE(sectors[i].right, arc.bearings[i]) << fan.name;
            EXPECT_GE(sectors[i].left, arc.bearings[i]) << fan.name;
            EXPECT_GE(sectors[i].right, i > 0 ? sectors[i - 1].left : -10) << fan.name;
        }
    }
}

TEST(BeamArcTest, AFullCircleIsContinuousAcrossItsSeam) {
    for (const bool narrow : {false, true}) {
        Sonar ping = emptyPing(360, 36);
        if (narrow) ping.beam_width = Angle::fromDeg(6);  // joined, with gaps of less than a width
        const BeamArc arc(ping);
        EXPECT_TRUE(arc.isRing());
        EXPECT_TRUE(arc.fullCircle());
        for (int i = 0; i < 720; ++i) {
            const double bearing = Angle::fromDeg(i * 0.5 - 179.9).rad;
            const std::optional<double> place = arc.placeAt(bearing);
            ASSERT_TRUE(place) << bearing;
            const double low = std::floor(*place), share = *place - low, step = 2 * std::numbers::pi / 36;
            const double from = arc.bearings[static_cast<size_t>(low) % 36] + share * step;
            EXPECT_NEAR(std::remainder(from - bearing, 2 * std::numbers::pi), 0, 1e-9);
            const double nearest = arc.bearings[static_cast<size_t>(std::lround(*place)) % 36];
            EXPECT_EQ(ping.bearings[*arc.beamAt(bearing)].rad, std::remainder(nearest, 2 * std::numbers::pi));
        }
    }
    EXPECT_FALSE(BeamArc(emptyPing(350, 36)).isRing());
}

}  // namespace
}  // namespace insonify::types
