// Sound through thin walls, compared with the sonar equation and the plate's transmission (ACOUSTICS.md 5.26).
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::makePing;
using test::makeSnapshot;

constexpr types::Shell sheet{0.0005, 1190, 2700, 1340, 5e-3, false};  // no resonance is narrower than a sample
constexpr types::Shell rubber{0.1, 1300, 900, 0, 0.2, false};

/** Returns the share of the energy that passes through and back. */
double passed(const types::Shell& shell, double cosine) {
    return std::pow(std::norm(shellResponse(shell, cosine).transmitted), 2);
}

TEST(WallsTest, TwoPlatesHaveTheirReturnsAtTheirRangesAndTheSecondIsWeakenedBothWays) {
    const SonarConfig config = wallSonar(60, 0.5, 32);
    const auto both = makePing(config, makeSnapshot(makeShells({test::wall(10), test::wall(13)}, 1, sheet)));
    const auto behind = makePing(config, makeSnapshot(makeShells({test::wall(13)}, 0)));
    const auto rigid = makePing(config, makeSnapshot(makeShells({test::wall(10)}, 0)));
    for (uint32_t beam = 0; beam < 32; ++beam) {
        const double bearing = both.bearings[beam].rad, cosine = std::cos(bearing);
        const double half_beam = types::radians(60.0 / 64);
        const double front = 10 / cosine, back = 13 / cosine,
                     margin = 0.15 + back * half_beam * std::abs(std::tan(bearing));
        const double there = sumEnergy(behind, beam, back - margin, 30);
        double share = 0;  // mean over the beam
        for (int i = 0; i < 100; ++i) share += passed(sheet, std::cos(bearing + half_beam * (i / 49.5 - 1))) / 100;
        EXPECT_NEAR(sumEnergy(both, beam, back - margin, 30) / there, share, 0.02 * share + 1e-4) << beam;
        const double reflected = std::norm(shellResponse(sheet, 1).reflected) * 0.1;
        EXPECT_NEAR(sumEnergy(both, beam, 0, front + margin) / sumEnergy(rigid, beam, 0, 30), reflected,
                    1e-3 * reflected);
        EXPECT_EQ(sumEnergy(both, beam, front + margin, back - margin), 0);
        EXPECT_EQ(sumEnergy(both, beam, 0, front - margin), 0);
    }
}

TEST(WallsTest, AWallWeakensOnlyTheBottomBehindIt) {
    const SonarConfig config = wallSonar(2, 60, 1);
    const types::Mesh bottom = test::ground(-4), screen = test::quad({9, -100, -100}, {0, 200, 0}, {0, 0, 98});
    const auto alone = makePing(config, makeSnapshot(makeShells({bottom}, 0)));
    const auto seen = makePing(config, makeSnapshot(makeShells({screen, bottom}, 1, sheet)));
    // The upper edge of the screen at 9 m is 2 m below the sonar. The screen hides the bottom from 9.85 m to where rays
    // pass over it, at 18 m along the ground.
    const double before = std::hypot(9, 4), over = std::hypot(18, 4);
    for (double range = 8; range < 28; range += 0.1) {
        const double r = range + 0.05, cosine = std::sqrt(1 - std::pow(4 / r, 2));  // to the screen
        if (std::abs(r - before) < 0.2 || std::abs(r - over) < 0.2 || std::abs(r - 9.2) < 0.8) continue;
        const double share = r > before && r < over ? passed(sheet, cosine) : 1;
        const double there = sumEnergy(alone, 0, range, range + 0.1), here = sumEnergy(seen, 0, range, range + 0.1);
        EXPECT_NEAR(here, share * there, 0.02 * share * there) << r;
    }
}

