// Echoes by way of mirrors against the image method, worked out here from the sonar equation itself
// (ACOUSTICS.md 5.19).
#include <gmock/gmock.h>

#include <numbers>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "tests/support/EveryWay.hpp"
#include "tests/support/Scenes.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::pingOf;
using types::radians;

/** Bins of 0.1 m to 30 m, rays that look 60 deg up and down. */
SonarConfig sonarOf(double fov_deg, int beams) {
    SonarConfig config;
    config.speed_of_sound = 1000;  // bins of whole microseconds
    config.range = 30;
    config.bin_count = 300;
    config.beam_count = beams;
    config.field_of_view_deg = fov_deg;
    config.beam_height_deg = 120;
    config.quality.rows = 512;
    config.quality.columns_per_beam = 2;
    return config;
}

SonarConfig mirrored(SonarConfig config, double wind = 0, int bounces = 1) {
    config.multipath.emplace();
    config.multipath->surface.emplace().wind_m_s = wind;
    config.multipath->bounces = bounces;
    return config;
}

/** Nothing that any sonar here hears. */
types::GeometryPtr openWater() { return test::sceneOf({test::disc(1, 0.1f)}, 0, {{-500, 0, 0}}); }

types::Snapshot under(double surface, types::GeometryPtr geometry) {
    types::Snapshot snapshot = test::snapshotOf(std::move(geometry));
    snapshot.water_surface = surface;
    return snapshot;
}

types::Snapshot withTarget(double surface, glm::dvec3 position, types::GeometryPtr geometry = openWater()) {
    types::Snapshot snapshot = under(surface, std::move(geometry));
    snapshot.targets = {{position, 0}};
    return snapshot;
}

double decibels(double ratio) { return 10 * std::log10(ratio); }

/** What two pings differ by, bin by bin. */
std::vector<double> difference(const types::Sonar& with, const types::Sonar& without) {
    std::vector<double> all;
    for (size_t i = 0; i < with.bins.size(); ++i) all.push_back(double{with.bins[i]} - double{without.bins[i]});
    return all;
}

/** The bins of a beam that hold anything. */
std::vector<size_t> heardBins(const types::Sonar& ping, uint32_t beam = 0) {
    std::vector<size_t> bins;
    for (size_t k = 0; k < ping.bin_count; ++k)
        if (ping.bins[beam * ping.bin_count + k] > 0) bins.push_back(k);
    return bins;
}

TEST(MultipathTest, APointTargetUnderAFlatSurfaceHasThreeReturns) {
    const SonarConfig config = sonarOf(40, 1);
    const auto ping = pingOf(mirrored(config), withTarget(3, {12, 0, -1}));
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    const std::vector<double> ranges{r1, (r1 + r2) / 2, r2};
    const std::vector<double> expected{std::pow(r1, -4), 2 / (r1 * r1 * r2 * r2), std::pow(r2, -4)};
    const auto heard = heardBins(ping);
    ASSERT_EQ(heard.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((static_cast<double>(heard[i]) + 0.5) * 0.1, ranges[i], 0.05 + 1e-9);
        EXPECT_NEAR(decibels(ping.bins[heard[i]] / expected[i]), 0, 0.01) << i;
    }
    // Once for both directions of the mixed way would be 3 dB less.
    EXPECT_GT(decibels(ping.bins[heard[1]] / (expected[1] / 2)), 2.9);
}

TEST(MultipathTest, TheFirstEchoOfATargetIsTheSameBitForBit) {
    const SonarConfig config = sonarOf(40, 4);
    const auto with = pingOf(mirrored(config), withTarget(3, {12, 2, -1}));
    const auto without = pingOf(config, withTarget(3, {12, 2, -1}));
    for (size_t i = 0; i < without.bins.size(); ++i)
        if (without.bins[i] > 0) {
            EXPECT_EQ(with.bins[i], without.bins[i]);
        }
    EXPECT_EQ(heardBins(without, 2).size(), 1u);
    EXPECT_EQ(heardBins(with, 2).size(), 3u);
}

/** How many returns of a target there are with a plate somewhere. */
size_t returnsWith(types::Mesh plate) {
    auto config = mirrored(sonarOf(20, 1));
    auto scene = test::sceneOf({std::move(plate)}, -200);
    return heardBins(pingOf(config, withTarget(3, {12, 0, -1}, scene))).size();
}

