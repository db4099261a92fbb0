// No point of an object, and no echo of it, is nearer than its nearest point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "components/scene/Clusters.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "components/sonar/surfaces/ObjectPlacements.hpp"
#include "tests/sonar/ClusteredHarbour.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::sonar {
namespace {

/** Returns the min distance to many points of the triangles, in double. */
double sampledDistance(const types::Mesh& mesh, const glm::dmat4& place) {
    constexpr int steps = 40;
    double nearest = 1e9;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto corner = [&](size_t k) {
            return glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[i + k]], 1));
        };
        const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
        for (int s = 0; s <= steps; ++s)
            for (int t = 0; s + t <= steps; ++t)
                nearest = std::min(nearest, glm::length(a + (b - a) * (1.0 * s / steps) + (c - a) * (1.0 * t / steps)));
    }
    return nearest;
}

double distance(const types::Mesh& mesh, const glm::dmat4& place) {
    std::vector<float> scratch;
    return distancesTo(mesh, longestEdge(mesh), place, scratch).nearest;
}

types::Mesh randomMesh(Random& random, int triangles) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (int i = 0; i < triangles; ++i) {
        const glm::vec3 at(uniformVector(random, 1));
        for (int k = 0; k < 3; ++k) {
            indices.push_back(static_cast<uint32_t>(positions.size()));
            positions.push_back(at + glm::vec3(uniformVector(random, 0.3)));
        }
    }
    return test::getMesh(positions, indices);
}

/** A ball of 40 rings, 5 m away, whose box has a corner 1.1 m nearer than it is. */
types::Snapshot ballAcrossItsBox() {
    const glm::dvec3 place = 5.0 * glm::normalize(glm::dvec3(1, 1, 1));
    const auto scene = test::makeScene({test::sphere(1.5f, 40)}, 0, {place});
    return test::makeSnapshot(scene, {}, std::atan2(1.0, 1.0), -std::asin(1 / std::sqrt(3.0)));
}

/** Returns the range at which the first bin with an echo ends [m]. */
double firstEcho(Visibility visibility) {
    SonarConfig config = test::getSonar(
        {.beams = 32, .width_deg = 60, .height_deg = 60, .bins = 500, .bin = 0.02, .rows = 32, .columns = 1});
    config.visibility = visibility;
    config.device = "software";
    const types::Sonar ping = test::makePing(config, ballAcrossItsBox());
    size_t first = ping.bin_count;
    for (size_t i = 0; i < ping.bins.size(); ++i)
        if (ping.bins[i] > 0) first = std::min(first, i % ping.bin_count);
    return makeBinGrid(config).edge(static_cast<int>(first) + 1);
}

}  // namespace

TEST(NearestPointTest, MatchesManyPointsOfTheTriangles) {
    Random random(3);
    for (int i = 0; i < 40; ++i) {
        const types::Mesh mesh = randomMesh(random, 60);
        glm::dmat4 place = glm::scale(glm::rotate(glm::dmat4(1), 0.1 * i, {1, 2, 3}), {1.0, -0.7, 1.4});
        place[3] = glm::dvec4(uniformVector(random, 4), 1);
        const double expected = sampledDistance(mesh, place);
        EXPECT_LE(distance(mesh, place), expected + 1e-5);
        EXPECT_GE(distance(mesh, place), expected - 0.02) << "between the points";
    }
}

TEST(NearestPointTest, IsTheSameForAMeshOfManyClusters) {
    types::Mesh ball = test::sphere(1.5f, 200);
    const types::Mesh whole = test::sphere(1.5f, 40);
    scene::buildClusters(ball);
    ASSERT_FALSE(ball.cluster_nodes.empty());
    for (const glm::dvec3 at : {glm::dvec3(5, 0, 0), {0.9, 0.4, 0}, {-2, 3, 1}, {0, 0, 1.6}}) {
        const glm::dmat4 place = glm::translate(glm::dmat4(1), at);
        const double expected = std::abs(glm::length(at) - 1.5);
        EXPECT_NEAR(distance(ball, place), expected, 5e-3);
        EXPECT_NEAR(distance(whole, place), expected, 5e-3);
    }
}

TEST(NearestPointTest, IsALowerBoundForVeryManyTrianglesAtSimilarDistances) {
    types::Mesh ball = test::sphere(1.5f, 200);
    scene::buildClusters(ball);
    const double got = distance(ball, glm::translate(glm::dmat4(1), {0.01, 0, 0}));
    EXPECT_LE(got, 1.49 + 1e-5);
    EXPECT_GT(got, 1.2);
}

TEST(NearestPointTest, DoesNotOverestimateTheDistanceOfALargeFloor) {
    const auto scene = test::makeScene({test::ground(-1, 20'000)});
    ObjectPlacements places(*scene, {}, true);
    for (int i = 0; i < 300; ++i) {
        const double above = 0.5 + 0.01 * i;
        places.place(test::makeSnapshot(scene, {7.3 * i, -3.1 * i, above - 1}, 0.02 * i, 0.003 * i, 0.001 * i));
        EXPECT_GE(double{places.records()[0].extent.x}, 1 / above) << above << " m above";
        EXPECT_LE(double{places.records()[0].extent.x}, 1 / (above - 0.03)) << above << " m above";
    }
}

TEST(NearestPointTest, NoEchoIsBeforeAnObject) {
    const double nearest = 3.5, bin = 0.02;
    for (Visibility visibility : {Visibility::Cpu, Visibility::Gl}) {
        EXPECT_GE(firstEcho(visibility), nearest - bin);
        EXPECT_LE(firstEcho(visibility), nearest + 3 * bin);
    }
}

/** Random meshes of few and of many corners, turned and scaled: no corner is farther, and one is that far. */
TEST(NearestPointTest, TheFarthestCornerIsFoundToo) {
    Random random(9);
    for (const int triangles : {1, 40, 700, 6000})
        for (int trial = 0; trial < 5; ++trial) {
            types::Mesh mesh = randomMesh(random, triangles);
            scene::buildClusters(mesh);
            const glm::dmat4 place = glm::translate(glm::dmat4(1), uniformVector(random, 6)) *
                                     glm::rotate(glm::dmat4(1), 1.0 + trial, uniformVector(random, 1)) *
                                     glm::scale(glm::dmat4(1), glm::dvec3(1, 0.6, 1.7));
            double farthest = 0;
            for (const uint32_t index : mesh.indices)
                farthest = std::max(farthest, glm::length(glm::dvec3(place * glm::dvec4(mesh.positions[index], 1))));
            std::vector<float> scratch;
            EXPECT_NEAR(distancesTo(mesh, longestEdge(mesh), place, scratch).farthest, farthest, 2e-5 * farthest)
                << triangles;
        }
}

}  // namespace insonify::sonar
