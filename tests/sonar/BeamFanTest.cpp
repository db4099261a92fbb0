#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using types::radians;

SonarConfig plainFan(double field_of_view_deg, int beams, int columns_per_beam = 2) {
    SonarConfig config;
    config.field_of_view_deg = field_of_view_deg;
    config.beam_count = beams;
    config.quality.columns_per_beam = columns_per_beam;
    config.quality.rows = 64;
    config.device = "software";
    return config;
}

/** A part of an image row in u. */
struct Part {
    double from, to;
};

/** Each beam's parts of one row of a frustum, in the order of the columns. */
std::vector<std::vector<Part>> partsOfBeams(const ColumnShares& shares, const ViewFrustum& frustum, size_t beams,
                                            int row = 0) {
    std::vector<std::vector<Part>> parts(beams);
    for (int column = 0; column < frustum.columns; ++column) {
        const size_t cell = shares.cell(row, column, frustum.columns);
        for (uint32_t i = shares.starts[cell]; i < shares.starts[cell + 1]; ++i) {
            const ShareRecord& share = shares.shares[i];
            parts[share.beam].push_back({share.middle - share.width / 2, share.middle + share.width / 2});
        }
    }
    return parts;
}

/** Expects the parts to tile the image from one bearing to the other, as far as the frustum shows it. */
void expectTiled(const std::vector<Part>& parts, const ViewFrustum& frustum, const Beam& beam) {
    const double from = std::max(beam.low - frustum.azimuth, -frustum.half_width);
    const double to = std::min(beam.high - frustum.azimuth, frustum.half_width);
    EXPECT_EQ(parts.empty(), to - from < 1e-9);
    if (parts.empty()) return;
    EXPECT_NEAR(parts.front().from, std::tan(from), 1e-9);
    EXPECT_NEAR(parts.back().to, std::tan(to), 1e-9);
    for (size_t i = 1; i < parts.size(); ++i) EXPECT_NEAR(parts[i].from, parts[i - 1].to, 1e-9);
}

/** A sonar of 40 m range in bins of 0.1 m. */
types::Sonar plainPing(SonarConfig config, const types::Snapshot& snapshot) {
    config.speed_of_sound = 1000;
    config.range = 40;
    config.bin_count = 400;
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping;
}

std::vector<float> getBeam(const types::Sonar& ping, uint32_t k) {
    return {ping.bins.begin() + k * ping.bin_count, ping.bins.begin() + (k + 1) * ping.bin_count};
}

/** Inside of a room of 24 x 20 m, 6 m high, in the middle of which the sonar is. */
types::Snapshot room(double yaw = 0) {
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({test::block()}));
    geometry->objects[0].world_from_object = glm::scale(glm::dmat4(1), {12.0, 10.0, 3.0});
    return test::makeSnapshot(geometry, {}, yaw);
}

}  // namespace

TEST(BeamFanTest, FrustaOfAtMostSixtyDegreesCoverTheFanWithoutGapOrOverlap) {
    for (double degrees = 1; degrees <= 360; degrees += 0.5) {
        const SonarConfig config = plainFan(degrees, 64);
        const auto frusta = makeFrusta(config, makeBeams(config));
        ASSERT_EQ(frusta.size(), static_cast<size_t>(std::ceil(degrees / 60)));
        EXPECT_NEAR(frusta.front().azimuth - frusta.front().half_width, -radians(degrees) / 2, 1e-12);
        EXPECT_NEAR(frusta.back().azimuth + frusta.back().half_width, radians(degrees) / 2, 1e-12);
        for (const ViewFrustum& frustum : frusta) {
            EXPECT_LE(frustum.half_width, radians(30) + 1e-9);
            EXPECT_NEAR(frustum.extent_u, std::tan(frustum.half_width), 1e-12);
        }
        for (size_t i = 1; i < frusta.size(); ++i)
            EXPECT_NEAR(frusta[i].azimuth - frusta[i].half_width, frusta[i - 1].azimuth + frusta[i - 1].half_width,
                        1e-12);
    }
}

