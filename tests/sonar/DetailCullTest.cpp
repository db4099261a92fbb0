// What of large meshes is not drawn though it is in view: backs, and detail that no pixel can show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/Culler.hpp"
#include "tests/sonar/ClusteredHarbour.hpp"

namespace insonify::sonar {
namespace {

/** Triangles drawn over all slabs of `config`, and how many are drawn in the place of others. */
struct Drawn {
    size_t all = 0, coarse = 0, replaced = 0;
};
Drawn drawnBy(const SonarConfig& config, const types::Snapshot& snapshot, double pixels, double metres) {
    Culler culler(*snapshot.geometry, {config.range_min, config.range, pixels, metres});
    culler.place(snapshot);
    Drawn drawn;
    std::vector<Culler::Run> runs;
    for (const Slab& slab : makeSlabs(config, makeBeams(config))) {
        culler.visible(slab, runs);
        EXPECT_LE(runs.size(), culler.runLimit());
        for (const Culler::Run& run : runs) {
            drawn.all += run.index_count / 3;
            if (run.stands_for) drawn.coarse += run.index_count / 3;
            drawn.replaced += run.stands_for / 3;
        }
    }
    return drawn;
}

}  // namespace

TEST(DetailCullTest, TheBacksOfAClosedMeshAreNotDrawnAndNoBinMissesThem) {
    const auto geometry = clusteredHarbour();
    types::Mesh& ball = geometry->meshes[1];
    const SonarConfig config = fan(360);
    const types::Snapshot snapshot = test::snapshotOf(geometry);
    const size_t fronts = drawnBy(config, snapshot, 0, 0).all;
    const auto without_backs = pings(config, geometry);

    const auto both_sides = std::make_shared<types::Geometry>(*geometry);
    both_sides->materials[0].double_sided = true;
    const size_t triangles = ball.indices.size() / 3;
    EXPECT_LT(fronts + 2 * triangles / 4, drawnBy(config, test::snapshotOf(both_sides), 0, 0).all) << "of ball and egg";
    EXPECT_EQ(without_backs, pings(config, both_sides));
    EXPECT_GT(std::ranges::count_if(without_backs, [](float bin) { return bin > 0; }), 1000);
}

TEST(DetailCullTest, FromWithinAClosedMeshItsBackIsHeard) {
    const auto geometry = test::sceneOf({test::sphere(5, 80)});
    const auto clustered = std::make_shared<types::Geometry>(*geometry);
    scene::buildClusters(clustered->meshes[0]);
    ASSERT_LT(clustered->meshes[0].clusters[0].cone_cutoff, 1);
    types::Sonar ping;
    SonarRenderer(fan(60), clustered).render(test::snapshotOf(clustered), ping);
    EXPECT_GT(*std::ranges::max_element(ping.bins), 0);
}

TEST(DetailCullTest, WherePixelsAreCoarseAQuarterOfTheTrianglesOrFewerStandsForAPatch) {
    const auto geometry = clusteredHarbour();
    const types::Snapshot snapshot = test::snapshotOf(geometry);
    const SonarConfig config = fan(120);
    const Drawn all = drawnBy(config, snapshot, 0, 0), half = drawnBy(config, snapshot, 0.5, 0.05),
                much = drawnBy(config, snapshot, 100, 10), fine = drawnBy(config, snapshot, 1, 1e-9);
    EXPECT_EQ(all.coarse, 0u);
    EXPECT_EQ(fine.coarse, 0u) << "no more than so many metres";
    EXPECT_GT(half.replaced, 2 * half.coarse);
    EXPECT_LT(half.all, all.all);
    EXPECT_LT(much.all, half.all);
}

TEST(DetailCullTest, WhatStandsForAPatchOfABallFacesTheSonarLimbsAreDrawnInFull) {
    const auto geometry = test::sceneOf({test::sphere(1, 128)}, -10, {{10, 0, 0}});
    types::Mesh& ball = const_cast<types::Geometry&>(*geometry).meshes[0];
    scene::buildClusters(ball);
    const SonarConfig config = fan(40);
    Culler culler(*geometry, {config.range_min, config.range, 10, 1});
    culler.place(test::snapshotOf(geometry));
    std::vector<Culler::Run> runs;
    culler.visible(makeSlabs(config, makeBeams(config)).front(), runs);
    size_t coarse = 0;
    for (const Culler::Run& run : runs) {
        if (!run.stands_for) continue;
        for (size_t i = run.first_index - ball.indices.size();
             i < run.first_index - ball.indices.size() + run.index_count; i += 3) {
            const auto corner = [&](size_t k) { return ball.positions[ball.coarse_indices[i + k]]; };
            const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
            EXPECT_LE(glm::dot(normal, corner(0) + glm::vec3(10, 0, 0)), 0) << "seen from -10 m on its x axis";
            ++coarse;
        }
    }
    EXPECT_GT(coarse, 100u) << "nothing was simplified";
}

TEST(DetailCullTest, SimplerSurfacesChangeAPingByLessThanItsPixelsDo) {
    const auto geometry = clusteredHarbour();
    const auto rms = [](const std::vector<float>& a, const std::vector<float>& b) {
        double difference = 0, norm = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            difference += std::pow(static_cast<double>(a[i]) - b[i], 2);
            norm += std::pow(b[i], 2);
        }
        return std::sqrt(difference / norm);
    };
    SonarConfig config = fan(120);
    config.range = 60;
    const auto all = pings(config, geometry);
    config.detail = 0.5;
    const auto simpler = pings(config, geometry);
    config.detail = 0;
    config.quality.rows = 96 * 3;
    config.quality.columns_per_beam = 6;
    const auto finer = pings(config, geometry);
    EXPECT_GT(rms(simpler, all), 0) << "nothing was simplified";
    EXPECT_LT(rms(simpler, all), 0.5 * rms(all, finer));
}

}  // namespace insonify::sonar
