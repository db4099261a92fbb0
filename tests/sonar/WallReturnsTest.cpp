// Ringing of thick walls as separate returns in range (ACOUSTICS.md 3.10, 5.26).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <random>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/Pings.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::makeSnapshot;

constexpr double frustum_spacing = 0.5, critical_sine = 0.5;

double sumOfReturns(const std::vector<double>& all) { return std::accumulate(all.begin(), all.end(), 0.0); }
TEST(WallReturnsTest, APlatesReturnsAreAtTheirRangesWithTheirLevelsOverAngles) {
    const SonarConfig config = wallSonar(50, 0.5, 64);
    const auto rings = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 1, ringing_plate)));
    const auto rigid = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 0)));
    const acoustics::PlateReturns returns = computeReturns(ringing_plate);
    ASSERT_GT(returns.reflected.size(), 4u);
    double worst_level = 0;
    for (uint32_t beam = 0; beam < 64; ++beam) {
        const double bearing = std::abs(rings.bearings[beam].rad), range = 10 / std::cos(bearing);
        const double spacing = frustum_spacing * std::sqrt(1 - std::pow(std::sin(bearing) / critical_sine, 2));
        if (!(spacing > 0.35)) continue;  // windows overlap
        const double there = sumEnergy(rigid, beam, 0, 30) * range * range;
        for (size_t k = 0; k < 4; ++k) {
            const double at = range + static_cast<double>(k) * spacing, half = spacing / 2;
            const double level = sumEnergy(rings, beam, at - half + 0.05, at + half + 0.05) * at * at / there;
            const double expected = 0.1 * returns.reflected[k];
            worst_level = std::max(worst_level, std::abs(10 * std::log10(level / expected)));
        }
    }
    std::cout << "a plate's first four returns up to 21 deg off its normal: at most " << worst_level
              << " dB off their levels\n";
    EXPECT_LT(worst_level, 0.35);
}

TEST(WallReturnsTest, AllReturnsTogetherAreTheMeanReflectionOverAResonance) {
    const SonarConfig config = wallSonar(2, 0.5, 1, 600);
    const auto rings = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 1, ringing_plate)));
    const auto rigid = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 0)));
    double level = 0;
    for (uint32_t k = 0; k < rings.bin_count; ++k) {
        const double at = rings.binStart(k + 0.5);
        level += static_cast<double>(rings.bins[k]) * at * at;
    }
    double mean = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
        const acoustics::Fluid water{1025, water_speed};
        const double frequency =
            1000 * shell_khz + (i + 0.5) / steps * ringing_plate.sound_speed / (2 * ringing_plate.thickness);
        mean += std::norm(acoustics::plateResponse(
                              {ringing_plate.thickness, ringing_plate.density, ringing_plate.sound_speed, 0, 0}, water,
                              water, frequency, 1)
                              .reflected) /
                steps;
    }
    const double share = level / (test::computeSum(rigid) * 100) / 0.1;
    std::cout << "sum of returns " << share << ", mean of |R|^2 " << mean << "\n";
    EXPECT_NEAR(share / mean, 1, 0.01);
    EXPECT_LE(share, 1);
}

TEST(WallReturnsTest, ObjectsBehindAreLateAndRingToo) {
    const SonarConfig config = wallSonar(2, 0.5, 1, 600);
    const auto both = makePing(config, makeSnapshot(makeShells({test::wall(10), test::wall(40)}, 1, ringing_plate)));
    const auto alone = makePing(config, makeSnapshot(makeShells({test::wall(40)}, 0)));
    const acoustics::PlateReturns returns = computeReturns(ringing_plate);
    const double there = test::computeSum(alone) * 40 * 40;
    for (size_t k = 0; k < 4; ++k) {
        const double at = 40 - ringing_plate.thickness + frustum_spacing * static_cast<double>(k + 1);
        const double level = sumEnergy(both, 0, at - 0.2, at + 0.3) * at * at / there;
        EXPECT_NEAR(level / returns.passed[k], 1, 0.05) << k;
    }
    EXPECT_EQ(sumEnergy(both, 0, 38, 39.3), 0);
}

