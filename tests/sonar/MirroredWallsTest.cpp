// Walls that ring and bodies with a fill, seen by mirrors (ACOUSTICS.md 5.26).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <random>

#include "tests/sonar/ShellScenes.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::makeSnapshot;

constexpr double mirrored_level = 0.81;  ///< Energy that the mirror reflects, one way.

constexpr double range_between = 0.5, critical = 0.5;

double spacingAt(double cosine) { return range_between * std::sqrt(1 - (1 - cosine * cosine) / (critical * critical)); }

/** Makes the object of one mesh a silent, flat mirror. */
types::GeometryPtr mirroredBy(std::vector<types::Mesh> meshes, const types::Mesh& mirror, size_t shells,
                              const types::Shell& shell, std::vector<glm::dvec3> positions) {
    meshes.push_back(mirror);
    positions.resize(meshes.size());
    for (types::Cluster& cluster : meshes.back().clusters) cluster.material = 2;
    const auto scene = std::make_shared<types::Geometry>(*makeShells(std::move(meshes), shells, shell, positions));
    scene->materials.push_back({});
    scene->materials[2].lambert_db = -200;
    scene->materials[2].mirror = true;
    scene->materials[2].reflection = static_cast<float>(std::sqrt(mirrored_level));
    return scene;
}

/** A sonar that looks up at a mirror above receives what its image above the mirror receives, times the reflection out
 *  and back. Bodies are hollow or filled, and their walls ring or not. */
TEST(MirroredWallsTest, RandomBodiesByAMirrorEchoAsFromTheSonarsImage) {
    std::mt19937 random(3);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    double worst = 0, worst_moment = 0;
    int filled = 0, ringing = 0;
    for (int i = 0; i < 24; ++i) {
        types::Shell shell{i % 3 == 0 ? between(0.3, 0.6) : 0.003, between(1100, 1500), between(1500, 2200), 0, 1e-5};
        if (i % 4 != 1) shell.fill_density = between(800, 1600), shell.fill_speed = between(850, 1250);
        if (i % 2) shell.fill_loss = 1e-5;
        SonarConfig config = wallSonar(16, 16, 4, 400);
        config.quality.rows = 256;
        config.quality.columns_per_beam = 64;
        const double yaw = between(-0.3, 0.3), pitch = -between(0.5, 0.7), height = between(2, 4),
                     range = between(10, 14);
        const glm::dvec3 look(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), -std::sin(pitch));
        const glm::dvec3 above = glm::dvec3(0, 0, 2 * height) +
                                 range * glm::dvec3(look.x, look.y, -look.z);  // middle of the body in the image's view
        std::vector<types::Mesh> meshes{test::sphere(1.5, 96), test::sphere(0.4, 32)};
        const std::vector<glm::dvec3> positions{above, above + glm::dvec3(between(-0.5, 0.5), 0.3, -0.4)};
        const auto image =
            makePing(config, makeSnapshot(makeShells(meshes, 1, shell, positions), {0, 0, 2 * height}, yaw, -pitch));
        config.multipath.emplace();
        const bool by_surface = i % 2 == 0;
        if (by_surface) config.multipath->surface.emplace();
        auto snapshot =
            makeSnapshot(by_surface ? makeShells(meshes, 1, shell, positions)
                                    : mirroredBy(meshes, test::ground(static_cast<float>(height)), 1, shell, positions),
                         {}, yaw, pitch);
        if (by_surface) snapshot.water_surface = height;
        const auto ping = makePing(config, snapshot);
        double sum = 0, moment = 0, expected = 0, expected_moment = 0;
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
            for (uint32_t k = 0; k < ping.bin_count; ++k) {
                const double at = ping.binStart(k + 0.5);
                const auto bin = static_cast<double>(ping.bins[beam * ping.bin_count + k]),
                           other = static_cast<double>(image.bins[beam * ping.bin_count + k]) *
                                   (by_surface ? 1 : mirrored_level * mirrored_level);
                // Behind the near side, which has the level of water
                if (at < range + 0.2) continue;
                sum += bin, moment += bin * at;
                expected += other, expected_moment += other * at;
            }
        ASSERT_GT(expected, 0) << i;
        worst = std::max(worst, std::abs(10 * std::log10(sum / expected)));
        worst_moment = std::max(worst_moment, std::abs(moment / sum - expected_moment / expected));
        filled += shell.fill_density > 0;
        ringing += i % 3 == 0;
    }
    std::cout << filled << " filled and " << ringing
              << " ringing of 24 bodies by mirrors, behind their middle: at most " << worst << " dB and "
              << worst_moment << " m off those of the sonar's image\n";
    EXPECT_LT(worst, 0.2);
    EXPECT_LT(worst_moment, 0.03);
}

