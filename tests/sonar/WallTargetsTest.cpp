// Point targets and edges behind thin walls, compared with the sonar equation and the plate's transmission
// (ACOUSTICS.md 5.26).
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <numeric>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/Pings.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::makeSnapshot;
using types::radians;

constexpr types::Shell clear_sheet{0.0005, 1190, 2700, 1340, 5e-3, false};  // without narrow resonances

/** Returns the share of the energy that passes through and back. */
double sheetPassed(double cosine) { return std::pow(std::norm(shellResponse(clear_sheet, cosine).transmitted), 2); }
double inDecibels(double power) { return 10 * std::log10(power); }

/** Walls without an echo of their own. */
types::GeometryPtr silentWalls(const std::vector<types::Mesh>& walls, const types::Shell& shell = clear_sheet,
                               std::vector<glm::dvec3> positions = {}) {
    const auto scene = std::make_shared<types::Geometry>(*makeShells(walls, walls.size(), shell, std::move(positions)));
    for (types::Material& material : scene->materials) material.lambert_db = -200;
    return scene;
}
types::Snapshot pingedTarget(const types::GeometryPtr& scene, const glm::dvec3& at) {
    types::Snapshot snapshot = makeSnapshot(scene);
    snapshot.targets = {{at, 0}};
    return snapshot;
}
/** Returns the energy of a target behind walls relative to that in open water. */
double shareBehind(const SonarConfig& config, const types::GeometryPtr& scene, const glm::dvec3& at) {
    return test::computeSum(makePing(config, pingedTarget(scene, at))) /
           test::computeSum(makePing(config, pingedTarget(test::openWater(), at)));
}

TEST(WallTargetsTest, ATargetBehindAPlateIsWeakenedBothWaysAtItsAngle) {
    const SonarConfig config = wallSonar(120, 20, 24);
    for (const double angle_deg : {0.0, 40.0}) {
        const double angle = radians(angle_deg), cosine = std::cos(angle);
        const glm::dvec3 at = 14.03 * glm::dvec3(cosine, std::sin(angle), 0);
        const double one = shareBehind(config, silentWalls({test::wall(8)}), at),
                     two = shareBehind(config, silentWalls({test::wall(8), test::wall(9)}), at);
        std::cout << angle_deg << " deg: " << inDecibels(one) << " dB behind a plate, by the formula "
                  << inDecibels(sheetPassed(cosine)) << "; behind two " << inDecibels(two) << "\n";
        EXPECT_NEAR(inDecibels(one / sheetPassed(cosine)), 0, 0.02);
        EXPECT_NEAR(inDecibels(two / std::pow(sheetPassed(cosine), 2)), 0, 0.04);
        EXPECT_NEAR(shareBehind(config, silentWalls({test::wall(16)}), at), 1, 1e-6) << "before the wall";
    }
}

TEST(WallTargetsTest, AHollowSphereIsCrossedOnceToItsMiddleAndTwiceToATargetBehind) {
    const SonarConfig config = wallSonar(20, 20, 4);
    const auto scene = silentWalls({test::sphere(2, 256)}, clear_sheet, {{10, 0, 0}});
    const double within = shareBehind(config, scene, {10.03, 0, 0}), behind = shareBehind(config, scene, {14.03, 0, 0});
    std::cout << "inside a hollow sphere " << inDecibels(within) << " dB, behind it " << inDecibels(behind)
              << " dB; by the formula " << inDecibels(sheetPassed(1)) << " dB for each wall\n";
    EXPECT_NEAR(inDecibels(within / sheetPassed(1)), 0, 0.02);
    EXPECT_NEAR(inDecibels(behind / std::pow(sheetPassed(1), 2)), 0, 0.04);
    const double aside = shareBehind(config, scene, {14.03, 1, 0});  // each wall at the same angle
    const double distance = 10 * 1 / std::hypot(14.03, 1), cosine = std::sqrt(1 - distance * distance / 4);
    EXPECT_NEAR(inDecibels(aside / std::pow(sheetPassed(cosine), 2)), 0, 0.05);
}

TEST(WallTargetsTest, AnOpaqueWallHidesATargetBitForBit) {
    types::Shell air = clear_sheet;
    air.has_air = true;
    const types::Shell rubber{0.1, 1300, 900, 0, 0.2, false};
    types::Shell oil = clear_sheet;
    oil.fill_density = 900;
    oil.fill_speed = 1200;
    for (const types::Shell& shell : {air, rubber, oil}) {
        const SonarConfig config = wallSonar(60, 20, 16);
        const auto scene = makeShells({test::wall(8)}, 1, shell);
        EXPECT_EQ(makePing(config, pingedTarget(scene, {13, 1, 0})).bins, makePing(config, makeSnapshot(scene)).bins);
    }
    SonarConfig none = wallSonar(60, 20, 16);
    none.max_walls = 0;
    const auto scene = makeShells({test::wall(8)}, 1, clear_sheet);
    EXPECT_EQ(makePing(none, pingedTarget(scene, {13, 1, 0})).bins, makePing(none, makeSnapshot(scene)).bins);
}