/** The far side of a hollow body echoes from within, at the same angle as the near side. */
TEST(WallsTest, AHollowSphereHasBothItsSides) {
    const double radius = 0.9, distance = 10;
    const SonarConfig config = wallSonar(12, 12, 1, 120);
    const auto ping =
        makePing(config, makeSnapshot(makeShells({test::sphere(radius, 256)}, 1, sheet, {{distance, 0, 0}})));
    std::vector<double> bins(ping.bin_count, 0);
    const double strength = 0.1 * std::norm(shellResponse(sheet, 1).reflected);
    constexpr int steps = 400'000;
    const double end = std::asin(radius / distance);
    for (int i = 0; i < steps; ++i) {
        const double off = end * (i + 0.5) / steps, aside = distance * std::sin(off);
        const double half = std::sqrt(std::max(radius * radius - aside * aside, 0.0)), cosine = half / radius;
        const double ring = 2 * pi * std::sin(off) * end / steps * strength * cosine;
        for (const bool far : {false, true}) {
            const double range = distance * std::cos(off) + (far ? half : -half);
            bins[static_cast<size_t>(range / ping.binStart(1))] +=
                ring / (range * range) * (far ? passed(sheet, cosine) : 1);
        }
    }
    double front = 0, back = 0;
    for (size_t k = 0; k < bins.size(); ++k) {
        const double at = ping.binStart(static_cast<double>(k));
        (at < distance ? front : back) += bins[k];
        if (std::abs(at - std::sqrt(distance * distance - radius * radius)) < 0.25) continue;  // the limb
        EXPECT_NEAR(double{ping.bins[k]}, bins[k], 0.03 * bins[k] + 2e-7) << at;
    }
    EXPECT_GT(back, 0.01 * front);
    EXPECT_NEAR(sumEnergy(ping, 0, distance, 12) / back, 1, 0.05);
}

TEST(WallsTest, AWaterFilledPipeHasTwoLinesAndAnAirFilledPipeOne) {
    const SonarConfig config = wallSonar(4, 4, 1, 150);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    constexpr uint32_t around = 720;
    for (uint32_t j = 0; j < around; ++j) {
        const double angle = 2 * pi * j / around;
        for (const float up : {-1.0f, 1.0f}) positions.emplace_back(std::cos(angle), std::sin(angle), up);
        const uint32_t a = 2 * j, b = 2 * ((j + 1) % around);
        indices.insert(indices.end(), {a, b, a + 1, b, b + 1, a + 1});
    }
    const types::Mesh pipe = test::getMesh(positions, indices);
    types::Shell with_air = acrylic;
    with_air.has_air = true;
    const auto water = makePing(config, makeSnapshot(makeShells({pipe}, 1, acrylic, {{10, 0, 0}})));
    const auto air = makePing(config, makeSnapshot(makeShells({pipe}, 1, with_air, {{10, 0, 0}})));
    EXPECT_GT(sumEnergy(water, 0, 10.8, 11.1), 0.01 * sumEnergy(water, 0, 8.9, 9.2));
    EXPECT_EQ(sumEnergy(water, 0, 9.5, 10.5), 0);
    EXPECT_EQ(sumEnergy(air, 0, 9.5, 15), 0);
    EXPECT_GT(sumEnergy(air, 0, 8.9, 9.2), sumEnergy(water, 0, 8.9, 9.2)) << "air reflects all";
}

TEST(WallsTest, AnOpaqueWallIsAnOrdinarySurfaceBitForBit) {
    for (const types::Shell& shell : {rubber, types::Shell{0.004, 1190, 2700, 1340, 5e-3, true}}) {
        SonarConfig config = wallSonar(60, 20, 16), none = config;
        none.max_walls = 0;
        const auto scene = makeShells({test::wall(10), test::wall(13)}, 1, shell);
        EXPECT_EQ(makePing(config, makeSnapshot(scene)).bins, makePing(none, makeSnapshot(scene)).bins);
    }
}

TEST(WallsTest, EachFurtherWallWeakensObjectsBehindUpToTheMaxNumber) {
    std::vector<types::Mesh> walls;
    for (int i = 0; i < 8; ++i) walls.push_back(test::wall(5 + 2.0f * static_cast<float>(i)));
    const auto scene = makeShells(walls, walls.size(), sheet);
    const double each = passed(sheet, 1);
    for (const int maximum : {0, 1, 4, 16}) {
        SonarConfig config = wallSonar(2, 2, 1);
        config.max_walls = maximum;
        const auto ping = makePing(config, makeSnapshot(scene));
        const double first = sumEnergy(ping, 0, 4.9, 5.2) * 25;
        for (int i = 0; i < 8; ++i) {
            const double range = 5 + 2 * i, share = i <= maximum ? std::pow(each, i) : 0;
            const double expected = share >= 1e-6 ? share * first / (range * range) : 0;
            EXPECT_NEAR(sumEnergy(ping, 0, range - 0.1, range + 0.2), expected, 0.02 * expected) << maximum << " " << i;
        }
    }
}

