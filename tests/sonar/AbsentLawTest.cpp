// Sonars with one law of a beam pattern and without the others (ACOUSTICS.md 5.9).
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "components/sonar/multipath/OtherSonars.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Weightings.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Weighting;
using std::numbers::pi;
using test::getLaw;
using test::makePing;
using types::radians;

constexpr double depth = 4, from = 14, to = 20;  // of a flat bottom, and the slant ranges that are compared [m]

SonarConfig litFan(int beams, double width_deg) {
    SonarConfig config =
        test::getSonar({.beams = beams, .width_deg = width_deg, .height_deg = 40, .bins = 220, .rows = 512});
    config.quality.columns_per_beam = 2;
    return config;
}

double computePower(const acoustics::BeamLaw& law, double azimuth) {
    return acoustics::BeamPattern(law).power(std::remainder(azimuth, 2 * pi), 0);
}

/** Returns the integral of the transmit law over a beam's box [rad]. */
double sentInto(const acoustics::BeamLaw& law, double bearing, double width) {
    return test::integral(bearing - width / 2, bearing + width / 2, [&](double a) { return computePower(law, a); });
}

double heardBy(const types::Sonar& ping, size_t beam) {
    double sum = 0;
    for (size_t k = 0; k < ping.bin_count; ++k) {
        const double r = ping.binStart(static_cast<double>(k));
        if (r > from - 1e-6 && r < to - 1e-6) sum += double{ping.bins[beam * ping.bin_count + k]};
    }
    return sum;
}

/** Every beam has the energy of its box times what is sent: mu H^2 (r1^-4 - r2^-4) / 4 times the integral. Returns
 *  whether any beam was compared. */
bool expectBoxes(const SonarConfig& config, double tolerance) {
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-static_cast<float>(depth))}));
    const types::Sonar ping = makePing(config, snapshot);
    const double ring = depth * depth * test::inverseFourth(from, to);
    bool compared = false;
    for (size_t row = 0; row < ping.beam_count; ++row) {
        const double into =
            sentInto(*config.beam_pattern->transmit.azimuth, ping.bearings[row].rad, radians(config.beamWidthDeg()));
        const double reach = std::abs(ping.bearings[row].rad) + radians(config.beamWidthDeg()) / 2;
        if (into < 1e-4 || reach > pi / 2) continue;  // nothing is sent behind the array
        compared = true;
        EXPECT_NEAR(heardBy(ping, row) / (ring * into), 1, tolerance) << "beam " << row;
    }
    return compared;
}

TEST(AbsentLawTest, WithoutAReceiveLawEachBeamHearsItsBoxTimesWhatIsSent) {
    for (const double width_deg : {60.0, 8.0}) {
        SonarConfig config = litFan(6, 30);
        config.beam_pattern.emplace().transmit.azimuth = getLaw(Weighting::Gaussian, width_deg);
        for (const SonarConfig& way : test::everyRenderer(config)) EXPECT_TRUE(expectBoxes(way, 0.01));
    }
}

/** Tables with gaps, overlaps, beams across +-180 degrees and rings; and regular fans all round. */
TEST(AbsentLawTest, BoxesOfAnyTableOfBearingsHearWhatIsSentIntoThem) {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int compared = 0;
    for (int trial = 0; trial < 12; ++trial) {
        SonarConfig config = litFan(36, 360);
        config.visibility = Visibility::Cpu;
        if (trial > 0) {
            config.field_of_view_deg.reset();
            config.beam_width_deg = between(2, 15);
            const double step = trial % 3 == 0 ? 30 : between(3, 20),
                         first = trial % 2 == 0 ? -step * 6 : between(-180, 180);
            for (int i = 0; i < 12; ++i)
                config.bearings_deg.push_back(std::remainder(first + i * step + between(-1, 1), 360));
            std::ranges::shuffle(config.bearings_deg, random);
        }
        config.beam_pattern.emplace().transmit.azimuth = getLaw(Weighting::Gaussian, between(40, 150));
        compared += expectBoxes(config, 0.01) ? 1 : 0;
    }
    EXPECT_GT(compared, 6);
}

