#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "components/scene/Surface.hpp"

namespace insonify::scene {
namespace {

/** A square in the plane z = 0 whose u is x, mirrored at x = 0 if asked; v points down, as in glTF. */
Surface mappedSquare(bool mirrored) {
    Surface surface;
    for (const float x : {-1.0f, 0.0f, 1.0f})
        for (const float y : {0.0f, 1.0f}) {
            surface.positions.emplace_back(x, y, 0);
            surface.normals.emplace_back(0, 0, 1);
            surface.uvs.emplace_back(mirrored ? std::abs(x) : x, 1 - y);
        }
    surface.indices = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
    return surface;
}

TEST(TangentsTest, PointAlongUWithHandednessAgainstV) {
    Surface surface = mappedSquare(false);
    makeTangents(surface);
    ASSERT_EQ(surface.tangents.size(), 6u);
    for (const glm::vec4 tangent : surface.tangents) {
        EXPECT_EQ(tangent, glm::vec4(1, 0, 0, 1));
        // up in the image, which is against v, is up in the scene
        EXPECT_EQ(glm::cross(glm::vec3(0, 0, 1), glm::vec3(tangent)) * tangent.w, glm::vec3(0, 1, 0));
    }
}

TEST(TangentsTest, DuplicatesVerticesOnTheEdgeOfAMirroredMap) {
    Surface surface = mappedSquare(true);
    makeTangents(surface);
    ASSERT_EQ(surface.positions.size(), 8u);
    ASSERT_EQ(surface.tangents.size(), 8u);
    for (size_t i = 0; i < surface.indices.size(); ++i) {
        const bool left = i < 6;
        EXPECT_EQ(surface.tangents[surface.indices[i]], glm::vec4(left ? -1 : 1, 0, 0, left ? -1 : 1));
    }
}

TEST(TangentsTest, WithoutAreaInUvAnyDirectionInThePlaneServes) {
    Surface surface = mappedSquare(false);
    for (glm::vec2& uv : surface.uvs) uv = {0.5f, 0.5f};
    makeTangents(surface);
    for (const glm::vec4 tangent : surface.tangents) {
        EXPECT_FLOAT_EQ(glm::length(glm::vec3(tangent)), 1);
        EXPECT_FLOAT_EQ(tangent.z, 0);
    }
}

TEST(TangentsTest, FlatNormalsArePerpendicularToTheirTriangles) {
    Surface surface = mappedSquare(false);
    surface.normals.clear();
    surface.positions[5].z = 1;
    makeFlatNormals(surface);
    ASSERT_EQ(surface.positions.size(), 12u);
    EXPECT_EQ(surface.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(surface.normals[9], surface.normals[11]);
    EXPECT_NEAR(glm::dot(surface.normals[9], surface.positions[11] - surface.positions[9]), 0, 1e-6);
}

}  // namespace
}  // namespace insonify::scene