/** Effects on each echo are the same behind a wall: patterns, pulses, and the field of each scatterer. */
TEST(WallsTest, PatternsPulsesAndCoherentSpecklePassAsEnergyDoes) {
    std::mt19937 random(5);
    for (const std::string effect : {"pattern", "pulse", "coherent", "all"}) {
        SonarConfig config = wallSonar(8, 2, 8);
        const bool all = effect == "all";
        if (all || effect == "pattern") config.beam_pattern.emplace().receive.azimuth.emplace().width_deg = 1.5;
        if (all || effect == "pulse") config.pulse.emplace().bandwidth_khz = 2;
        if (all || effect == "coherent") config.speckle.emplace().coherent = true;
        const glm::dvec3 place(std::uniform_real_distribution(0.0, 1.0)(random), 0, 0);
        const auto behind =
            makePing(config, makeSnapshot(makeShells({test::wall(-8), test::wall(13)}, 1, sheet), place));
        const auto both = makePing(config, makeSnapshot(makeShells({test::wall(8), test::wall(13)}, 1, sheet), place));
        for (uint32_t beam = 0; beam < 8; ++beam) {
            const double share = passed(sheet, std::cos(both.bearings[beam].rad));
            const double there = sumEnergy(behind, beam, 11, 15);
            EXPECT_NEAR(sumEnergy(both, beam, 11, 15) / there, share, (all ? 0.08 : 0.04) * share) << effect << beam;
        }
    }
}

TEST(WallsTest, TheTruthNamesTheObjectBehind) {
    const SonarConfig config = wallSonar(8, 2, 4);
    const auto snapshot = makeSnapshot(makeShells({test::wall(8), test::wall(13)}, 1));
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    const auto alone = makePing(config, snapshot);
    EXPECT_EQ(ping.bins, alone.bins) << "the truth changes no bin";
    for (uint32_t beam = 0; beam < 4; ++beam) {
        int fronts = 0, backs = 0;
        for (uint32_t k = 0; k < ping.bin_count; ++k) {
            const size_t at = beam * ping.bin_count + k;
            if (!(ping.bins[at] > 0)) continue;
            const bool front = ping.binStart(k) < 10;
            EXPECT_EQ(truth.object[at], front ? 0 : 1);
            EXPECT_EQ(truth.path[at], front ? 0 : types::SonarTruth::through_wall);
            (front ? fronts : backs) += 1;
        }
        EXPECT_GE(fronts, 1);
        EXPECT_GE(backs, 1);
    }
}

TEST(WallsTest, ASmoothShellIsNoMirror) {
    const auto with = [](bool is_shell) {
        const auto scene = std::make_shared<types::Geometry>(*makeShells({test::wall(8), test::wall(-6)}, 1));
        scene->materials[1].reflection = 1;
        scene->materials[1].roughness_slope = 0.1f;
        if (!is_shell) scene->materials[1].shell.reset();
        SonarConfig plain = wallSonar(40, 10, 8), bouncing = plain;
        bouncing.multipath.emplace().bounces = 2;
        return std::pair(makePing(plain, makeSnapshot(scene)).bins, makePing(bouncing, makeSnapshot(scene)).bins);
    };
    const auto [shell, shell_bounced] = with(true);
    EXPECT_EQ(shell, shell_bounced);
    const auto [solid, solid_bounced] = with(false);
    EXPECT_NE(solid, solid_bounced);
}

TEST(WallsTest, ReportsWhyWallsAreOmitted) {
    const auto scene = makeShells({test::wall(10)}, 1), plain = test::makeScene({test::wall(10)});
    const auto why = [](const SonarConfig& config, const types::GeometryPtr& geometry) -> std::string {
        const RenderPlan plan = makeRenderPlan(config, *geometry);
        const Omitted* what = plan.findOmitted("thin walls");
        return what ? what->words(*what, plan.grid) : "";
    };
    SonarConfig config = wallSonar(8, 2, 4);
    EXPECT_EQ(why(config, scene), "");
    EXPECT_EQ(why(config, plain), "no material has a shell");
    config.max_walls = 0;
    EXPECT_EQ(why(config, scene), "max_walls is 0");
    config = wallSonar(8, 2, 4);
    config.frequency_khz.reset();
    EXPECT_THAT(why(config, scene), testing::StartsWith("no frequency_khz"));
    config = wallSonar(8, 2, 4);
    config.visibility = Visibility::Gl;
    EXPECT_THAT(why(config, scene), testing::HasSubstr("visibility: cpu"));
    config = wallSonar(8, 2, 4);
    config.motion_in_ping = true;
    EXPECT_THAT(why(config, scene), testing::HasSubstr("straight paths"));
}

}  // namespace
}  // namespace insonify::sonar
