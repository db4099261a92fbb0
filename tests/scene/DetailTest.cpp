#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

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
    return test::meshOf(std::move(positions), std::move(indices));
}

types::Mesh built(types::Mesh mesh) {
    buildClusters(mesh);
    return mesh;
}

std::span<const uint32_t> standIn(const types::Mesh& mesh, const types::Patch& patch) {
    return std::span(mesh.coarse_indices).subspan(patch.first_index, patch.index_count);
}

std::span<const uint32_t> finest(const types::Mesh& mesh, const types::Patch& patch) {
    const types::Cluster &first = mesh.clusters[patch.first_cluster],
                         &last = mesh.clusters[patch.first_cluster + patch.cluster_count - 1];
    return std::span(mesh.indices).subspan(first.first_index, last.first_index + last.index_count - first.first_index);
}

/** Heights of a surface over (x, y), none where there is a gap. */
std::vector<double> heights(const types::Mesh& mesh, std::span<const uint32_t> indices, double x, double y) {
    std::vector<double> found;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[indices[i]]), b(mesh.positions[indices[i + 1]]),
            c(mesh.positions[indices[i + 2]]);
        const auto side = [&](glm::dvec3 p, glm::dvec3 q) { return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x); };
        const double wa = side(b, c), wb = side(c, a), wc = side(a, b), area = wa + wb + wc;
        if (std::min({wa, wb, wc}) >= 0 && area > 0) found.push_back((wa * a.z + wb * b.z + wc * c.z) / area);
    }
    return found;
}

TEST(DetailTest, WhatStandsForAPatchIsWithinItsDeviation) {
    const types::Mesh mesh = built(waves(150, 0.5));
    ASSERT_GT(mesh.patches.size(), 40u);
    int coarser = 0;
    for (const types::Patch& patch : mesh.patches) {
        if (patch.index_count == 0) continue;
        ++coarser;
        double largest = 0;
        for (uint32_t vertex : finest(mesh, patch)) {
            const glm::dvec3 p(mesh.positions[vertex]);
            if (std::min({p.x, p.y, 20 - p.x, 20 - p.y}) < 1e-3) continue;  // the rays may miss the border
            const auto found = heights(mesh, standIn(mesh, patch), p.x, p.y);
            ASSERT_FALSE(found.empty());
            largest = std::max(largest, std::abs(found[0] - p.z));
        }
        // straight up a distance is longer than across the slope, which is 0.5 at most
        EXPECT_LT(largest, 1.13 * patch.deviation + 1e-6);
        EXPECT_GT(4 * largest, patch.deviation) << "the bound is of no use";
    }
    EXPECT_GT(coarser, 40);
}

TEST(DetailTest, AboutAQuarterOfTheTrianglesStandsForAPatchAndItsNeighboursShare) {
    const types::Mesh mesh = built(waves(150, 0.5));
    size_t fine = 0, coarse = 0;
    for (size_t i = 0; i < mesh.patches.size(); ++i)
        if (const types::Patch& patch = mesh.patches[i]; patch.next == i + 1) {
            fine += finest(mesh, patch).size();
            coarse += patch.index_count;
        }
    EXPECT_EQ(fine, mesh.indices.size()) << "the smallest patches are all of the mesh";
    EXPECT_LT(coarse, 0.45 * static_cast<double>(fine));
    EXPECT_GT(coarse, 0.25 * static_cast<double>(fine));
}

TEST(DetailTest, PatchesOfAnyDetailSideBySideLeaveNoGap) {
    const types::Mesh mesh = built(waves(150, 0.5));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0.05, 19.95), chance(0, 1);
    for (int round = 0; round < 20; ++round) {
        std::vector<uint32_t> drawn;
        for (size_t i = 0; i < mesh.patches.size();) {
            const types::Patch& patch = mesh.patches[i];
            const bool coarse = patch.index_count > 0 && chance(random) < 0.4;
            if (coarse || patch.next == i + 1) {
                const auto indices = coarse ? standIn(mesh, patch) : finest(mesh, patch);
                drawn.insert(drawn.end(), indices.begin(), indices.end());
                i = patch.next;
            } else {
                ++i;
            }
        }
        for (int ray = 0; ray < 200; ++ray)
            ASSERT_FALSE(heights(mesh, drawn, place(random), place(random)).empty()) << "round " << round;
    }
}

TEST(DetailTest, APlaneStaysWhereItIs) {
    const types::Mesh mesh = built(waves(120, 0));
    for (const types::Patch& patch : mesh.patches)
        EXPECT_TRUE(patch.index_count == 0 || patch.deviation < 1e-5f) << patch.deviation;
}

TEST(DetailTest, ABorderStaysSoThatTilesFitTogether) {
    const types::Mesh mesh = built(waves(120, 0.5));
    for (const types::Patch& patch : mesh.patches) {
        if (patch.index_count == 0) continue;
        for (uint32_t vertex : finest(mesh, patch)) {
            if (mesh.positions[vertex].x != 0) continue;
            const auto stand_in = standIn(mesh, patch);
            EXPECT_TRUE(std::ranges::find(stand_in, vertex) != stand_in.end()) << mesh.positions[vertex].y;
        }
    }
}

TEST(DetailTest, TrianglesThatShareNoVertexAreNotSimplified) {
    types::Mesh soup = waves(120, 0.5);
    types::Mesh apart;
    for (size_t i = 0; i < soup.indices.size(); ++i) {
        const float shift = 1e-3f * static_cast<float>(i / 3 % 7);
        apart.positions.push_back(soup.positions[soup.indices[i]] + glm::vec3(0, 0, shift));
        apart.indices.push_back(static_cast<uint32_t>(i));
    }
    const types::Mesh mesh = built(test::meshOf(apart.positions, apart.indices));
    EXPECT_TRUE(mesh.coarse_indices.empty());
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
    EXPECT_FALSE(hasCones(built(test::meshOf(both.positions, both.indices))));
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
