// Sound back and forth between two flat, smooth walls (ACOUSTICS.md 5.26).
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::makeSnapshot;

constexpr types::Shell half_clear{0.0012, 2700, 6000, 3100, 0, false};  // reflects about a half
constexpr double wall_relief = 0.05;

double wallReflected() { return std::norm(shellResponse(half_clear, 1).reflected); }
double wallTransmitted() { return std::norm(shellResponse(half_clear, 1).transmitted); }

/** Smooth walls of which the first are shells; the others are rigid. */
types::GeometryPtr smoothWalls(std::vector<types::Mesh> meshes, size_t shells, float wall_slope = wall_relief) {
    const auto scene = std::make_shared<types::Geometry>(*makeShells(std::move(meshes), shells, half_clear));
    for (types::Material& material : scene->materials) {
        material.lambert_db = -200;
        material.reflection = 1;
        material.roughness_slope = wall_slope;
    }
    return scene;
}
SonarConfig facingWalls(double width_deg = 40, int beams = 1) {
    SonarConfig config = wallSonar(width_deg, 40, beams);
    config.quality.columns_per_beam = 256 / beams;
    return config;
}
/** Returns the energy about a range, in all beams, times the square of the range, relative to a rigid wall. */
double levelAt(const types::Sonar& ping, double range, double rigid) {
    double sum = 0;
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) sum += sumEnergy(ping, beam, range - 0.11, range + 0.8);
    return sum * range * range / rigid;
}
double rigidLevel(const SonarConfig& config) {
    return test::computeSum(makePing(config, makeSnapshot(smoothWalls({test::wall(5)}, 0)))) * 25;
}

/** Return n is at r1 + (n + 1) d, with the level T^4 R^(2 + 4 n) of sound pressures. */
TEST(ReverberationTest, TwoPlatesHaveTheReturnsOfSoundBackAndForth) {
    const SonarConfig config = facingWalls();
    const double rigid = rigidLevel(config);
    for (const bool is_rigid : {false, true}) {
        const auto ping = makePing(config, makeSnapshot(smoothWalls({test::wall(5), test::wall(7)}, is_rigid ? 1 : 2)));
        const double second = is_rigid ? 1 : wallReflected();
        EXPECT_NEAR(levelAt(ping, 5, rigid) / wallReflected(), 1, 0.02);
        double expected = std::pow(wallTransmitted(), 2) * second;
        for (int n = 0; n < 5 && expected > 1e-5; ++n, expected *= wallReflected() * second) {
            const double level = levelAt(ping, 7 + 2 * n, rigid);
            std::cout << "a plate before a " << (is_rigid ? "rigid wall" : "plate") << ", " << n
                      << " times back: " << 10 * std::log10(level) << " dB at " << 7 + 2 * n << " m, by the formula "
                      << 10 * std::log10(expected) << " dB\n";
            EXPECT_NEAR(10 * std::log10(level / expected), 0, 0.02) << n;
            EXPECT_LT(sumEnergy(ping, 0, 6 + 2 * n, 6.8 + 2 * n) / sumEnergy(ping, 0, 6.8 + 2 * n, 8 + 2 * n), 1e-6);
        }
    }
}

TEST(ReverberationTest, ReturnsArriveAlongTheNormalOfTheWalls) {
    const SonarConfig config = facingWalls(60, 32);
    const double rigid = rigidLevel(config);
    const double yaw = 0.2;
    const auto ping = makePing(config, makeSnapshot(smoothWalls({test::wall(5), test::wall(7)}, 2), {}, yaw));
    const double expected = std::pow(wallTransmitted(), 2) * std::pow(wallReflected(), 3);
    EXPECT_NEAR(10 * std::log10(levelAt(ping, 9, rigid) / expected), 0, 0.3);
    double bearing = 0, energy = 0;
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
        const double there = sumEnergy(ping, beam, 8.8, 10);
        energy += there;
        bearing += there * ping.bearings[beam].rad;
    }
    EXPECT_NEAR(bearing / energy, -yaw, 0.01);
}

