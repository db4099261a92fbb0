// Paths by mirrors that pass through thin walls (ACOUSTICS.md 5.23, 5.26).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "tests/sonar/ShellScenes.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::makeSnapshot;

constexpr types::Shell thin_screen{0.002, 1190, 2700, 1340, 5e-3, false};

double twoWays(double cosine) { return std::pow(std::norm(shellResponse(thin_screen, cosine).transmitted), 2); }

/** A mirror 4 m below, a wall 10 m ahead, and screens. */
types::GeometryPtr withMirror(std::vector<types::Mesh> screens, const types::Shell& shell = thin_screen) {
    const size_t shells = screens.size();
    screens.push_back(test::wall(10));
    screens.push_back(test::ground(-4));
    for (types::Cluster& cluster : screens.back().clusters) cluster.material = 2;
    const auto scene = std::make_shared<types::Geometry>(*makeShells(std::move(screens), shells, shell));
    scene->materials.push_back(scene->materials.front());
    scene->materials[2].lambert_db = -200;
    scene->materials[2].mirror = true;
    return scene;
}
types::Mesh screenAt(float x, float low, float high) {
    return test::quad({x, -100, low}, {0, 200, 0}, {0, 0, high - low});
}
SonarConfig mirroring(double height_deg) {
    SonarConfig config = wallSonar(2, height_deg, 1);
    config.multipath.emplace().bounces = 1;
    return config;
}
/** Returns the energy of the paths by mirrors only. */
double energyByMirrors(SonarConfig config, const types::GeometryPtr& scene, double pitch, double from, double to) {
    const double all = sumEnergy(makePing(config, makeSnapshot(scene, {}, 0, pitch)), 0, from, to);
    config.multipath.reset();
    return all - sumEnergy(makePing(config, makeSnapshot(scene, {}, 0, pitch)), 0, from, to);
}

/** Out and back by the mirror through a screen before it, or behind it, at 35 deg. */
TEST(WallPathsTest, APathByAMirrorIsWeakenedByEachWallOfItsLegs) {
    const double pitch = 35 * std::numbers::pi / 180, cosine = std::cos(pitch);
    const SonarConfig config = mirroring(2);
    const double open = energyByMirrors(config, withMirror({}), pitch, 11, 14);
    ASSERT_GT(open, 0);
    for (const auto& [screens, walls] : {std::pair(std::vector{screenAt(3, -3.9f, 50)}, 1),
                                         {std::vector{screenAt(8, -3.9f, 50)}, 1},
                                         {std::vector{screenAt(3, -3.9f, 50), screenAt(8, -3.9f, 50)}, 2}}) {
        const double share = energyByMirrors(config, withMirror(screens), pitch, 11, 14) / open;
        std::cout << walls << " walls: " << share << ", by the plate " << std::pow(twoWays(cosine), walls) << "\n";
        EXPECT_NEAR(share / std::pow(twoWays(cosine), walls), 1, 0.02) << walls;
    }
}

/** All paths, including those with one direct leg and one leg by the mirror, are weakened by the walls of both legs. */
TEST(WallPathsTest, TheDirectLegIsWeakenedToo) {
    const SonarConfig config = mirroring(85);
    const auto share = [&](const types::Mesh& mesh) {
        return energyByMirrors(config, withMirror({mesh}), 0, 10.2, 13.5) /
               energyByMirrors(config, withMirror({}), 0, 10.2, 13.5);
    };
    const double steep = twoWays(std::cos(0.75)), level = twoWays(1);
    const double low = std::min(steep, level), high = std::max(steep, level);
    const double both = share(screenAt(8, -3.99f, 50)), direct = share(screenAt(9, -2.5f, 50));
    std::cout << "screen before both legs: " << both << " (" << low << " to " << high << "), before the direct leg "
              << direct << "\n";
    EXPECT_GT(both, 0.95 * low);
    EXPECT_LT(both, 1.05 * high);
    EXPECT_GT(direct, std::sqrt(low) * 0.9);
    EXPECT_LT(direct, 1);
}

TEST(WallPathsTest, AnOpaqueWallIsAnOrdinarySurfaceBitForBit) {
    types::Shell air = thin_screen;
    air.has_air = true;
    for (const types::Shell& shell : {air, types::Shell{0.1, 1300, 900, 0, 0.2, false}}) {
        SonarConfig config = mirroring(85), none = config;
        none.max_walls = 0;
        const auto scene = withMirror({screenAt(8, -3.9f, 50)}, shell);
        EXPECT_EQ(makePing(config, makeSnapshot(scene)).bins, makePing(none, makeSnapshot(scene)).bins);
    }
}

/** The water surface is a mirror above a tank made of a shell; the path crosses its walls up and down. */
TEST(WallPathsTest, TheWaterSurfaceIsVisibleThroughAWall) {
    SonarConfig config = wallSonar(2, 2, 1);
    config.multipath.emplace().surface.emplace();
    const auto level = [&](const types::GeometryPtr& scene) {
        auto snapshot = makeSnapshot(scene, {0, 0, -4}, 0, -35 * std::numbers::pi / 180);
        snapshot.water_surface = 0.0;
        return sumEnergy(makePing(config, snapshot), 0, 11, 14);
    };
    const double open = level(makeShells({test::wall(10)}, 0));
    const double through = level(makeShells({screenAt(3, -50, -0.1f), test::wall(10)}, 1, thin_screen));
    ASSERT_GT(open, 0);
    EXPECT_NEAR(through / open / twoWays(std::cos(35 * std::numbers::pi / 180)), 1, 0.02);
}

}  // namespace
}  // namespace insonify::sonar