TEST(WallTargetsTest, TargetsAreReceivedThroughUpToTheMaxNumberOfWalls) {
    std::vector<types::Mesh> walls;
    for (int i = 0; i < 5; ++i) walls.push_back(test::wall(5 + static_cast<float>(i)));
    for (const int maximum : {1, 4, 5}) {
        SonarConfig config = wallSonar(10, 10, 2);
        config.max_walls = maximum;
        for (int count = 0; count <= 5; ++count) {
            const double share = shareBehind(config, silentWalls(walls), {4.53 + count, 0, 0});
            EXPECT_NEAR(share, count <= maximum ? std::pow(sheetPassed(1), count) : 0, 0.01) << maximum << " " << count;
        }
    }
}

TEST(WallTargetsTest, FieldsPatternsAndPulsesPassAsEnergyDoes) {
    for (const std::string effect : {"pattern", "pulse", "coherent"}) {
        SonarConfig config = wallSonar(20, 10, 8);
        if (effect == "pattern") config.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 3;
        if (effect == "pulse") config.pulse.emplace().bandwidth_khz = 2;
        if (effect == "coherent") config.speckle.emplace().coherent = true;
        EXPECT_NEAR(inDecibels(shareBehind(config, silentWalls({test::wall(8)}), {13.03, 0.3, 0}) / sheetPassed(1)), 0,
                    0.05)
            << effect;
    }
}

TEST(WallTargetsTest, ATargetBehindARingingPlateIsLateAndRingsToo) {
    constexpr types::Shell plate{1, 2500, 2000, 0, 0, false};  // returns 0.5 m apart
    const SonarConfig config = wallSonar(2, 2, 1, 600);
    const auto ping = makePing(config, pingedTarget(silentWalls({test::wall(10)}, plate), {40.03, 0, 0}));
    const auto returns = acoustics::plateReturns({1, 2500, 2000, 0, 0}, {1025, water_speed}, {1025, water_speed},
                                                 1000 * shell_khz, WallLaw::max_returns);
    const double there =
        test::computeSum(makePing(config, pingedTarget(test::openWater(), {40.03, 0, 0}))) * std::pow(40.03, 4);
    for (size_t k = 0; k < 4; ++k) {
        const double at = 40.03 - 1 + 0.5 * static_cast<double>(k + 1);
        const double level = sumEnergy(ping, 0, at - 0.2, at + 0.2) * std::pow(at, 4) / there;
        EXPECT_NEAR(inDecibels(level / returns.passed[k]), 0, 0.05) << k;
    }
}

/** Out and back directly, out or back by the surface, and both by the surface; all through the wall. */
TEST(WallTargetsTest, WaysByTheWaterSurfaceAreWeakenedByTheirOwnAngles) {
    SonarConfig config = wallSonar(2, 100, 1);
    config.multipath.emplace().surface.emplace();
    const auto energies = [&](const types::GeometryPtr& scene) {
        types::Snapshot snapshot = makeSnapshot(scene, {0, 0, -4});
        snapshot.targets = {{{12.03, 0, -4}, 0}};
        snapshot.water_surface = 0.0;
        const auto ping = makePing(config, snapshot);
        return std::array{sumEnergy(ping, 0, 11.8, 12.2), sumEnergy(ping, 0, 13, 13.5), sumEnergy(ping, 0, 14.3, 14.7)};
    };
    const auto open = energies(silentWalls({test::wall(20)})), through = energies(silentWalls({test::wall(6)}));
    const double level = sheetPassed(1), up = sheetPassed(12.03 / std::hypot(12.03, 8));
    const std::array expected{level, std::sqrt(level * up), up};
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(inDecibels(through[i] / open[i] / expected[i]), 0, 0.03) << i;
}