/** The far side of a thick tube echoes at its inner face, which is nearer by the thickness. */
TEST(WallReturnsTest, TheFarWallOfABodyEchoesFromWithin) {
    const types::Shell shell{0.6, 2500, 2000, 0, 1e-3, false};
    const SonarConfig config = wallSonar(1, 1, 1, 300);
    const auto ping = makePing(config, makeSnapshot(makeShells({test::sphere(4, 256)}, 1, shell, {{10, 0, 0}})));
    std::vector<double> edges;
    for (uint32_t k = 1; k < ping.bin_count; ++k)
        if (ping.bins[k] > 0 && ping.bins[k - 1] == 0) edges.push_back(ping.binStart(k));
    ASSERT_GE(edges.size(), 3u);
    EXPECT_NEAR(edges[0], 6, 0.11);
    EXPECT_NEAR(edges[1], 6.3, 0.11);
    const double far = 14 - 0.6 + (0.3 - 0.6);
    EXPECT_TRUE(std::ranges::any_of(edges, [&](double edge) { return std::abs(edge - far) < 0.11; }));
    EXPECT_EQ(sumEnergy(ping, 0, 9, far - 0.2), 0);
}

/** A wall whose returns are less than half a bin, or half of the pulse's resolution, apart has one return. */
TEST(WallReturnsTest, ReturnsWithinHalfABinMergeByTheResponseAtTheFrequency) {
    for (const double spacing : {0.049, 0.051}) {
        types::Shell shell = ringing_plate;
        shell.thickness = 2 * spacing;
        for (const bool long_pulse : {false, true}) {
            SonarConfig config = wallSonar(2, 0.5, 1);
            if (long_pulse) config.pulse.emplace().bandwidth_khz = 2;  // resolves 0.25 m
            const auto scene = makeShells({test::wall(10)}, 1, shell);
            const RenderPlan plan = makeRenderPlan(config, *scene);
            EXPECT_EQ(plan.laws.hasReturns(), spacing > 0.05 && !long_pulse);
            if (plan.laws.hasReturns()) continue;
            const double level = test::computeSum(makePing(config, makeSnapshot(scene))) /
                                 test::computeSum(makePing(config, makeSnapshot(makeShells({test::wall(10)}, 0))));
            EXPECT_NEAR(level / (0.1 * std::norm(shellResponse(shell, 1).reflected)), 1, 1e-5);
        }
    }
}

/** Scenes with and without a ringing wall: the beams that do not meet it are the same bit for bit. */
TEST(WallReturnsTest, EchoesWithoutARingingWallAreTheSameBitForBit) {
    const types::Mesh left = test::quad({10, 1, -100}, {0, 100, 0}, {0, 0, 200}),
                      right = test::quad({10, -101, -100}, {0, 100, 0}, {0, 0, 200});
    SonarConfig config = wallSonar(60, 20, 16);
    const auto with = makePing(config, makeSnapshot(makeShells({left, right}, 1, ringing_plate)));
    const auto without = makePing(config, makeSnapshot(makeShells({left, right}, 1)));
    bool differs = false;
    for (uint32_t beam = 0; beam < 16; ++beam)
        for (uint32_t k = 0; k < with.bin_count; ++k) {
            const size_t at = beam * with.bin_count + k;
            if (with.bearings[beam].rad < -0.15) {
                EXPECT_EQ(with.bins[at], without.bins[at]);
            }
            differs |= with.bins[at] != without.bins[at];
        }
    EXPECT_TRUE(differs);
}

TEST(WallReturnsTest, AllReturnsAreInTheFirstIfMaxWallsIsZero) {
    SonarConfig config = wallSonar(2, 0.5, 1);
    config.max_walls = 0;
    const auto ping = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 1, ringing_plate)));
    const auto rigid = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 0)));
    EXPECT_NEAR(test::computeSum(ping) / test::computeSum(rigid),
                0.1 * sumOfReturns(computeReturns(ringing_plate).reflected), 1e-5);
}