TEST(MultipathTest, EachLegOfATargetsWaysIsHiddenByItself) {
    const auto plateAt = [](glm::dvec3 at) {
        return test::quad(glm::vec3(at) - glm::vec3(0, 0.2f, 0.2f), {0, 0.4f, 0}, {0, 0, 0.4f});
    };
    EXPECT_EQ(returnsWith(plateAt({-50, 0, 0})), 3u);
    EXPECT_EQ(returnsWith(plateAt({6, 0, -0.5})), 1u) << "the straight way: by the mirror there and back is left";
    const double bounce = 12.0 * 3 / 7;  // where the surface is met
    EXPECT_EQ(returnsWith(plateAt({bounce / 2, 0, 1.5})), 1u) << "up to the surface: the straight one is left";
    EXPECT_EQ(returnsWith(plateAt({(bounce + 12) / 2, 0, 1})), 1u) << "down from the surface";
    EXPECT_EQ(returnsWith(plateAt({bounce, 0, 5})), 3u) << "above the surface nothing hides anything";
}

TEST(MultipathTest, WhatIsOutsideOfTheApertureIsNeitherSentNorHeard) {
    auto config = mirrored(sonarOf(40, 1));
    config.beam_height_deg = 50;  // the way by the surface goes up by 30.3 deg
    EXPECT_EQ(heardBins(pingOf(config, withTarget(3, {12, 0, -1}))).size(), 1u);
    config.beam_height_deg = 62;
    EXPECT_EQ(heardBins(pingOf(config, withTarget(3, {12, 0, -1}))).size(), 3u);
}

TEST(MultipathTest, ATargetAboveTheSurfaceIsNotHeard) {
    const auto snapshot = withTarget(3, {12, 0, 4});
    EXPECT_EQ(heardBins(pingOf(mirrored(sonarOf(40, 1)), snapshot)).size(), 0u);
    EXPECT_EQ(heardBins(pingOf(sonarOf(40, 1), snapshot)).size(), 1u);
}

TEST(MultipathTest, PatternsOfTheWayOutAndTheWayBackAreEachTheirOwn) {
    auto config = mirrored(sonarOf(40, 1));
    acoustics::BeamLaw narrow, wide;
    narrow.weighting = wide.weighting = acoustics::Weighting::Gaussian;
    narrow.width_deg = 20;
    wide.width_deg = 60;
    config.beam_pattern.emplace();
    config.beam_pattern->transmit.elevation = narrow;
    config.beam_pattern->receive.elevation = wide;
    config.beam_pattern->floor_db = -150;
    const auto ping = pingOf(config, withTarget(3, {12, 0, -1}));
    const double r1 = std::hypot(12, 1), r2 = std::hypot(12, 7);
    const auto power = [](const acoustics::BeamLaw& law, double angle) {
        return acoustics::BeamPattern(law).power(angle);
    };
    const double down = -std::asin(1 / r1), up = std::asin(7 / r2);
    const double expected =
        (power(narrow, down) * power(wide, up) + power(narrow, up) * power(wide, down)) / (r1 * r1 * r2 * r2);
    const double product = 2 *
                           std::sqrt(power(narrow, down) * power(wide, up) * power(narrow, up) * power(wide, down)) /
                           (r1 * r1 * r2 * r2);
    const double heard = ping.bins[static_cast<size_t>((r1 + r2) / 2 / 0.1)];
    EXPECT_NEAR(decibels(heard / expected), 0, 0.01);
    EXPECT_GT(std::abs(decibels(heard / product)), 1) << "the root of both two-way patterns is another number";
}

/** Energies of a flat bottom 4 m below by a surface 2 m above, in coarse bins of 2 m, by a sum over the bottom. */
struct Bottom {
    std::vector<double> twice = std::vector<double>(15), once = std::vector<double>(15);

