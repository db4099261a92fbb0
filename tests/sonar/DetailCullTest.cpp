// Backs of large meshes are culled although they are in view; all other detail is rasterised.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/raster/Culler.hpp"
#include "components/study/StudyScene.hpp"
#include "tests/sonar/ClusteredHarbour.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Returns the number of rasterised triangles over all frusta of `config`. */
size_t drawnBy(const SonarConfig& config, const types::Snapshot& snapshot) {
    Culler culler(*snapshot.geometry, {0, {config.range}});
    culler.place(snapshot);
    size_t rasterised = 0;
    std::vector<Culler::DrawRange> runs;
    for (const ViewFrustum& frustum : makeFrusta(config, makeBeams(config))) {
        culler.visible(frustum, runs);
        EXPECT_LE(runs.size(), culler.drawRangeLimit());
        for (const Culler::DrawRange& run : runs) rasterised += run.index_count / 3;
    }
    return rasterised;
}

/** rel_l2_tvg: relative L2 of energies times the fifth power of their range. */
double relativeError(const types::Sonar& got, const types::Sonar& reference) {
    double error = 0, norm = 0;
    for (size_t i = 0; i < reference.bins.size(); ++i) {
        const double range = static_cast<double>(i % reference.bin_count) + 0.5, weight = std::pow(range, 5);
        error += std::pow(weight * (double{got.bins[i]} - reference.bins[i]), 2);
        norm += std::pow(weight * reference.bins[i], 2);
    }
    return std::sqrt(error / norm);
}

/** The same floor of 522,242 triangles as one large mesh, as 64 meshes that are not split, and as its outline. */
struct Floors {
    types::GeometryPtr one, tiles, outline;

    Floors() {
        study::FractalFloor floor;
        floor.centre_x = 20;
        floor.depth = 0;
        floor.seed = 2;
        types::Mesh whole = study::getMesh(floor);
        scene::buildClusters(whole);
        one = test::makeScene({whole}, -16.7f);
        std::vector<types::Mesh> parts = study::makeTiles(floor, 8);
        for (types::Mesh& part : parts) scene::buildClusters(part);
        tiles = test::makeScene(std::move(parts), -16.7f);
        outline = test::makeScene({test::getMesh(whole.positions, whole.coarse_indices)}, -16.7f);
    }
};

/** A place of a sonar over the floor, and its range. */
struct Look {
    glm::dvec3 position;
    double yaw, pitch_deg, range;
};

types::Sonar computeReceived(const types::GeometryPtr& geometry, const Look& look) {
    SonarConfig config;
    config.speed_of_sound = 1000;
    config.beam_count = 128;
    config.field_of_view_deg = 90;
    config.bin_count = 400;
    config.range = look.range;
    config.quality.rows = 256;
    config.quality.columns_per_beam = 2;
    config.device = "software";
    types::Sonar ping;
    SonarRenderer(config, geometry)
        .render(test::makeSnapshot(geometry, look.position, look.yaw, types::radians(look.pitch_deg)), ping);
    return ping;
}

}  // namespace

TEST(DetailCullTest, TheBacksOfAClosedMeshAreCulledWithoutChangingABin) {
    const auto geometry = clusteredHarbour();
    types::Mesh& ball = geometry->meshes[1];
    const SonarConfig config = fan(360);
    const types::Snapshot snapshot = test::makeSnapshot(geometry);
    const size_t fronts = drawnBy(config, snapshot);
    const auto without_backs = pings(config, geometry);

    const auto both_sides = std::make_shared<types::Geometry>(*geometry);
    both_sides->materials[0].double_sided = true;
    const size_t triangles = ball.indices.size() / 3;
    EXPECT_LT(fronts + 2 * triangles / 4, drawnBy(config, test::makeSnapshot(both_sides))) << "of ball and egg";
    EXPECT_EQ(without_backs, pings(config, both_sides));
    EXPECT_GT(std::ranges::count_if(without_backs, [](float bin) { return bin > 0; }), 1000);
}

TEST(DetailCullTest, TheBackOfAClosedMeshEchoesFromWithin) {
    const auto geometry = test::makeScene({test::sphere(5, 80)});
    const auto clustered = std::make_shared<types::Geometry>(*geometry);
    scene::buildClusters(clustered->meshes[0]);
    ASSERT_LT(clustered->meshes[0].clusters[0].cone_cutoff, 1);
    types::Sonar ping;
    SonarRenderer(fan(60), clustered).render(test::makeSnapshot(clustered), ping);
    EXPECT_GT(*std::ranges::max_element(ping.bins), 0);
}

TEST(DetailCullTest, ARoughFloorEchoesTheSameInOneMeshAndInManySmallMeshes) {
    const Floors floors;
    ASSERT_FALSE(floors.one->meshes[0].cluster_nodes.empty());
    ASSERT_TRUE(floors.tiles->meshes[0].cluster_nodes.empty());
    for (const Look& look : {Look{{0, 0, 3}, 0, 8, 40}, Look{{0, 0, 3}, 0, 8, 15}, Look{{0, 0, 8}, 0.3, 25, 40},
                             Look{{10, 5, 1.5}, -0.4, 2, 30}}) {
        const types::Sonar one = computeReceived(floors.one, look), tiles = computeReceived(floors.tiles, look);
        const double error = relativeError(one, tiles);
        RecordProperty(fmt::format("rel_l2_tvg {:g} m above, to {:g} m", look.position.z, look.range),
                       fmt::format("{:.5f}", error));
        EXPECT_LT(error, 0.005) << look.position.z << " m above, to " << look.range << " m";
        EXPECT_GT(relativeError(computeReceived(floors.outline, look), tiles), 0.05)
            << "fewer triangles are another floor";
    }
}

TEST(DetailCullTest, DrawAllRasterisesTheWholeSceneWithTheSameEchoes) {
    const auto geometry = clusteredHarbour();
    SonarConfig config = fan(100);
    config.range = 120;  // contains the whole scene
    const auto culled = pings(config, geometry);
    config.draw_all = true;
    EXPECT_EQ(culled, pings(config, geometry));
    SonarRenderer renderer(config, geometry);
    types::Sonar ping;
    renderer.render(test::makeSnapshot(geometry), ping);
    for (const Omitted& what : renderer.omissions()) EXPECT_NE(what.reason, Reason::OutOfView) << what.effect;
}

}  // namespace insonify::sonar