TEST(WallReturnsTest, PatternsPulsesAndCoherentSpeckleKeepTheirEnergy) {
    types::Shell shell = ringing_plate;
    shell.thickness = 2;  // a metre apart
    const acoustics::PlateReturns returns = computeReturns(shell);
    for (const std::string effect : {"pattern", "pulse", "coherent", "all"}) {
        SonarConfig config = wallSonar(8, 2, 8);
        const bool all = effect == "all";
        config.quality.rows = 32;
        config.quality.columns_per_beam = 4;
        if (all || effect == "pattern") config.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 1.5;
        if (all || effect == "pulse") config.pulse.emplace().bandwidth_khz = 4;
        if (all || effect == "coherent") config.speckle.emplace().coherent = true;
        const auto ringing = makeShells({test::wall(10)}, 1, shell), solid_wall = makeShells({test::wall(10)}, 0);
        SonarRenderer ringing_renderer(config, ringing), solid_renderer(config, solid_wall);
        types::Sonar ping, rigid;
        double first = 0, second = 0, solid = 0, spread = 0;
        for (int place = 0; place < (all || effect == "coherent" ? 160 : 1); ++place) {  // of other scatterers
            const glm::dvec3 position(0, 3 * (place % 40) - 60, 3 * (place / 40) - 20);
            ringing_renderer.render(makeSnapshot(ringing, position), ping);
            solid_renderer.render(makeSnapshot(solid_wall, position), rigid);
            for (uint32_t beam = 0; beam < 8; ++beam) {
                first += sumEnergy(ping, beam, 9.5, 10.5) * 100;
                second += sumEnergy(ping, beam, 10.5, 11.5) * 121;
                solid += sumEnergy(rigid, beam, 9.5, 10.5) * 100;
                spread += sumEnergy(rigid, beam, 10.5, 11.5) * 121;  // by pulse and pattern
            }
        }
        const double off_first = first / solid / (0.1 * returns.reflected[0]) - 1,
                     off_second =
                         (second - 0.1 * returns.reflected[0] * spread) / solid / (0.1 * returns.reflected[1]) - 1;
        std::cout << effect << ": first return " << off_first << " off, second " << off_second << "\n";
        const double tolerance = effect == "pattern" ? 0.02 : 0.1;  // bins have the level of their middle; speckle
        EXPECT_NEAR(off_first, 0, tolerance) << effect;
        EXPECT_NEAR(off_second, 0, tolerance) << effect;
    }
}

TEST(WallReturnsTest, TheTruthNamesTheRingingWall) {
    const SonarConfig config = wallSonar(8, 2, 4, 300);
    const auto snapshot = makeSnapshot(makeShells({test::wall(10), test::wall(25)}, 1, ringing_plate));
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    EXPECT_EQ(ping.bins, makePing(config, snapshot).bins) << "the truth changes no bin";
    int rung = 0, through = 0;
    for (size_t at = 0; at < ping.bins.size(); ++at) {
        if (!(ping.bins[at] > 0)) continue;
        const double range = ping.binStart(static_cast<double>(at % ping.bin_count));
        EXPECT_EQ(truth.object[at], range < 20 ? 0 : 1) << range;
        EXPECT_EQ(truth.path[at], range < 10.2 ? 0
                                  : range < 20 ? types::SonarTruth::rung
                                               : types::SonarTruth::through_wall)
            << range;
        (range < 10.2 ? through : rung) += 1;
    }
    EXPECT_GT(rung, 4 * 4);
}

/** Any plate at any angle to any sonar gives finite echoes with at most the energy of the pulse. */
TEST(WallReturnsTest, RandomPlatesReturnAtMostTheEnergyOfARigidPlate) {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
    };
    double maximum = 0;
    int ringing = 0;
    for (int i = 0; i < 60; ++i) {
        types::Shell shell{between(1e-3, 2), between(500, 9000), between(300, 7000), 0, i % 3 ? between(1e-6, 1) : 0,
                           i % 4 == 0};
        if (i == 0) shell.thickness = 0;
        if (i == 1) shell = {1, 7850, 5900, 3230, 1e-4, false};
        if (i == 2) shell = {0.5, 1025, water_speed, 0, 0, false};  // water
        if (i == 3) shell = {0.5, 1025, water_speed, 0, 0, true};   // water before air: all is in the second return
        if (i % 5 == 4) shell.shear_speed = 0.5 * shell.sound_speed;
        SonarConfig config = wallSonar(between(1, 120), between(1, 60), 1 + i % 9, 200);
        config.frequency_khz = between(10, 3000);
        config.quality.rows = 32;
        config.quality.columns_per_beam = 2;
        const double yaw = std::uniform_real_distribution(-1.5, 1.5)(random),
                     pitch = std::uniform_real_distribution(-0.7, 0.7)(random);
        const auto scene = makeShells({test::wall(6)}, 1, shell);
        const auto ping = makePing(config, makeSnapshot(scene, {}, yaw, pitch));
        const auto rigid = makePing(config, makeSnapshot(makeShells({test::wall(6)}, 0), {}, yaw, pitch));
        for (const float bin : ping.bins) EXPECT_TRUE(std::isfinite(bin) && bin >= 0) << i;
        if (!(test::computeSum(rigid) > 0)) continue;
        const double share = test::computeSum(ping) / (0.1 * test::computeSum(rigid));
        EXPECT_LE(share, 1 + 1e-3) << i;
        maximum = std::max(maximum, share);
        ringing += makeRenderPlan(config, *scene).laws.hasReturns();
    }
    std::cout << ringing << " of 60 random plates ring; at most " << maximum << " of a rigid plate's energy\n";
    EXPECT_GT(ringing, 10);
}

}  // namespace
}  // namespace insonify::sonar