    explicit Bottom(double aperture_deg, double wedge) {
        const double half = radians(aperture_deg) / 2, step = 1e-3;
        for (double out = step / 2; out < 60; out += step) {
            const double r1 = std::hypot(out, 4), r2 = std::hypot(out, 8), area = out * wedge * step;
            if (std::atan2(8, out) > half) continue;
            add(twice, r2, area * std::pow(8 / r2, 2) * std::pow(r2, -4));
            if (std::atan2(4, out) <= half) add(once, (r1 + r2) / 2, 2 * area * 4 / r1 * 8 / r2 / (r1 * r1 * r2 * r2));
        }
    }
    static void add(std::vector<double>& bins, double range, double energy) {
        if (range < 30) bins[static_cast<size_t>(range / 2)] += energy;
    }
};

TEST(MultipathTest, ABottomByTheSurfaceIsTheSumOverItsArea) {
    const SonarConfig config = sonarOf(8, 4);
    const auto scene = test::sceneOf({test::ground(-4)});
    const auto ghosts = difference(pingOf(mirrored(config), under(2, scene)), pingOf(config, under(2, scene)));
    const Bottom expected(120, radians(8));
    for (size_t k = 4; k < 15; ++k) {
        double heard = 0;
        for (size_t beam = 0; beam < 4; ++beam)
            for (size_t i = 20 * k; i < 20 * k + 20; ++i) heard += ghosts[beam * 300 + i];
        EXPECT_NEAR(decibels(heard / (expected.once[k] + expected.twice[k])), 0, 0.05) << k;
        EXPECT_GT(std::abs(decibels(heard / (expected.once[k] / 2 + expected.twice[k]))), 1) << k;
    }
}

TEST(MultipathTest, FirstEchoesOfASceneAreTheSameBitForBit) {
    const SonarConfig config = sonarOf(90, 16);
    const auto scene = test::sceneOf({test::ground(-4), test::sphere(1, 24)}, 0, {{}, {9, 1, -1}});
    const auto with = pingOf(mirrored(config), under(2, scene)), without = pingOf(config, under(2, scene));
    size_t same = 0, more = 0;
    for (size_t i = 0; i < with.bins.size(); ++i) {
        EXPECT_GE(with.bins[i], without.bins[i]);
        (with.bins[i] == without.bins[i] ? same : more) += 1;
    }
    EXPECT_GT(more, 500u);
    for (size_t beam = 0; beam < 16; ++beam)
        for (size_t k = 0; k < 40; ++k)  // before any ghost
            EXPECT_EQ(with.bins[beam * 300 + k], without.bins[beam * 300 + k]);
    EXPECT_GT(same, 500u);
}

TEST(MultipathTest, NothingAboveTheSurfaceIsHeard) {
    const auto wall = test::sceneOf({test::wall(10)});
    const auto ping = pingOf(mirrored(sonarOf(8, 1)), under(2, wall));
    // Straight at most to where the wall meets the surface; farther away there are ghosts of what is below it.
    double dry = 0, all = 0;
    const auto open = pingOf(sonarOf(8, 1), under(2, wall));
    for (size_t k = 0; k < 300; ++k) all += open.bins[k];
    for (size_t k = 0; k < 300; ++k) dry += ping.bins[k];
    EXPECT_GT(std::abs(dry / all - 1), 0.01);
    const auto beyond = under(2, test::sceneOf({test::quad({10, -5, 3}, {0, 10, 0}, {0, 0, 3})}));
    EXPECT_TRUE(heardBins(pingOf(mirrored(sonarOf(8, 1)), beyond)).empty());
    EXPECT_FALSE(heardBins(pingOf(sonarOf(8, 1), beyond)).empty());
}

TEST(MultipathTest, WithoutBouncesOrAnythingToReflectEveryBinIsAsItWas) {
    auto config = sonarOf(40, 8);
    const auto snapshot = under(2, test::sceneOf({test::ground(-4)}));
    const auto without = pingOf(config, snapshot).bins;
    EXPECT_EQ(pingOf(mirrored(config, 0, 0), snapshot).bins, without);
    config.multipath.emplace();
    EXPECT_EQ(pingOf(config, snapshot).bins, without);
    auto dry = snapshot;
    dry.water_surface.reset();
    EXPECT_EQ(pingOf(mirrored(config), dry).bins, without);
    dry.water_surface = -1;  // above it
    EXPECT_EQ(pingOf(mirrored(config), dry).bins, without);
    dry.water_surface = 31;  // beyond the range
    EXPECT_EQ(pingOf(mirrored(config), dry).bins, without);
}

}  // namespace
}  // namespace insonify::sonar
