#include <sched.h>

#include <array>
#include <set>

#include "components/scene/Clusters.hpp"
#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

/** A grid of n x n unit squares, the left half of one material and the right half of another. */
types::Mesh grid(uint32_t n) {
    types::Mesh mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x) {
            mesh.positions.emplace_back(x, y, 0);
            mesh.uvs.emplace_back(x, y);
        }
    for (uint32_t half = 0; half < 2; ++half) {
        types::Cluster run;
        run.first_index = static_cast<uint32_t>(mesh.indices.size());
        run.material = static_cast<int>(half);
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = half * n / 2; x < (half + 1) * n / 2; ++x) {
                const uint32_t a = y * (n + 1) + x, b = a + n + 1;
                mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
            }
        run.index_count = static_cast<uint32_t>(mesh.indices.size()) - run.first_index;
        mesh.clusters.push_back(run);
    }
    return mesh;
}

/** Corners of each triangle with its material, each turned so that the smallest corner is first. */
std::multiset<std::array<float, 7>> triangles(const types::Mesh& mesh) {
    std::multiset<std::array<float, 7>> all;
    for (const types::Cluster& cluster : mesh.clusters)
        for (size_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
            std::array<std::array<float, 2>, 3> corners;
            for (size_t k = 0; k < 3; ++k)
                corners[k] = {mesh.positions[mesh.indices[i + k]].x, mesh.positions[mesh.indices[i + k]].y};
            std::ranges::rotate(corners, std::ranges::min_element(corners));
            all.insert({corners[0][0], corners[0][1], corners[1][0], corners[1][1], corners[2][0], corners[2][1],
                        static_cast<float>(cluster.material)});
        }
    return all;
}

TEST(ClustersTest, ALargeMeshIsSplitIntoCompactClustersOfTheSameTriangles) {
    types::Mesh mesh = grid(100);
    const auto before = triangles(mesh);
    buildClusters(mesh);
    expectSoundMesh(mesh, 2);
    EXPECT_EQ(triangles(mesh), before);
    EXPECT_GE(mesh.clusters.size(), 20u);
    for (const types::Cluster& cluster : mesh.clusters) {
        EXPECT_LE(cluster.index_count / 3, cluster_triangles);
        EXPECT_GE(cluster.index_count / 3, cluster_triangles / 2);
        // a square of this number of triangles has a half diagonal of sqrt(n / 4); up to twice that is compact
        EXPECT_LT(glm::length(cluster.half), 2 * std::sqrt(cluster.index_count / 12.0));
    }
}

/** Returns a mesh in clusters, built on some of the processors that this thread may use; 0: on all. */
types::Mesh buildOn(types::Mesh mesh, int processors) {
    cpu_set_t allowed, some;
    sched_getaffinity(0, sizeof allowed, &allowed);
    CPU_ZERO(&some);
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&some) < processors; ++cpu)
        if (CPU_ISSET(cpu, &allowed)) CPU_SET(cpu, &some);
    if (processors > 0) sched_setaffinity(0, sizeof some, &some);
    buildClusters(mesh);
    sched_setaffinity(0, sizeof allowed, &allowed);
    return mesh;
}

TEST(ClustersTest, SeveralThreadsSplitAMeshAsOneThreadDoes) {
    const types::Mesh mesh = grid(708), one = buildOn(mesh, 1), all = buildOn(mesh, 0);
    EXPECT_EQ(one.indices, all.indices);
    EXPECT_EQ(one.positions, all.positions);
    EXPECT_EQ(one.coarse_indices, all.coarse_indices);
    ASSERT_EQ(one.clusters.size(), all.clusters.size());
    for (size_t i = 0; i < one.clusters.size(); ++i) {
        EXPECT_EQ(one.clusters[i].first_index, all.clusters[i].first_index);
        EXPECT_EQ(one.clusters[i].index_count, all.clusters[i].index_count);
        EXPECT_EQ(one.clusters[i].centre, all.clusters[i].centre);
    }
    EXPECT_GT(one.clusters.size(), 4000u);
}

TEST(ClustersTest, ASmallMeshKeepsOneClusterForEachMaterial) {
    types::Mesh mesh = grid(10);
    const auto before = triangles(mesh);
    buildClusters(mesh);
    expectSoundMesh(mesh, 2);
    EXPECT_EQ(triangles(mesh), before);
    EXPECT_EQ(mesh.clusters.size(), 2u);
}

TEST(ClustersTest, AttributesFollowTheirVertices) {
    types::Mesh mesh = grid(100);
    buildClusters(mesh);
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (size_t i = 0; i < mesh.uvs.size(); ++i) ASSERT_EQ(mesh.uvs[i], glm::vec2(mesh.positions[i]));
}

TEST(ClustersTest, VerticesWithoutTrianglesAreGone) {
    types::Mesh mesh = grid(10);
    mesh.positions.emplace_back(7, 7, 7);
    mesh.uvs.emplace_back(0, 0);
    buildClusters(mesh);
    EXPECT_EQ(mesh.positions.size(), 121u);
}

TEST(ClustersTest, TrianglesAtOnePlaceAreSplitToo) {
    types::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (size_t i = 0; i < 20'000; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
    mesh.clusters = {{.first_index = 0, .index_count = 60'000}};
    buildClusters(mesh);
    expectSoundMesh(mesh, 1);
    EXPECT_GE(mesh.clusters.size(), 20'000 / cluster_triangles);
}

}  // namespace
}  // namespace insonify::scene