/** Arrivals of energy at ranges. */
struct Arrivals {
    std::vector<std::pair<double, double>> all;

    void add(double range, double energy) { all.emplace_back(range, energy); }
    double upTo(double range) const {
        return std::accumulate(all.begin(), all.end(), 0.0, [&](double sum, const auto& arrival) {
            return sum + (arrival.first < range ? arrival.second : 0);
        });
    }
};

/** Expects the energy up to each range to be that of the arrivals up to it, within 0.08 m and 3 % of all. */
void expectArrivals(const std::vector<double>& bins, const types::Sonar& ping, const Arrivals& arrivals) {
    constexpr double doubt = 0.08, share = 0.03;
    const double all = arrivals.upTo(1e9);
    double sum = 0;
    for (size_t k = 0; k < bins.size(); ++k) {
        sum += bins[k];
        const double end = ping.binStart(static_cast<double>(k + 1));
        EXPECT_GT(sum / all, arrivals.upTo(end - doubt) / all - share) << end;
        EXPECT_LT(sum / all, arrivals.upTo(end + doubt) / all + share) << end;
    }
}

/** A small plate 10 m ahead under a surface 2 m above: seen straight, by the surface once, and twice. */
struct BySurface {
    SonarConfig config = wallSonar(6, 50, 1, 300);
    double straight = 10, mirrored = std::hypot(10, 4), mixed = (straight + mirrored) / 2, cosine = 10 / mirrored;

    BySurface() {
        config.quality.rows = 2048;
        config.quality.columns_per_beam = 64;
        config.multipath.emplace().surface.emplace();
    }
    types::Mesh plate() const { return test::quad({10, -0.5, -0.05f}, {0, 1, 0}, {0, 0, 0.1f}); }
    types::Sonar ping(const types::GeometryPtr& scene, int walls, bool has_surface = true) const {
        SonarConfig own = config;
        own.max_walls = walls;
        if (!has_surface) own.multipath.reset();
        auto snapshot = makeSnapshot(scene);
        snapshot.water_surface = 2;
        return makePing(own, snapshot);
    }
    /** Returns the echoes by the surface only. */
    std::vector<double> byMirror(const types::GeometryPtr& scene, int walls) const {
        const auto with = ping(scene, walls), without = ping(scene, walls, false);
        std::vector<double> bins;
        for (size_t k = 0; k < with.bins.size(); ++k) bins.push_back(double{with.bins[k]} - double{without.bins[k]});
        return bins;
    }
    /** Energies of both kinds of echoes without ringing. */
    std::pair<double, double> levels(const types::GeometryPtr& scene) const {
        const auto bins = byMirror(scene, 0);
        double once = 0, twice = 0;
        for (size_t k = 0; k < bins.size(); ++k)
            (static_cast<double>(k + 1) * 0.1 < (mixed + mirrored) / 2 ? once : twice) += bins[k];
        return {once, twice};
    }
};

