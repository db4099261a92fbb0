// Rays through layers of water, compared with circles, and files of sound profiles.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "components/acoustics/SoundSpeed.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

SoundProfile linear(double gradient) { return SoundProfile({{0, 1000}, {1500, 1500 + 1000 * gradient}}); }

std::vector<RayPoint> traced(const SoundProfile& profile, double depth, double elevation, std::vector<double> times) {
    std::vector<RayPoint> points(times.size());
    traceRay(profile, depth, elevation, times, points);
    return points;
}

std::vector<double> timesTo(double last, int count) {
    std::vector<double> times;
    for (int i = 1; i <= count; ++i) times.push_back(last * i / count);
    return times;
}

/** Returns the travel time along a circle whose centre is at the depth of speed 0, by its integral over the angle. */
double timeOnCircle(double gradient, double from, double to) {
    return (std::asinh(std::tan(to)) - std::asinh(std::tan(from))) / gradient;
}

TEST(SoundProfileTest, ARayInAGradientIsAnArcOfACircle) {
    for (const double gradient : {0.1, -0.05, 0.01})
        for (const double elevation : {-1.2, -0.2, -0.01, 0.03}) {
            const double depth = 500, c = 1500 + gradient * depth;
            const double radius = c / (gradient * std::cos(elevation));
            const double centre_across = -radius * std::sin(elevation), centre_depth = depth - c / gradient;
            for (const RayPoint& point : traced(linear(gradient), depth, elevation, timesTo(0.25, 5))) {
                const double across = point.across - centre_across, below = point.depth - centre_depth;
                EXPECT_NEAR(std::hypot(across, below), std::abs(radius), 1e-9 * std::abs(radius));
                EXPECT_NEAR(point.speed, 1500 + gradient * point.depth, 1e-9);
                EXPECT_NEAR(std::cos(point.elevation) / point.speed, std::cos(elevation) / c, 1e-15) << "Snell";
            }
            const RayPoint last = traced(linear(gradient), depth, elevation, {0.25}).back();
            EXPECT_NEAR(timeOnCircle(gradient, elevation, last.elevation), 0.25, 1e-9);
        }
}

TEST(SoundProfileTest, StraightRaysAreHundredAndThirtyThreeMetresOffAtTwoKilometres) {
    const SoundProfile profile({{-1000, 1000}, {1400, 1600}});  // 1500 m/s at depth 0
    const RayPoint point = traced(profile, 0, 0, {timeOnCircle(0.1, 0, std::asin(2000.0 / 15000))}).back();
    EXPECT_NEAR(point.across, 2000, 1e-6);
    EXPECT_NEAR(-point.depth, 15000 - std::sqrt(15000.0 * 15000 - 2000.0 * 2000), 1e-6);
    EXPECT_NEAR(-point.depth, 133.9, 0.1);
}

TEST(SoundProfileTest, WaterOfConstantSpeedBendsNoRay) {
    const SoundProfile still({{0, 10, 50}, {1480, 1480, 1480}});
    for (const double depth : {-5.0, 0.0, 20.0, 50.0, 80.0})
        for (const double elevation : {-1.5, -0.3, 0.0, 1.0}) {
            const RayPoint point = traced(still, depth, elevation, timesTo(0.4, 7)).back();
            EXPECT_NEAR(point.across, 1480 * 0.4 * std::cos(elevation), 1e-9);
            EXPECT_NEAR(point.depth, depth - 1480 * 0.4 * std::sin(elevation), 1e-9);
        }
}

/** The same ray by ten thousand straight pieces that turn by Snell's law. */
RayPoint stepped(const SoundProfile& profile, double depth, double elevation, double time) {
    constexpr int steps = 200000;
    const double dt = time / steps;
    double across = 0;
    for (int i = 0; i < steps; ++i) {
        const double half = depth - 0.5 * dt * profile.speed(depth) * std::sin(elevation);
        const double g = (profile.speed(half + 1e-6) - profile.speed(half - 1e-6)) / 2e-6;
        const double middle = elevation + 0.5 * dt * g * std::cos(elevation), c = profile.speed(half);
        across += dt * c * std::cos(middle);
        depth -= dt * c * std::sin(middle);
        elevation += dt * g * std::cos(middle);
    }
    return {across, depth, elevation, profile.speed(depth)};
}