TEST(BeamFanTest, TheImageIncludesTheApertureInItsCorners) {
    const SonarConfig config = plainFan(100, 10);
    for (const ViewFrustum& frustum : makeFrusta(config, makeBeams(config)))
        EXPECT_NEAR(std::atan(frustum.extent_v * std::cos(frustum.half_width)), radians(config.beam_height_deg / 2),
                    1e-12);
}

TEST(BeamFanTest, BeamsPartitionTheFanFromStarboardToPort) {
    const auto beams = makeBeams(plainFan(130, 512));
    ASSERT_EQ(beams.size(), 512u);
    EXPECT_NEAR(beams.front().low, -radians(65), 1e-12);
    EXPECT_NEAR(beams.back().high, radians(65), 1e-12);
    for (size_t k = 0; k < beams.size(); ++k) {
        EXPECT_NEAR(beams[k].high - beams[k].low, radians(130) / 512, 1e-12);
        EXPECT_NEAR(beams[k].centre, (beams[k].low + beams[k].high) / 2, 1e-12);
    }
    for (size_t k = 1; k < beams.size(); ++k) EXPECT_NEAR(beams[k].low, beams[k - 1].high, 1e-12);
}

TEST(BeamFanTest, SharesOfAColumnAddUpToItsWidth) {
    for (double degrees : {1.0, 59.0, 61.0, 130.0, 360.0})
        for (int columns_per_beam : {1, 2, 7}) {
            const SonarConfig config = plainFan(degrees, 33, columns_per_beam);
            const auto beams = makeBeams(config);
            for (const ViewFrustum& frustum : makeFrusta(config, beams)) {
                const ColumnShares shares = makeShares(config, beams, frustum);
                std::vector<double> widths(static_cast<size_t>(frustum.columns));
                for (const ShareRecord& share : shares.shares) widths[share.column] += share.width;
                for (double width : widths) EXPECT_NEAR(width, frustum.du(), 1e-8 * frustum.du());
            }
        }
}

TEST(BeamFanTest, EachBeamOwnsExactlyItsBearings) {
    for (double degrees : {10.0, 130.0, 360.0}) {
        const SonarConfig config = plainFan(degrees, 50, 3);
        const auto beams = makeBeams(config);
        for (const ViewFrustum& frustum : makeFrusta(config, beams)) {
            const auto parts = partsOfBeams(makeShares(config, beams, frustum), frustum, beams.size());
            for (size_t k = 0; k < beams.size(); ++k) expectTiled(parts[k], frustum, beams[k]);
        }
    }
}

TEST(BeamFanTest, ATableMayHaveGapsOverlapsAndAnyOrder) {
    SonarConfig config = plainFan(0, 0);
    config.bearings_deg = {-50, -10, -9, 0, 33.3, 60};
    config.beam_width_deg = 4;
    const auto beams = makeBeams(config);
    ASSERT_EQ(beams.size(), 6u);
    for (size_t k = 0; k < beams.size(); ++k) {
        EXPECT_NEAR(beams[k].centre, radians(config.bearings_deg[k]), 1e-12);
        EXPECT_NEAR(beams[k].high - beams[k].low, radians(4), 1e-12);
    }
    const auto frusta = makeFrusta(config, beams);
    EXPECT_EQ(frusta.size(), 2u) << "114 deg";
    for (const ViewFrustum& frustum : frusta) {
        const auto parts = partsOfBeams(makeShares(config, beams, frustum), frustum, beams.size());
        for (size_t k = 0; k < beams.size(); ++k) expectTiled(parts[k], frustum, beams[k]);
    }
}

