#include <gtest/gtest.h>

#include <algorithm>

#include "components/sonar/raster/Culler.hpp"
#include "tests/sonar/ClusteredHarbour.hpp"

namespace insonify::sonar {
namespace {

/** Returns a random rotation and place within `reach` [m]; half of them are stretched unevenly, mirrored and
 *  sheared. */
glm::dmat4 randomPlace(Random& random, double reach) {
    glm::dmat4 place = glm::rotate(glm::dmat4(1), uniform(random, 0, 6), uniformVector(random, 1) + 1e-3);
    if (uniform(random, 0, 1) < 0.5) {
        place = glm::scale(place, glm::dvec3(uniform(random, 0.1, 6), uniform(random, -3, 3), uniform(random, 0.2, 2)));
        place[1] += uniform(random, -1, 1) * place[0];
    }
    place[3] = glm::dvec4(uniformVector(random, reach), 1);
    return place;
}

/** Makes every triangle a cluster in a box about the middle of its first edge. */
types::Mesh triangleSoup(Random& random, int triangles) {
    types::Mesh mesh;
    for (int i = 0; i < triangles; ++i) {
        const glm::vec3 at(uniformVector(random, 1)), edge(uniformVector(random, 0.5));
        mesh.positions.insert(mesh.positions.end(), {at - edge, at + edge, at + glm::vec3(uniformVector(random, 0.4))});
        const glm::vec3 half = glm::max(glm::abs(edge), glm::abs(mesh.positions.back() - at));
        mesh.clusters.push_back({static_cast<uint32_t>(3 * i), 3, 0, at, half * 1.000001f});
    }
    for (uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    return mesh;
}

bool inView(const ViewFrustum& frustum, glm::dvec3 p, double range_max) {
    const double x = std::cos(frustum.azimuth) * p.x + std::sin(frustum.azimuth) * p.y;
    const double y = std::cos(frustum.azimuth) * p.y - std::sin(frustum.azimuth) * p.x;
    return x > 0 && std::abs(y) <= frustum.extent_u * x && std::abs(p.z) <= frustum.extent_v * x &&
           glm::length(p) <= range_max;
}

/** Returns whether any of some points of the triangle is in view. */
bool triangleSeen(const ViewFrustum& frustum, const glm::dvec3 (&corner)[3], double range_max) {
    for (double a = 0; a <= 1; a += 0.25)
        for (double b = 0; a + b <= 1; b += 0.25)
            if (inView(frustum, a * corner[0] + b * corner[1] + (1 - a - b) * corner[2], range_max)) return true;
    return false;
}

/** Returns for each triangle of each object whether it is in a run. */
std::vector<std::vector<bool>> rasterised(const types::Geometry& geometry, const std::vector<Culler::DrawRange>& runs) {
    std::vector<std::vector<bool>> marks;
    for (const types::Object& object : geometry.objects)
        marks.emplace_back(geometry.meshes[static_cast<size_t>(object.mesh)].indices.size() / 3);
    for (const Culler::DrawRange& run : runs)
        for (uint32_t i = run.first_index / 3; i < (run.first_index + run.index_count) / 3; ++i) {
            EXPECT_FALSE(marks[run.object].at(i)) << "rasterised twice";
            marks[run.object].at(i) = true;
        }
    return marks;
}

struct Count {
    size_t seen = 0, missed = 0, rasterised = 0, all = 0;
};

/** Compares the runs of all frusta with the triangles that are in view. */
Count compare(const SonarConfig& config, const types::Snapshot& snapshot) {
    Culler culler(*snapshot.geometry, {0, {config.range}});
    culler.place(snapshot);
    const glm::dmat4 sonar_from_world = glm::inverse(snapshot.sonar.worldFromBody());
    Count count;
    std::vector<Culler::DrawRange> runs;
    for (const ViewFrustum& frustum : makeFrusta(config, makeBeams(config))) {
        culler.visible(frustum, runs);
        EXPECT_LE(runs.size(), culler.drawRangeLimit());
        const auto marks = rasterised(*snapshot.geometry, runs);
        for (size_t i = 0; i < marks.size(); ++i) {
            const types::Object& object = snapshot.geometry->objects[i];
            glm::dmat4 place = object.world_from_object;
            for (const types::MovedObject& moved : snapshot.moved)
                if (moved.object == i) place = moved.world_from_object;
            const types::Mesh& mesh = snapshot.geometry->meshes[static_cast<size_t>(object.mesh)];
            for (size_t t = 0; t < marks[i].size(); ++t) {
                glm::dvec3 corner[3];
                for (size_t k = 0; k < 3; ++k)
                    corner[k] = sonar_from_world * place * glm::dvec4(mesh.positions[mesh.indices[3 * t + k]], 1);
                const bool seen = triangleSeen(frustum, corner, config.range);
                count.seen += seen;
                count.missed += seen && !marks[i][t];
                count.rasterised += marks[i][t];
                ++count.all;
            }
        }
    }
    return count;
}

types::Snapshot randomSnapshot(Random& random, types::GeometryPtr geometry) {
    return test::makeSnapshot(std::move(geometry), uniformVector(random, 10), uniform(random, -3, 3),
                              uniform(random, -1, 1), uniform(random, -3, 3));
}

/** A sphere of 1 m, with itself as bounding sphere. */
types::Mesh ball() { return test::sphere(1, 8); }

/** Runs over all frusta for one sphere of 1 m about `position`, the sonar at the origin. */
size_t runsOfBall(glm::dvec3 position, double field_of_view_deg = 60) {
    const auto snapshot = test::makeSnapshot(test::makeScene({ball()}, 0, {position}));
    const SonarConfig config = fan(field_of_view_deg);
    Culler culler(*snapshot.geometry, {0, {config.range}});
    culler.place(snapshot);
    size_t count = 0;
    for (const ViewFrustum& frustum : makeFrusta(config, makeBeams(config))) {
        std::vector<Culler::DrawRange> runs;
        culler.visible(frustum, runs);
        count += runs.size();
    }
    return count;
}

/** One cluster for each mesh, which reaches into every view. */
types::GeometryPtr withoutCulling(const types::Geometry& geometry) {
    auto whole = std::make_shared<types::Geometry>(geometry);
    for (types::Mesh& mesh : whole->meshes) {
        mesh.clusters = {{0, static_cast<uint32_t>(mesh.indices.size()), 0, {0, 0, 0}, glm::vec3(1e6f)}};
        mesh.cluster_nodes.clear();
    }
    return whole;
}

}  // namespace

TEST(CullerTest, CullsNothingInViewOfAFrustum) {
    Random random(1);
    Count total;
    for (int round = 0; round < 200; ++round) {
        auto geometry = std::make_shared<types::Geometry>();
        geometry->materials.resize(1);
        geometry->meshes = {triangleSoup(random, 20), triangleSoup(random, 5)};
        for (int i = 0; i < 30; ++i)
            geometry->objects.push_back(
                {"object", i % 2, randomPlace(random, i % 5 ? 40 : 2)});  // some about the sonar
        types::Snapshot snapshot = randomSnapshot(random, geometry);
        for (uint32_t i = 0; i < 8; ++i) snapshot.moved.push_back({i, randomPlace(random, 30)});
        for (double degrees : {10.0, 130.0, 360.0}) {
            const Count count = compare(fan(degrees), snapshot);
            EXPECT_EQ(count.missed, 0u) << "round " << round << ", " << degrees << " deg";
            total.seen += count.seen;
            total.rasterised += count.rasterised;
            total.all += count.all;
        }
    }
    EXPECT_GT(total.seen, 8'000u);
    EXPECT_LT(total.rasterised, total.all / 2) << "most of the scene is out of view";
}

TEST(CullerTest, CullsNoTriangleOfAClusterInView) {
    Random random(2);
    const auto geometry = clusteredHarbour();
    geometry->materials[0].double_sided = true;  // another test culls backs
    ASSERT_GT(geometry->meshes[0].clusters.size(), 100u);
    for (int round = 0; round < 4; ++round) {
        auto turned = std::make_shared<types::Geometry>(*geometry);
        for (types::Object& object : turned->objects)
            object.world_from_object = randomPlace(random, 5) * object.world_from_object;
        for (const types::GeometryPtr& scene : {types::GeometryPtr(geometry), types::GeometryPtr(turned)}) {
            const Count count = compare(fan(130), randomSnapshot(random, scene));
            EXPECT_EQ(count.missed, 0u) << round;
            EXPECT_LT(count.rasterised, count.all);
        }
    }
}

TEST(CullerTest, CullsObjectsBehindAsideAboveOrBeyondTheRange) {
    EXPECT_EQ(runsOfBall({10, 0, 0}), 1u);
    EXPECT_EQ(runsOfBall({-10, 0, 0}), 0u) << "behind";
    EXPECT_EQ(runsOfBall({10, 9, 0}), 0u) << "to port";
    EXPECT_EQ(runsOfBall({10, -9, 0}), 0u) << "to starboard";
    EXPECT_EQ(runsOfBall({10, 0, 9}), 0u) << "above";
    EXPECT_EQ(runsOfBall({10, 0, -9}), 0u) << "below";
    EXPECT_EQ(runsOfBall({32, 0, 0}), 0u) << "too far";
    EXPECT_EQ(runsOfBall({30.5, 0, 0}), 1u) << "its near side is in range";
}

TEST(CullerTest, AnObjectAroundTheSonarIsInEveryFrustum) {
    EXPECT_EQ(runsOfBall({0, 0, 0}, 360), 6u);
    EXPECT_EQ(runsOfBall({10, 0, 0}, 360), 2u) << "the frusta of a full turn meet ahead";
}

TEST(CullerTest, AMovedObjectIsCulledByItsNewPlace) {
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({ball()}, 0, {{-10, 0, 0}}));
    Culler culler(*snapshot.geometry, {0, {30}});
    std::vector<Culler::DrawRange> runs;
    const ViewFrustum frustum = makeFrusta(fan(60), makeBeams(fan(60))).front();
    culler.place(snapshot);
    culler.visible(frustum, runs);
    EXPECT_TRUE(runs.empty());
    snapshot.moved = {{0, glm::translate(glm::dmat4(1), {10.0, 0.0, 0.0})}};
    culler.place(snapshot);
    culler.visible(frustum, runs);
    EXPECT_EQ(runs.size(), 1u);
    snapshot.moved.clear();
    culler.place(snapshot);
    culler.visible(frustum, runs);
    EXPECT_TRUE(runs.empty()) << "back at its place";
}

TEST(CullerTest, ThePingOfClustersCulledByViewMatchesTheWholeScene) {
    const auto clustered = clusteredHarbour();
    for (double degrees : {50.0, 100.0, 360.0}) {
        SonarConfig config = fan(degrees);
        config.range = 120;  // contains the whole scene
        const auto culled = pings(config, clustered);
        EXPECT_EQ(culled, pings(config, withoutCulling(*clustered))) << degrees << " deg";
        EXPECT_GT(std::count_if(culled.begin(), culled.end(), [](float x) { return x > 0; }), 3000);
    }
}

TEST(CullerTest, CullingByRangeRemovesOnlyEchoesThatPixelsBeyondItSmearBack) {
    const auto clustered = clusteredHarbour();
    const auto culled = pings(fan(100), clustered), all = pings(fan(100), withoutCulling(*clustered));
    const float maximum = *std::ranges::max_element(all);
    for (size_t i = 0; i < all.size(); ++i) {
        EXPECT_LE(culled[i], all[i]) << i;
        EXPECT_NEAR(culled[i], all[i], 1e-5 * maximum) << i;
    }
}

}  // namespace insonify::sonar
