#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "components/scene/Clusters.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::scene {
namespace {

types::Mesh ball(int steps) {
    types::Mesh mesh = test::sphere(2, steps);
    buildClusters(mesh);
    return mesh;
}

TEST(CoarseMeshTest, ALargeMeshHasFewTrianglesThatShowItsShape) {
    const types::Mesh mesh = ball(160);
    ASSERT_GT(mesh.indices.size() / 3, 5 * max_coarse_triangles);
    EXPECT_LE(mesh.coarse_indices.size() / 3, max_coarse_triangles);
    ASSERT_GT(mesh.coarse_indices.size() / 3, max_coarse_triangles / 10);
    for (size_t i = 0; i < mesh.coarse_indices.size(); i += 3) {
        const auto corner = [&](size_t k) { return mesh.positions.at(mesh.coarse_indices[i + k]); };
        const glm::vec3 middle = (corner(0) + corner(1) + corner(2)) / 3.0f;
        EXPECT_GT(glm::length(middle), 1.9f) << "of 2 m, across a triangle";
    }
}

TEST(CoarseMeshTest, ASmallMeshHasNoCoarseMesh) { EXPECT_TRUE(ball(20).coarse_indices.empty()); }

TEST(CoarseMeshTest, EveryMaterialKeepsItsPart) {
    types::Mesh mesh = test::sphere(2, 160);
    const auto half = static_cast<uint32_t>(mesh.indices.size() / 6 * 3);
    mesh.clusters = {
        {.first_index = 0, .index_count = half, .material = 0},
        {.first_index = half, .index_count = static_cast<uint32_t>(mesh.indices.size()) - half, .material = 1}};
    buildClusters(mesh);
    const auto [low, high] =
        std::ranges::minmax(mesh.coarse_indices, {}, [&](uint32_t index) { return mesh.positions[index].z; });
    EXPECT_LT(mesh.positions[low].z, -1.8f);
    EXPECT_GT(mesh.positions[high].z, 1.8f);
    EXPECT_GT(mesh.coarse_indices.size() / 3, max_coarse_triangles / 5);
}

TEST(CoarseMeshTest, ASmallPartOfALargeMeshStaysAsItIs) {
    types::Mesh mesh = test::sphere(2, 160);
    const auto all = static_cast<uint32_t>(mesh.indices.size());
    constexpr uint32_t few = 3 * 100;
    mesh.clusters = {{.first_index = 0, .index_count = all - few, .material = 0},
                     {.first_index = all - few, .index_count = few, .material = 1}};
    buildClusters(mesh);
    uint32_t kept = 0;
    for (const types::Cluster& cluster : mesh.clusters) kept += cluster.material == 1 ? cluster.index_count : 0;
    EXPECT_EQ(kept, few);
    EXPECT_GT(mesh.coarse_indices.size(), few);
    EXPECT_LT(mesh.coarse_indices.size(), 3 * max_coarse_triangles + few + 1);
}

}  // namespace
}  // namespace insonify::scene