TEST(SoundProfileTest, RaysThroughLayersMatchSmallSteps) {
    const SoundProfile layers({{0, 30, 45, 100, 300}, {1510, 1512, 1495, 1490, 1500}});
    for (const double depth : {10.0, 30.0, 40.0, 99.0, 250.0})
        for (const double elevation : {-0.5, -0.06, -0.02, 0.013, 0.07, 0.4}) {
            const RayPoint exact = traced(layers, depth, elevation, timesTo(0.9, 11)).back();
            const RayPoint near = stepped(layers, depth, elevation, 0.9);
            EXPECT_NEAR(exact.across, near.across, 0.02) << depth << " m, " << elevation;
            EXPECT_NEAR(exact.depth, near.depth, 0.05) << depth << " m, " << elevation;
        }
}

TEST(SoundProfileTest, SpeedsBeyondTheEndsAreThoseOfTheEnds) {
    const SoundProfile layers({{5, 20}, {1500, 1510}});
    EXPECT_EQ(layers.speed(-3), 1500);
    EXPECT_EQ(layers.speed(400), 1510);
    EXPECT_EQ(layers.steepest(), 10.0 / 15);
    const auto points = traced(layers, 400, -0.3, timesTo(1, 3));
    EXPECT_NEAR(points.back().across, 1510 * std::cos(0.3), 1e-9);
}

TEST(SoundProfileTest, RaysTrappedOnTheAxisOfAChannelStayFinite) {
    const SoundProfile channel({{0, 100, 200}, {1550, 1450, 1550}});
    for (const double elevation : {0.0, 1e-300, -1e-15, 1e-9, 1e-6, -1e-3}) {
        const RayPoint point = traced(channel, 100, elevation, timesTo(5, 4)).back();
        EXPECT_NEAR(point.across, 1450 * 5, 1) << elevation;
        EXPECT_NEAR(point.depth, 100, 1) << elevation;
    }
    for (const double elevation : {-89.99 * pi / 180, 89.99 * pi / 180})
        EXPECT_TRUE(std::isfinite(traced(channel, 100, elevation, {5}).back().depth));
}

std::string findDiagnostic(const std::string& text) {
    const Folder folder;
    const std::string file = folder / "profile.csv";
    std::ofstream(file) << text;
    return test::computeError<types::ConfigError>([&] { SoundProfile::read(file); });
}

TEST(SoundProfileTest, ReportsAnErrorInAFileWithItsPlace) {
    EXPECT_EQ(findDiagnostic("depth_m,sound_speed_m_s\n0,1500\n10,1490.5\n"), "");
    EXPECT_THAT(findDiagnostic("depth_m\n0\n10\n"),
                HasSubstr("profile.csv:1:1: is 'depth_m'; the header must have depth_m,sound_speed_m_s"));
    EXPECT_THAT(findDiagnostic("depth_m,sound_speed_m_s\n0,1500\n20,1490\n10,1480\n"),
                HasSubstr("profile.csv:4:1: depth_m: is not above that of the line before"));
    EXPECT_THAT(findDiagnostic("depth_m,sound_speed_m_s\n0,1500\n"),
                HasSubstr("profile.csv:2:1: has 1 lines after its header"));
    EXPECT_THAT(findDiagnostic("depth_m,sound_speed_m_s\n0,nan\n1,1500\n"),
                HasSubstr("profile.csv:2:3: sound_speed_m_s: is 'nan'"));
    EXPECT_THAT(findDiagnostic("depth_m,sound_speed_m_s\n0,-1500\n1,1500\n"),
                HasSubstr("profile.csv:2:3: sound_speed_m_s: is '-1500'; it must be a number from 100 to 20000"));
    EXPECT_THAT(findDiagnostic("depth_m,sound_speed_m_s\n0,1500\n1\n"),
                HasSubstr("profile.csv:3:2: sound_speed_m_s: is missing"));
    EXPECT_THAT(findDiagnostic(""), HasSubstr("is empty"));
}

}  // namespace
}  // namespace insonify::acoustics
