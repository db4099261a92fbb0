#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/scene/Clusters.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::scene {
namespace {

/** A square of 2 n n triangles, 20 m wide, with waves of `amplitude` [m]. */
types::Mesh waves(uint32_t n, double amplitude) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j <= n; ++j) {
            const double x = 20.0 * i / n, y = 20.0 * j / n;
            positions.emplace_back(x, y, amplitude * std::sin(x) * std::sin(0.7 * y));
        }
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t a = i * (n + 1) + j, b = a + n + 1;
            indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return test::getMesh(std::move(positions), std::move(indices));
}

types::Mesh built(types::Mesh mesh) {
    buildClusters(mesh);
    return mesh;
}

TEST(ConesTest, OnlyAClosedMeshWoundOutwardHasBacksThatAreHidden) {
    const auto hasCones = [](const types::Mesh& mesh) {
        return std::ranges::any_of(mesh.clusters, [](const types::Cluster& c) { return c.cone_cutoff < 1; });
    };
    const types::Mesh ball = test::sphere(2, 80);
    EXPECT_TRUE(hasCones(built(ball)));
    EXPECT_FALSE(hasCones(built(waves(120, 0.5)))) << "open";

    types::Mesh inside_out = ball;
    for (size_t i = 0; i < inside_out.indices.size(); i += 3)
        std::swap(inside_out.indices[i], inside_out.indices[i + 1]);
    EXPECT_FALSE(hasCones(built(inside_out)));

    types::Mesh holed = ball;
    holed.indices.resize(holed.indices.size() - 3);
    holed.clusters[0].index_count -= 3;
    EXPECT_FALSE(hasCones(built(holed)));

    types::Mesh both = ball;  // a shell: its inner skin shows its back outward
    for (const glm::vec3& p : inside_out.positions) both.positions.push_back(0.5f * p);
    for (uint32_t index : inside_out.indices)
        both.indices.push_back(index + static_cast<uint32_t>(ball.positions.size()));
    EXPECT_FALSE(hasCones(built(test::getMesh(both.positions, both.indices))));
}

TEST(ConesTest, FromWithinAConeOnlyBacksOfItsClusterAreSeen) {
    const types::Mesh mesh = built(test::sphere(2, 80));
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    int hidden = 0;
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 eye = 6.0f * glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        for (const types::Cluster& c : mesh.clusters) {
            const glm::vec3 away = c.cone_apex - eye;
            if (!(glm::dot(away, c.cone_axis) >= c.cone_cutoff * glm::length(away))) continue;
            ++hidden;
            for (size_t k = c.first_index; k < c.first_index + c.index_count; k += 3) {
                const glm::vec3 a = mesh.positions[mesh.indices[k]], b = mesh.positions[mesh.indices[k + 1]],
                                d = mesh.positions[mesh.indices[k + 2]];
                ASSERT_LT(glm::dot(glm::cross(b - a, d - a), eye - a), 1e-5f);
            }
        }
    }
    EXPECT_GT(hidden, 50 * static_cast<int>(mesh.clusters.size()) / 4);
}

}  // namespace
}  // namespace insonify::scene