TEST(BeamFanTest, ConicalBoundariesAreHyperbolasInTheImage) {
    SonarConfig config = plainFan(130, 16, 4);
    config.beam_geometry = BeamGeometry::Conical;
    config.beam_height_deg = 40;
    const auto beams = makeBeams(config);
    int checked = 0;
    for (const ViewFrustum& frustum : makeFrusta(config, beams)) {
        const ColumnShares shares = makeShares(config, beams, frustum);
        ASSERT_TRUE(shares.per_row);
        for (int row = 0; row < frustum.rows; ++row) {
            const auto parts = partsOfBeams(shares, frustum, beams.size(), row);
            for (size_t k = 0; k < beams.size(); ++k) {
                if (parts[k].empty() || parts[k].back().to > frustum.extent_u * (1 - 1e-9))
                    continue;  // continues in the next frustum
                const double in_frustum = std::atan(parts[k].back().to);
                const double elevation = std::atan(frustum.v(row + 0.5) * std::cos(in_frustum));
                EXPECT_NEAR(std::sin(frustum.azimuth + in_frustum) * std::cos(elevation), std::sin(beams[k].high),
                            1e-6);
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 800);
}

TEST(BeamFanTest, NoBeamIsEmptyIfBeamsAreNarrowerThanColumns) {
    const SonarConfig config = plainFan(360, 4096, 1);  // in the middle of a frustum columns are 1.1 beams wide
    const auto beams = makeBeams(config);
    std::vector<int> shares_of(beams.size());
    for (const ViewFrustum& frustum : makeFrusta(config, beams))
        for (const ShareRecord& share : makeShares(config, beams, frustum).shares) ++shares_of[share.beam];
    EXPECT_EQ(std::ranges::count(shares_of, 0), 0);

    const auto ping = plainPing(plainFan(110, 1000, 1), room());
    for (uint32_t k = 0; k < ping.beam_count; ++k) {
        const auto beam = getBeam(ping, k);
        EXPECT_GT(std::accumulate(beam.begin(), beam.end(), 0.0), 0) << k;
    }
}

TEST(BeamFanTest, ABeamOfAFullTurnIsThatOfASonarOfTenDegrees) {
    SonarConfig full = plainFan(360, 360, 4), narrow = plainFan(10, 10, 4);
    full.quality.rows = narrow.quality.rows = 512;
    const auto all = plainPing(full, room());
    for (int first : {0, 55, 117, 175, 236, 350}) {
        const auto few = plainPing(narrow, room(radians(first + 5 - 180)));
        for (uint32_t k = 0; k < 10; ++k)
            EXPECT_LT(test::relativeL2(getBeam(all, static_cast<uint32_t>(first) + k), getBeam(few, k)), 1e-3)
                << first + k;
    }
}

TEST(BeamFanTest, AWallThroughThreeFrustaHasNoSeam) {
    // Rotated by ten beams, the same bearings of the world are at other places in the frusta.
    const auto wall = test::makeScene({test::quad({10, -300, -50}, {0, 600, 0}, {0, 0, 100})});
    SonarConfig config = plainFan(150, 150, 4);
    config.quality.rows = 512;
    const auto straight = plainPing(config, test::makeSnapshot(wall));
    const auto turned = plainPing(config, test::makeSnapshot(wall, {}, radians(10)));
    for (uint32_t k = 10; k < 140; ++k)
        EXPECT_LT(test::relativeL2(getBeam(straight, k), getBeam(turned, k - 10)), 1e-3) << k;
}

TEST(BeamFanTest, LevelGroundIsTheSameInEveryBeamOfThreeFrusta) {
    SonarConfig config = plainFan(150, 150, 4);
    config.quality.rows = 512;
    const auto ping = plainPing(config, test::makeSnapshot(test::makeScene({test::ground(-5)})));
    for (uint32_t k = 0; k < 150; ++k) EXPECT_LT(test::relativeL2(getBeam(ping, k), getBeam(ping, 75)), 1e-3) << k;
}

}  // namespace insonify::sonar