/** Its returns by the surface are at the mirrored ranges, at the angles of the mirrored sound. */
TEST(MirroredWallsTest, APlateBySurfaceHasItsReturnsAtTheMirroredRangesAndLevels) {
    const BySurface by;
    const auto scene = makeShells({by.plate()}, 1, ringing_plate);
    const auto [once, twice] = by.levels(scene);
    ASSERT_GT(once, 0);
    ASSERT_GT(twice, 0);
    const std::vector<double> returns = computeReturns(ringing_plate).reflected;
    const double sum = std::accumulate(returns.begin(), returns.end(), 0.0);
    Arrivals arrivals;
    for (size_t k = 0; k < returns.size(); ++k) {
        const auto late = [&](double spacing) { return static_cast<double>(k) * spacing; };
        const double of_mixed = by.mixed + late(0.5 * (spacingAt(1) + spacingAt(by.cosine))),
                     of_mirrored = by.mirrored + late(spacingAt(by.cosine));
        arrivals.add(of_mixed, once * returns[k] / sum * std::pow(by.mixed / of_mixed, 2));
        arrivals.add(of_mirrored, twice * returns[k] / sum * std::pow(by.mirrored / of_mirrored, 2));
    }
    expectArrivals(by.byMirror(scene, 4), by.ping(scene, 4), arrivals);
}

/** Returns the mean of |T|^(2 times) over a resonance of the plate. */
double meanPassed(double cosine, int times) {
    constexpr int steps = 4000;
    const double in_plate = std::sqrt(1 - (1 - cosine * cosine) / (critical * critical)),
                 width = ringing_plate.sound_speed / (2 * ringing_plate.thickness * in_plate);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double frequency = 1000 * shell_khz + (i + 0.5) / steps * width;
        const acoustics::Fluid water{1025, water_speed};
        sum += std::pow(std::norm(acoustics::plateResponse(
                                      {ringing_plate.thickness, ringing_plate.density, ringing_plate.sound_speed, 0, 0},
                                      water, water, frequency, cosine)
                                      .transmitted),
                        times) /
               steps;
    }
    return sum;
}

/** Sound passes a ringing wall out at one angle and back at another, and both times at one angle. */
TEST(MirroredWallsTest, SoundThroughARingingWallArrivesAtTheTimesOfBothItsAngles) {
    const BySurface by;
    const types::Mesh screen = test::quad({8, -50, -50}, {0, 100, 0}, {0, 0, 51.9f});
    const auto [once, twice] = by.levels(makeShells({by.plate()}, 0));
    const acoustics::PlateReturns returns = computeReturns(ringing_plate);
    const auto relative = [](const std::vector<double>& all, size_t k) {
        return all[k] / std::accumulate(all.begin(), all.end(), 0.0);
    };
    const auto delay = [](double cosine) { return spacingAt(cosine) - ringing_plate.thickness * cosine; };
    Arrivals arrivals;
    const double through_once = meanPassed(1, 1) * meanPassed(by.cosine, 1), through_twice = meanPassed(by.cosine, 2);
    for (size_t j = 0; j < returns.passed_once.size(); ++j)
        for (size_t k = 0; k < returns.passed_once.size(); ++k) {
            const double range = by.mixed + 0.5 * (delay(1) + delay(by.cosine)) +
                                 static_cast<double>(j) * spacingAt(1) + static_cast<double>(k) * spacingAt(by.cosine);
            arrivals.add(range, once * through_once * relative(returns.passed_once, j) *
                                    relative(returns.passed_once, k) * std::pow(by.mixed / range, 2));
        }
    for (size_t k = 0; k < returns.passed.size(); ++k) {
        const double range = by.mirrored + delay(by.cosine) + static_cast<double>(k) * spacingAt(by.cosine);
        arrivals.add(range, twice * through_twice * relative(returns.passed, k) * std::pow(by.mirrored / range, 2));
    }
    const auto scene = makeShells({screen, by.plate()}, 1, ringing_plate);
    const auto alone = makeShells({screen}, 1, ringing_plate);
    std::vector<double> bins = by.byMirror(scene, 4);
    const std::vector<double> of_screen = by.byMirror(alone, 4);
    for (size_t k = 0; k < bins.size(); ++k) bins[k] -= of_screen[k];
    std::cout << "one way at two angles: " << through_once << ", at one angle out and back: " << through_twice << "\n";
    expectArrivals(bins, by.ping(scene, 4), arrivals);
}

}  // namespace
}  // namespace insonify::sonar