TEST(AbsentLawTest, APointIsHeardByTheBeamWhoseBoxHoldsItAloneWithAnyGeometryAndWithFields) {
    for (const bool coherent : {false, true})
        for (const BeamGeometry geometry : {BeamGeometry::Planar, BeamGeometry::Conical}) {
            SonarConfig config = litFan(6, 30);
            config.visibility = Visibility::Cpu;
            config.frequency_khz = 600;
            config.beam_geometry = geometry;
            config.beam_pattern.emplace().transmit.azimuth = getLaw(Weighting::Gaussian, 20);
            if (coherent) config.speckle.emplace().coherent = true;
            types::Snapshot snapshot = test::makeSnapshot(test::openWater());
            const double azimuth = radians(-7.3);
            snapshot.targets = {{10.05 * glm::dvec3(std::cos(azimuth), std::sin(azimuth), 0), 0}};
            const types::Sonar ping = makePing(config, snapshot);
            for (size_t beam = 0; beam < 6; ++beam) {
                const double level = heardBy(ping, beam),
                             all = double{*std::max_element(ping.bins.begin() + static_cast<long>(beam * 220),
                                                            ping.bins.begin() + static_cast<long>(beam * 220 + 220))};
                EXPECT_EQ(level, 0);
                if (beam == 1)
                    EXPECT_NEAR(all * std::pow(10.05, 4) / computePower(getLaw(Weighting::Gaussian, 20), azimuth), 1,
                                0.01);
                else
                    EXPECT_EQ(all, 0) << beam;
            }
        }
}

TEST(AbsentLawTest, ASingleBeamAndAGridHaveBoxesToo) {
    AltimeterConfig altimeter;
    altimeter.sonar = litFan(1, 10);
    altimeter.sonar.field_of_view_deg.reset();
    altimeter.sonar.beam_width_deg = 10;
    altimeter.sonar.beam_pattern.emplace().transmit.azimuth = getLaw(Weighting::Gaussian, 12);
    EXPECT_TRUE(expectBoxes(altimeter.beam(), 0.005));
    Sonar3dConfig grid;  // its rows are an upright fan: transmit.elevation is sent along the fan
    grid.sonar = litFan(1, 10);
    grid.sonar.field_of_view_deg.reset();
    grid.vertical = {6, 30};
    grid.horizontal = {4, 160};
    grid.sonar.beam_height_deg = 5;
    grid.sonar.beam_pattern.emplace().transmit.elevation = getLaw(Weighting::Gaussian, 25);
    SonarConfig upright = grid.upright();
    upright.quality.rows = 256;
    EXPECT_TRUE(expectBoxes(upright, 0.005));
}

TEST(AbsentLawTest, ThePlanSaysThatBeamsReceiveBoxesAndTheBeamPrintedIsTheirs) {
    SonarConfig config = litFan(6, 30);
    config.beam_pattern.emplace().transmit.azimuth = getLaw(Weighting::Gaussian, 60);
    SonarRenderer renderer(config, test::openWater());
    EXPECT_THAT(renderer.plan().notices, testing::Contains(testing::HasSubstr("its own 5 deg")));
    const Directivity& pattern = *renderer.renderPlan().directivity;
    EXPECT_NEAR(types::degrees(pattern.halfPowerAzimuth()), 5, 0.01);
    EXPECT_EQ(pattern.azimuth(radians(2.6), 0), 0);
    EXPECT_GT(pattern.azimuth(radians(2.4), 0), 0.99);
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Hann, 3);
    EXPECT_THAT(SonarRenderer(config, test::openWater()).plan().notices,
                testing::Not(testing::Contains(testing::HasSubstr("alike"))));
}

/** With a law of one array about an axis, the other is 1 along it: the pattern is that law, beyond fan and aperture. */
TEST(AbsentLawTest, OneLawInElevationAndAReceiveLawInAzimuthAreTheWholePattern) {
    for (const bool sent : {false, true}) {
        SonarConfig config = litFan(6, 30);
        config.visibility = Visibility::Cpu;
        config.beam_height_deg = 20;
        const acoustics::BeamLaw law = getLaw(Weighting::Gaussian, 30);
        (sent ? config.beam_pattern.emplace().transmit : config.beam_pattern.emplace().receive).elevation = law;
        types::Snapshot snapshot = test::makeSnapshot(test::openWater());
        const double elevation = radians(13);
        snapshot.targets = {{10.05 * glm::dvec3(std::cos(elevation), 0.01, std::sin(elevation)), 0}};
        const types::Sonar ping = makePing(config, snapshot);
        const double heard = test::computeSum(ping);
        EXPECT_NEAR(heard * std::pow(10.05, 4) / computePower(law, elevation), 1, 0.01);
    }
}

TEST(AbsentLawTest, ATransmitterWithoutALawRadiatesEvenlyOverFanAndAperture) {
    SonarConfig config = litFan(6, 30);
    config.beam_pattern.emplace().receive.azimuth = getLaw(Weighting::Hann, 3);
    config.beam_pattern->receive.elevation = getLaw(Weighting::Hann, 10);
    const SentPower sent(config);
    const auto towards = [&](double azimuth_deg, double elevation_deg) {
        const double a = radians(azimuth_deg), e = radians(elevation_deg);
        return sent.towards({std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
    };
    EXPECT_EQ(towards(14, 19), 1);
    EXPECT_EQ(towards(16, 0), 0);
    EXPECT_EQ(towards(180, 0), 0);
    EXPECT_EQ(towards(0, 21), 0);
}

}  // namespace
}  // namespace insonify::sonar