/** Out directly and back by the surface through a plate that rings: each way with its own arrivals. */
TEST(WallTargetsTest, WaysByTheWaterSurfaceRingAtTheirOwnAngles) {
    constexpr types::Shell plate{1, 2500, 2000, 0, 0, false};  // returns 0.5 m apart at the normal
    SonarConfig config = wallSonar(2, 100, 1, 600);
    config.multipath.emplace().surface.emplace();
    const auto pingOfTarget = [&](const types::GeometryPtr& scene) {
        types::Snapshot snapshot = makeSnapshot(scene, {0, 0, -2});
        snapshot.targets = {{{12.03, 0, -2}, 0}};
        snapshot.water_surface = 0.0;
        return makePing(config, snapshot);
    };
    const auto open = pingOfTarget(silentWalls({test::wall(40)})),
               through = pingOfTarget(silentWalls({test::wall(6)}, plate));
    const double mirrored = std::hypot(12.03, 4), cosine = 12.03 / mirrored, mixed = (12.03 + mirrored) / 2;
    const auto spacing = [](double c) { return 0.5 * std::sqrt(1 - 4 * (1 - c * c)); };
    const auto returns = acoustics::plateReturns({1, 2500, 2000, 0, 0}, {1025, water_speed}, {1025, water_speed},
                                                 1000 * shell_khz, WallLaw::max_returns);
    const auto meanOnce = [&](double c) {
        double sum = 0;
        for (int i = 0; i < 4000; ++i) {
            const double frequency = 1000 * shell_khz + (i + 0.5) / 4000 * 500 / spacing(c);
            sum += std::norm(acoustics::plateResponse({1, 2500, 2000, 0, 0}, {1025, water_speed}, {1025, water_speed},
                                                      frequency, c)
                                 .transmitted) /
                   4000;
        }
        return sum;
    };
    const double first = mixed + 0.5 * (spacing(1) - 1 + spacing(cosine) - cosine);
    const double share =
        returns.passed_once[0] / std::accumulate(returns.passed_once.begin(), returns.passed_once.end(), 0.0);
    const double level = sumEnergy(through, 0, first - 0.1, first + 0.1) /
                         sumEnergy(open, 0, mixed - 0.1, mixed + 0.1) * std::pow(first / mixed, 4);
    const double expected = meanOnce(1) * meanOnce(cosine) * share * share;
    std::cout << "a target out directly and back by the surface: " << inDecibels(level) << " dB, by the formula "
              << inDecibels(expected) << " dB\n";
    EXPECT_NEAR(inDecibels(level / expected), 0, 0.2);
}

TEST(WallTargetsTest, TheTruthOfABinWithATargetBehindAWallIsItsWay) {
    const SonarConfig config = wallSonar(8, 8, 1);
    const auto scene = makeShells({test::wall(8)}, 1, clear_sheet);
    types::Snapshot snapshot = pingedTarget(scene, {13.03, 0, 0});
    snapshot.targets.push_back({{4.03, 0, 0}, 0});
    SonarRenderer renderer(config, scene);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    EXPECT_EQ(ping.bins, makePing(config, snapshot).bins) << "the truth changes no bin";
    EXPECT_EQ(truth.path[130], types::SonarTruth::through_wall);
    EXPECT_EQ(truth.object[130], types::SonarTruth::no_object);
    EXPECT_EQ(truth.path[40], 0);
    EXPECT_EQ(truth.path[80], 0) << "the wall";
}

/** The near edge of a thin soft sheet, seen edge-on through a plate. */
TEST(WallTargetsTest, AnEdgeBehindAPlateIsWeakenedBothWaysAtItsAngle) {
    SonarConfig config = wallSonar(40, 40, 1);
    config.effects["edge_diffraction"] = {};
    const auto energy = [&](double angle, bool with_wall, const types::Shell& shell = clear_sheet) {
        const glm::vec3 across(-std::sin(angle), std::cos(angle), 0);
        std::vector<types::Mesh> meshes{
            test::quad(glm::vec3(5, 0, -100) - 100.0f * across, 200.0f * across, {0, 0, 200}),
            test::quad({10.01f, -0.05f, 0}, {1, 0, 0}, {0, 0.1f, 0})};
        if (!with_wall) meshes[0] = test::disc(1, 0.1f);
        const auto scene = std::make_shared<types::Geometry>(
            *makeShells(meshes, 1, shell, {glm::dvec3(with_wall ? 0 : -500, 0, 0), glm::dvec3(0)}));
        for (types::Material& material : scene->materials) material.lambert_db = -300;
        scene->materials[0].reflection = -1;
        scene->materials[0].roughness_slope = 0;
        return sumEnergy(makePing(config, makeSnapshot(scene)), 0, 9.9, 10.2);
    };
    const double open = energy(0, false);
    ASSERT_GT(open, 0);
    for (const double angle_deg : {0.0, 40.0}) {
        const double angle = radians(angle_deg), share = energy(angle, true) / open;
        std::cout << "an edge behind a plate at " << angle_deg << " deg: " << inDecibels(share)
                  << " dB, by the formula " << inDecibels(sheetPassed(std::cos(angle))) << " dB\n";
        EXPECT_NEAR(inDecibels(share / sheetPassed(std::cos(angle))), 0, 0.02);
    }
    types::Shell air = clear_sheet;
    air.has_air = true;
    EXPECT_EQ(energy(0, true, air), 0);
}

}  // namespace
}  // namespace insonify::sonar
