// Rays bent by a profile of the speed of sound, compared with exact arcs (ACOUSTICS.md 5.19).
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/effects/Refraction.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Scenes.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sonar {
namespace {

using ::testing::HasSubstr;
using types::radians;

/** A file that is private to this process. */
std::string makeProfile(const std::vector<std::pair<double, double>>& speeds) {
    static const Folder folder;
    static int count = 0;
    const std::string file = folder / ("speeds_" + std::to_string(count++) + ".csv");
    std::ofstream stream(file);
    stream.precision(17);
    stream << "depth_m,sound_speed_m_s\n";
    for (const auto& [depth, speed] : speeds) stream << depth << ',' << speed << '\n';
    return file;
}

/** 1500 m/s at the surface, with a strong thermocline to any depth. */
std::string thermocline(double gradient = 0.1) { return makeProfile({{0, 1500}, {1000, 1500 + 1000 * gradient}}); }

/** A sonar to 2 km in bins of 2 m; its speed of sound is 1500 m/s. */
SonarConfig longRange(const std::string& profile, double height_deg = 30) {
    SonarConfig config;
    config.range_rounding = RangeRounding::Exact;
    config.range = 2000;
    config.bin_count = 1000;
    config.beam_count = 4;
    config.field_of_view_deg = 8;
    config.beam_height_deg = height_deg;
    config.speed_of_sound = 1500;
    config.visibility = Visibility::Cpu;
    config.quality.rows = 2048;
    config.quality.columns_per_beam = 2;
    if (!profile.empty()) config.water.emplace().profile = profile;
    return config;
}

struct Reported {
    types::Sonar ping;
    types::SonarTruth truth;
};

Reported getReported(const SonarConfig& config, const types::Snapshot& snapshot) {
    SonarRenderer renderer(config, snapshot.geometry);
    Reported reported;
    renderer.setTruth(reported.ping, &reported.truth);
    renderer.render(snapshot, reported.ping);
    return reported;
}

double loudest(const types::Sonar& ping) { return std::ranges::max(ping.bins); }

size_t loudestBin(const types::Sonar& ping) {
    return static_cast<size_t>(std::ranges::max_element(ping.bins) - ping.bins.begin()) % ping.bin_count;
}

/** Returns the time in which a ray that starts at 1500 m/s, at an elevation below the horizon [rad], reaches a depth in
 *  a gradient, by its circle [s]. */
double timeDown(double elevation, double drop, double gradient) {
    const double at_bottom = -std::acos(std::cos(elevation) * (1500 + gradient * drop) / 1500);
    return (std::asinh(std::tan(at_bottom)) - std::asinh(std::tan(elevation))) / gradient;
}

/** Returns the elevation of the bottom's echo at a slant range, by bisection. */
double elevationAt(double range, double drop, double gradient) {
    double low = -1.5, high = -std::acos(1500 / (1500 + gradient * drop)) - 1e-12;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (1500 * timeDown(middle, drop, gradient) < range ? low : high) = middle;
    }
    return low;
}

TEST(RefractionTest, AFlatBottomInAGradientEchoesFromTheDirectionsOfTheExactArcs) {
    constexpr double drop = 200, gradient = 0.1;
    const auto geometry = test::makeScene({test::ground(-drop, 20000)});
    const Reported reported = getReported(longRange(thermocline(gradient)), test::makeSnapshot(geometry));
    int reported_bins = 0, straight_fails = 0;
    for (size_t bin = 450; bin < 1000; bin += 10) {
        const double range = 2 * (static_cast<double>(bin) + 0.5), reported_elevation = reported.truth.elevation[bin];
        if (range < drop / std::sin(radians(14.8)) || range > 1990) continue;
        EXPECT_NEAR(reported_elevation, elevationAt(range, drop, gradient), 1e-3) << range << " m";
        straight_fails += std::abs(reported_elevation + std::asin(drop / range)) > 0.02;
        if (range < 1700) {  // beyond, a row of samples covers more than that
            EXPECT_NEAR(1500 * timeDown(reported_elevation, drop, gradient), range, 1e-3 * range + 1) << range << " m";
        }
        ++reported_bins;
    }
    EXPECT_GT(reported_bins, 40);
    EXPECT_GT(straight_fails, 30) << "straight rays do not pass";
}

/** A plate of 40 x 8 m square to the x axis, its middle at a place. */
types::Mesh uprightPlate(glm::vec3 middle) { return test::quad(middle - glm::vec3(0, 20, 4), {0, 40, 0}, {0, 0, 8}); }

TEST(RefractionTest, ALevelRayMeetsAPointHundredMetresAboveAtTwoKilometres) {
    const auto exact = [](double seconds) {
        std::vector<acoustics::RayPoint> at(1);
        acoustics::traceRay(acoustics::SoundProfile({{0, 1000}, {1500, 1600}}), 300, 0, std::vector{seconds}, at);
        return at.front();
    };
    const double range = 1951, time = range / 1500;
    const acoustics::RayPoint met = exact(time);
    const double rise = 300 - met.depth;
    EXPECT_NEAR(rise, 0.1 * 1951 * 1951 / (2 * 1530.0) * 1530 / 1500 * 1530 / 1500, 5) << "the brief form";
    const SonarConfig thin = longRange(thermocline(), 0.4);
    const auto received = [&](double height, const SonarConfig& config) {
        const auto geometry = test::makeScene({uprightPlate({met.across, 0, -300 + height})});
        SonarRenderer renderer(config, geometry);
        types::Sonar ping;
        renderer.render(test::makeSnapshot(geometry, {0, 0, -300}), ping);
        return ping;
    };
    const types::Sonar ping = received(rise, thin);
    ASSERT_GT(loudest(ping), 0);
    EXPECT_EQ(loudestBin(ping), static_cast<size_t>(range / 2)) << "two metres, a thousandth of the range";
    EXPECT_EQ(loudest(received(0, thin)), 0) << "straight ahead";
    EXPECT_EQ(loudest(received(rise, longRange("", 0.4))), 0) << "by straight rays";
    EXPECT_GT(loudest(received(0, longRange("", 0.4))), 0) << "by straight rays";
}

TEST(RefractionTest, WaterOfAnotherSpeedStretchesRangesAndKeepsSpreading) {
    const double ratio = 1500.0 / 1470;
    SonarConfig config = longRange(makeProfile({{0, 1470}, {100, 1470}}));
    config.range = 200;
    const auto snapshot = [](double scale) {
        return test::makeSnapshot(test::makeScene({test::ground(static_cast<float>(-20 * scale))}), {}, 0.1, 0.1, 0.2);
    };
    const types::Sonar bent = getReported(config, snapshot(1)).ping;
    config.water.reset();
    const types::Sonar plain = getReported(config, snapshot(ratio)).ping;
    double error = 0, norm = 0;
    for (size_t i = 0; i < plain.bins.size(); ++i) {
        error += std::pow(bent.bins[i] - ratio * ratio * plain.bins[i], 2);
        norm += std::pow(ratio * ratio * plain.bins[i], 2);
    }
    EXPECT_LT(std::sqrt(error / norm), 1e-3);
    EXPECT_GT(norm, 0);
}

TEST(RefractionTest, WaterOfTheSonarsOwnSpeedChangesNoBit) {
    const auto snapshot =
        test::makeSnapshot(test::makeScene({test::ground(-20), test::sphere(3, 24)}, -10, {{}, {60, 3, -9}}));
    SonarConfig config = longRange(makeProfile({{0, 1500}, {30, 1500}, {90, 1500}}));
    const types::Sonar same = getReported(config, snapshot).ping;
    config.water->profile.reset();
    EXPECT_EQ(same.bins, getReported(config, snapshot).ping.bins);
    config.water.reset();
    EXPECT_EQ(same.bins, getReported(config, snapshot).ping.bins);
    EXPECT_GT(loudest(same), 0);
}

/** Speed grows down to 50 m, and falls below: rays of the duct stay in it, other rays descend steeply. */
TEST(RefractionTest, BelowADuctThereIsAShadow) {
    const std::string duct = makeProfile({{0, 1499}, {50, 1501.5}, {250, 1481.5}});
    const auto receivedAt = [&](double depth, const std::string& profile) {
        const auto geometry =
            test::makeScene({test::quad({2000, -50, static_cast<float>(-depth) - 2}, {0, 100, 0}, {0, 0, 4})});
        SonarConfig config = longRange(profile, 12);
        config.range = 2200;
        SonarRenderer renderer(config, geometry);
        types::Sonar ping;
        renderer.render(test::makeSnapshot(geometry, {0, 0, -20}), ping);
        for (const float bin : ping.bins) EXPECT_TRUE(std::isfinite(bin)) << depth << " m deep";
        return loudest(ping);
    };
    EXPECT_EQ(receivedAt(56, duct), 0) << "in the shadow";
    EXPECT_GT(receivedAt(56, ""), 0) << "straight rays have no shadow";
    EXPECT_GT(receivedAt(25, duct), 0) << "in the duct";
    EXPECT_GT(receivedAt(95, duct), 0) << "below the shadow";
}

TEST(RefractionTest, AnObjectInTheWayOfABentRayHidesObjectsBehind) {
    std::vector<acoustics::RayPoint> at(2);
    acoustics::traceRay(acoustics::SoundProfile({{0, 1000}, {1500, 1600}}), 300, 0, std::vector{0.7, 1.3}, at);
    const auto place = [&](size_t i) { return glm::vec3(at[i].across, 0, -at[i].depth); };
    const auto both = test::makeScene({uprightPlate(place(0)), uprightPlate(place(1))}),
               far = test::makeScene({uprightPlate(place(1))});
    const SonarConfig thin = longRange(thermocline(), 0.2);
    const types::Sonar hidden = getReported(thin, test::makeSnapshot(both, {0, 0, -300})).ping;
    const types::Sonar open = getReported(thin, test::makeSnapshot(far, {0, 0, -300})).ping;
    const size_t near_bin = static_cast<size_t>(0.7 * 1500 / 2), far_bin = static_cast<size_t>(1.3 * 1500 / 2);
    EXPECT_EQ(loudestBin(hidden), near_bin);
    EXPECT_NEAR(static_cast<double>(loudestBin(open)), static_cast<double>(far_bin), 1);
    EXPECT_EQ(hidden.bins[1000 + far_bin], 0);
}

TEST(RefractionTest, BentRaysMeetAMovingObjectAtItsPlace) {
    const auto geometry = test::makeScene({uprightPlate({0, 0, 0})}, 0, {{0, 0, 5000}});
    std::vector<acoustics::RayPoint> at(1);
    acoustics::traceRay(acoustics::SoundProfile({{0, 1000}, {1500, 1600}}), 300, 0, std::vector{1.0}, at);
    types::Snapshot snapshot = test::makeSnapshot(geometry, {0, 0, -300});
    glm::dmat4 place(1);
    place[3] = {at[0].across, 0, -at[0].depth, 1};
    snapshot.moved = {{0, place}};
    const types::Sonar ping = getReported(longRange(thermocline(), 0.4), snapshot).ping;
    ASSERT_GT(loudest(ping), 0);
    EXPECT_NEAR(static_cast<double>(loudestBin(ping)), 750, 1);
}

TEST(RefractionTest, APointTargetEchoesFromItsArcAndNotInAShadow) {
    const double elevation = -0.05, time = 1801 / 1500.0;
    std::vector<acoustics::RayPoint> at(1);
    acoustics::traceRay(acoustics::SoundProfile({{0, 1000}, {1500, 1600}}), 300, elevation, std::vector{time}, at);
    const auto nothing = test::openWater();
    const auto received = [&](const std::string& profile, double pitch, glm::dvec3 place) {
        types::Snapshot snapshot = test::makeSnapshot(nothing, {0, 0, -300}, 0, pitch);
        snapshot.targets = {{place, 0}};
        return getReported(longRange(profile, 0.2), snapshot).ping;
    };
    const glm::dvec3 place(at[0].across, 0.5, -at[0].depth);
    const std::string linear = makeProfile({{0, 1500}, {1000, 1600}});
    const types::Sonar ping = received(linear, -elevation, place);
    ASSERT_GT(loudest(ping), 0);
    EXPECT_EQ(loudestBin(ping), static_cast<size_t>(time * 1500 / 2)) << "2 m in 1800";
    EXPECT_EQ(loudest(received("", -elevation, place)), 0) << "straight rays come from elsewhere";
    const double r = time * 1500;
    EXPECT_NEAR(10 * std::log10(loudest(ping) * r * r * r * r), 0, 1) << "nearly as far as it sounds";
    EXPECT_EQ(loudest(received(linear, -elevation, place + glm::dvec3(0, 0, 20))), 0) << "out of the thin beam";
}

TEST(RefractionTest, ThePlanStatesWhetherRaysAreBentAndTheBound) {
    const auto geometry = test::makeScene({test::ground(-20)});
    const auto makePlan = [&](double range, const std::string& profile) {
        SonarConfig config = longRange(profile);
        config.range = range;
        config.bin_count = 200;
        return makeRenderPlan(config, *geometry);
    };
    EXPECT_TRUE(makePlan(2000, thermocline()).hasFeature("refraction"));
    EXPECT_FALSE(makePlan(2000, thermocline()).findOmitted("refraction"));
    const RenderPlan near = makePlan(20, makeProfile({{0, 1500}, {20, 1500.2}}));
    EXPECT_FALSE(near.hasFeature("refraction"));
    ASSERT_TRUE(near.findOmitted("refraction"));
    EXPECT_NEAR(near.findOmitted("refraction")->value, 0.01 * 20 * 20 / 3000, 1e-9);
    EXPECT_NEAR(near.findOmitted("refraction")->bound, 0.1 * 20 * radians(30), 1e-9);
    EXPECT_THAT(describe(*near.findOmitted("refraction"), near.grid).reason,
                HasSubstr("a gradient of 0.01 1/s bends by"));
    EXPECT_TRUE(makePlan(100, makeProfile({{0, 1490}, {9, 1490}})).hasFeature("refraction"))
        << "no gradient, but another speed than the sonar's: 0.67 m at 100 m, by bins of 0.5 m";
    EXPECT_FALSE(makePlan(100, makeProfile({{0, 1498}, {9, 1498}})).hasFeature("refraction")) << "0.13 m";
}

TEST(RefractionTest, TheRasterisedPathRejectsAProfileThatMatters) {
    SonarConfig config = longRange(thermocline());
    config.visibility = Visibility::Gl;
    config.device = "software";
    const auto geometry = test::makeScene({test::ground(-20)});
    EXPECT_THAT(whyStraight(config), HasSubstr("only ray tracing"));
    EXPECT_THROW(makeRenderPlan(config, *geometry), types::ConfigError);
    config.range = 20;
    config.water->profile = makeProfile({{0, 1500}, {20, 1500.2}});
    EXPECT_EQ(whyStraight(config), "") << "negligible refraction is omitted";
    config.visibility = Visibility::Auto;
    config.device = "";
    EXPECT_TRUE(config.tracesRays());
}

}  // namespace
}  // namespace insonify::sonar
