#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/Deformed.hpp"
#include "types/geometry/Extent.hpp"

namespace insonify::types {
namespace {

/** Two unit squares in z = 0, at the origin and 10 m away, each with a vertex next to it that no triangle uses. */
Snapshot twoSquares() {
    Mesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {50, 50, 50}};
    square.indices = {0, 1, 2, 0, 2, 3};
    Geometry geometry;
    geometry.meshes.push_back(square);
    geometry.objects.push_back({"here", 0, glm::dmat4(1)});
    geometry.objects.push_back({"there", 0, glm::translate(glm::dmat4(1), glm::dvec3(10, 0, 0))});
    Snapshot snapshot;
    snapshot.geometry = std::make_shared<Geometry>(geometry);
    return snapshot;
}

TEST(ExtentTest, ABoxContainsThePlacedVerticesOfTheTriangles) {
    Snapshot snapshot = twoSquares();
    EXPECT_EQ(getExtent(*snapshot.geometry).low, glm::dvec3(0));
    EXPECT_EQ(getExtent(*snapshot.geometry).high, glm::dvec3(11, 1, 0));
    snapshot.moved.push_back({1, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -5))});
    EXPECT_EQ(getExtent(snapshot).low, glm::dvec3(0, 0, -5));
    EXPECT_EQ(getExtent(snapshot).high, glm::dvec3(1, 1, 0));
    EXPECT_TRUE(getExtent(Geometry()).isEmpty());
    EXPECT_EQ(getExtent(Geometry()).size(), glm::dvec3(0));
}

TEST(ExtentTest, TheNearestPointIsOnAFaceAnEdgeOrACorner) {
    const Snapshot snapshot = twoSquares();
    const auto expectNearest = [&](glm::dvec3 from, glm::dvec3 point, uint32_t object) {
        const NearestPoint nearest = nearestPoint(snapshot, from);
        EXPECT_NEAR(glm::distance(nearest.point, point), 0, 1e-12);
        EXPECT_NEAR(nearest.distance, glm::distance(from, point), 1e-12);
        EXPECT_EQ(nearest.object, object);
    };
    expectNearest({0.3, 0.4, 2}, {0.3, 0.4, 0}, 0);
    expectNearest({0.3, -3, 1}, {0.3, 0, 0}, 0);
    expectNearest({-1, -1, 1}, {0, 0, 0}, 0);
    expectNearest({10.5, 2, 0}, {10.5, 1, 0}, 1);
    Snapshot empty;
    empty.geometry = std::make_shared<Geometry>();
    EXPECT_EQ(nearestPoint(empty, {0, 0, 0}).distance, std::numeric_limits<double>::infinity());
}

TEST(ExtentTest, MeshesThatDeformAreAsPosed) {
    Snapshot snapshot = twoSquares();
    auto geometry = std::make_shared<Geometry>(*snapshot.geometry);
    geometry->meshes[0] = test::jointed(geometry->meshes[0]);
    snapshot.geometry = geometry;
    test::pose(snapshot, 1, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 7)));
    EXPECT_EQ(getExtent(snapshot).low, glm::dvec3(0));
    EXPECT_EQ(getExtent(snapshot).high, glm::dvec3(11, 1, 7));
    const NearestPoint nearest = nearestPoint(snapshot, {10.5, 0.5, 9});
    EXPECT_NEAR(nearest.distance, 2, 1e-6);
    EXPECT_EQ(nearest.object, 1u);
}

TEST(ExtentTest, NoPointOfATriangleIsNearerThanTheNearest) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-2, 2), share(0, 1);
    const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 a = point(), b = point(), c = point(), p = point();
        const double nearest = glm::distance(p, nearestOfTriangle(p, a, b, c));
        double minimum = 1e9;
        for (int k = 0; k < 2000; ++k) {
            double u = share(random), v = share(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            minimum = std::min(minimum, glm::distance(p, a + u * (b - a) + v * (c - a)));
        }
        EXPECT_LE(nearest, minimum + 1e-12);
        EXPECT_GT(nearest, minimum - 0.3);
    }
}

}  // namespace
}  // namespace insonify::types