/** Between tilted walls sound returns from the image of the near wall in the far wall. */
TEST(ReverberationTest, ATiltedWallHasItsReturnsAtTheImagesOfTheOther) {
    const SonarConfig config = facingWalls(60, 32);
    const double tilt = 0.06;
    types::Mesh far = test::quad({7 - 100 * std::sin(0.06f), -100 * std::cos(0.06f), -100},
                                 {200 * std::sin(0.06f), 200 * std::cos(0.06f), 0}, {0, 0, 200});
    const auto ping = makePing(config, makeSnapshot(smoothWalls({test::wall(5), far}, 2)));
    const glm::dvec2 normal(std::cos(tilt), -std::sin(tilt));  // of the far wall, through (7, 0)
    const glm::dvec2 sonar = 2 * 7 * normal.x * normal;        // the sonar's image in it
    const double expected = std::abs(sonar.x - 5);             // to the near wall
    double range = 0, energy = 0;
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        for (double at = 8; at < 10; at += 0.1) {
            const double there = sumEnergy(ping, beam, at, at + 0.0999);
            range += there * (at + 0.05);
            energy += there;
        }
    std::cout << "image of the near wall: " << range / energy << " m, by geometry " << expected << " m\n";
    EXPECT_NEAR(range / energy, expected, 0.1);
}

TEST(ReverberationTest, RoughCurvedAndSingleWallsHaveNoneBitForBit) {
    const SonarConfig config = facingWalls();
    const auto reverberates = [&](const types::GeometryPtr& scene) {
        const auto ping = makePing(config, makeSnapshot(scene));
        return sumEnergy(ping, 0, 8.5, 30) > 0;
    };
    EXPECT_TRUE(reverberates(smoothWalls({test::wall(5), test::wall(7)}, 2)));
    EXPECT_FALSE(reverberates(smoothWalls({test::wall(5)}, 1)));
    SonarConfig none = config;
    none.max_walls = 0;
    EXPECT_EQ(makePing(config, makeSnapshot(smoothWalls({test::wall(5)}, 0))).bins,
              makePing(none, makeSnapshot(smoothWalls({test::wall(5)}, 0))).bins);
    const auto rough = smoothWalls({test::wall(5), test::wall(7)}, 2, 0.4f);
    const auto ping = makePing(config, makeSnapshot(rough));
    double last = 0;
    for (double at = 7; at < 30; at += 0.1)
        if (sumEnergy(ping, 0, at, at + 0.0999) > 0) last = at;
    EXPECT_LT(last, 7 / std::pow(std::cos(20 * std::numbers::pi / 180), 2) + 0.2) << "the far wall's end";
}

/** With `multipath` a rigid wall behind a plate is a mirror as well: its return by the plate counts once. */
TEST(ReverberationTest, ReturnsThatPathsByMirrorsHaveCountOnce) {
    SonarConfig config = facingWalls(), with_paths = config;
    with_paths.multipath.emplace().bounces = 2;
    const auto snapshot = makeSnapshot(smoothWalls({test::wall(5), test::wall(7)}, 1));
    const double rigid = rigidLevel(config);
    const auto ping = makePing(config, snapshot), both = makePing(with_paths, snapshot);
    for (const double range : {7.0, 9.0, 11.0, 13.0}) {
        std::cout << range << " m: " << levelAt(ping, range, rigid) << ", with multipath "
                  << levelAt(both, range, rigid) << "\n";
        EXPECT_NEAR(10 * std::log10(levelAt(both, range, rigid) / levelAt(ping, range, rigid)), 0, 0.3) << range;
    }
}

/** A wall that is smooth by the class of its map reflects as one of that material; a strength is a factor of R^2. */
TEST(ReverberationTest, WallsWithMapsReflectByTheMaterialsOfTheirMaps) {
    const SonarConfig config = facingWalls();
    const double rigid = rigidLevel(config);
    for (const float strength : {1.0f, 0.5f}) {
        const auto scene = std::make_shared<types::Geometry>(*smoothWalls({test::wall(5), test::wall(7)}, 2));
        types::Mesh far = scene->meshes[1];
        for (const glm::vec3& at : far.positions) far.map_uvs.emplace_back(at.y / 200 + 0.5, at.z / 200 + 0.5);
        types::SurfaceMap map{1, 1, {strength}, {0}, {1}, false, false};  // all of it has the first of its materials
        far.clusters.front().material = 2;
        far.maps = {{2, std::make_shared<const types::SurfaceMap>(map)}};
        scene->meshes = {scene->meshes[0], far};
        scene->materials.push_back(scene->materials[1]);
        scene->materials[2].roughness_slope.reset();
        scene->materials[2].max_map_strength = strength;
        const auto ping = makePing(config, makeSnapshot(scene));
        for (const int n : {1, 2}) {  // the far wall reflects n + 1 times
            const double expected = std::pow(wallTransmitted(), 2) * std::pow(wallReflected(), 1 + 2 * n) *
                                    std::pow(double{strength}, n + 1),
                         level = levelAt(ping, 7 + 2 * n, rigid);
            std::cout << "a wall smooth by its map, of strength " << strength << ", " << n
                      << " times back: " << 10 * std::log10(level) << " dB, by the formula "
                      << 10 * std::log10(expected) << " dB\n";
            EXPECT_NEAR(10 * std::log10(level / expected), 0, 0.05) << strength;
        }
    }
}

TEST(ReverberationTest, PatternsPulsesAndCoherentSpeckleKeepTheEnergy) {
    const double expected = wallTransmitted() * wallTransmitted() * std::pow(wallReflected(), 3);
    for (const std::string effect : {"pattern", "pulse", "coherent"}) {
        SonarConfig config = facingWalls(40, 8);
        config.quality.rows = 64;
        if (effect == "pattern") config.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 5;
        if (effect == "pulse") config.pulse.emplace().bandwidth_khz = 4;
        if (effect == "coherent") config.speckle.emplace().coherent = true;
        const auto walls = smoothWalls({test::wall(5), test::wall(7)}, 2), single = smoothWalls({test::wall(9)}, 0);
        SonarRenderer two(config, walls), one(config, single);
        types::Sonar ping, rigid;
        double level = 0, there = 0;
        for (int place = 0; place < (effect == "coherent" ? 60 : 1); ++place) {  // of other scatterers
            const glm::dvec3 position(0, 3 * place - 60, 0);
            two.render(makeSnapshot(walls, position), ping);
            one.render(makeSnapshot(single, position), rigid);
            level += levelAt(ping, 9, 1);
            there += levelAt(rigid, 9, 1);
        }
        std::cout << effect << ": " << 10 * std::log10(level / there / expected) << " dB off\n";
        EXPECT_NEAR(10 * std::log10(level / there / expected), 0, effect == "coherent" ? 1 : 0.3) << effect;
    }
}

TEST(ReverberationTest, TheTruthIsTheWallThatReturnsTheSound) {
    const SonarConfig config = facingWalls();
    const auto snapshot = makeSnapshot(smoothWalls({test::wall(5), test::wall(7)}, 2));
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    EXPECT_EQ(ping.bins, makePing(config, snapshot).bins) << "the truth changes no bin";
    for (const auto& [bin, object] : {std::pair(50, 0), {70, 1}, {90, 0}, {110, 1}}) {
        const auto at = static_cast<size_t>(bin);
        EXPECT_EQ(truth.object[at], object) << bin;
        EXPECT_EQ(truth.path[at], bin == 50 ? 0 : types::SonarTruth::through_wall) << bin;
    }
}

}  // namespace
}  // namespace insonify::sonar
