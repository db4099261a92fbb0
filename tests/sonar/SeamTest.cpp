// Bodies whose seams and poles are written with different rounding are closed (ACOUSTICS.md 4.7).
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/StraightEdges.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

/** A ball in rows and columns, as graphics programs write it: both sides of its seam have vertices, each pole has one
 *  for each column, and the quads at the poles are two triangles, one of them without area. `off` is added to all
 *  vertices of the last column and of the poles but the first. */
types::Mesh ball(float radius, uint32_t columns, const auto& off, bool with_slivers = true) {
    types::Mesh mesh;
    const uint32_t rows = columns / 2;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column) {
            const double down = pi * row / rows, round = 2 * pi * (column % columns) / columns;
            const double across = row == 0 || row == rows ? 0 : std::sin(down);
            const glm::dvec3 exact =
                double{radius} * glm::dvec3(across * std::cos(round), across * std::sin(round), std::cos(down));
            const bool again = column == columns || (across == 0 && column > 0);
            mesh.positions.emplace_back(again ? exact + off() : exact);
        }
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
            if (with_slivers || row > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
            if (with_slivers || row + 1 < rows) mesh.indices.insert(mesh.indices.end(), {b, b + 1, a + 1});
        }
    if (!with_slivers) {
        mesh.indices.clear();
        for (uint32_t row = 0; row < rows; ++row)
            for (uint32_t column = 0; column < columns; ++column) {
                const uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
                if (row > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
                if (row + 1 < rows) mesh.indices.insert(mesh.indices.end(), {b, b + 1, a + 1});
            }
    }
    mesh.clusters = {{.first_index = 0,
                      .index_count = static_cast<uint32_t>(mesh.indices.size()),
                      .material = 0,
                      .centre = {0, 0, 0},
                      .half = {radius, radius, radius}}};
    return mesh;
}

types::Mesh exactBall(float radius, uint32_t columns) {
    return ball(
        radius, columns, [] { return glm::dvec3(0); }, false);
}

SonarConfig closeSonar() {
    SonarConfig config = test::getSonar(
        {.beams = 1, .width_deg = 10, .height_deg = 10, .bins = 400, .bin = 0.02, .rows = 128, .columns = 128});
    config.visibility = Visibility::Cpu;
    return config;
}

types::Sonar pingOfBall(types::Mesh mesh, const glm::dmat3& shape = glm::dmat3(1)) {
    auto scene = std::make_shared<types::Geometry>(*test::makeScene({std::move(mesh)}, 0, {{6, 0, 0}}));
    const glm::dmat4 place = scene->objects[0].world_from_object;
    scene->objects[0].world_from_object = place * glm::dmat4(shape);
    return test::makePing(closeSonar(), test::makeSnapshot(scene));
}

double difference(const types::Sonar& a, const types::Sonar& b) {
    double off = 0, all = 0;
    for (size_t i = 0; i < a.bins.size(); ++i) {
        off += std::abs(double{a.bins[i]} - double{b.bins[i]});
        all += double{b.bins[i]};
    }
    return off / all;
}

TEST(SeamTest, ABallWithARoundedSeamAndPolesPingsAsTheClosedOne) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const double size : {1e-16, 1e-9, 0.2 * 0x1p-22})
        for (const bool far_scale : {false, true}) {
            const auto off = [&] { return size * glm::dvec3(unit(random), unit(random), unit(random)); };
            const glm::dmat3 shape = far_scale ? glm::dmat3(1.2, 0, 0, 0, 0.8, 0.1, 0, 0, 1) : glm::dmat3(1);
            const types::Sonar closed = pingOfBall(exactBall(0.5, 64), shape),
                               seamed = pingOfBall(ball(0.5, 64, off), shape);
            std::cout << "rounding of " << size << ": " << difference(seamed, closed) << " of the ping\n";
            EXPECT_LT(difference(seamed, closed), 1e-3) << size;
        }
}

TEST(SeamTest, EveryTriangleApartAndRandomlyRoundedHasTheCurvesAndLobesOfTheClosedBody) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    const types::Mesh closed = exactBall(1, 32);
    const auto curves = facetCurves(closed, glm::dmat3(1));
    const auto lobes = facetLobes(closed, glm::dmat3(1), 0.002);
    ASSERT_FALSE(curves.empty());
    for (int trial = 0; trial < 8; ++trial) {
        const double size = std::pow(10, -17 + trial) < 0.2 * 0x1p-22 ? std::pow(10, -17 + trial) : 0.1 * 0x1p-22;
        types::Mesh apart = closed;
        apart.positions.clear();
        for (uint32_t& index : apart.indices) {
            apart.positions.emplace_back(glm::dvec3(closed.positions[index]) +
                                         size * glm::dvec3(unit(random), unit(random), unit(random)));
            index = static_cast<uint32_t>(apart.positions.size() - 1);
        }
        const auto own = facetCurves(apart, glm::dmat3(1));
        ASSERT_EQ(own.size(), curves.size()) << size;
        for (size_t i = 0; i < own.size(); ++i) ASSERT_NEAR(own[i].bend.w, curves[i].bend.w, 1e-3f) << size << " " << i;
        const auto own_lobes = facetLobes(apart, glm::dmat3(1), 0.002);
        for (size_t i = 0; i < own.size(); ++i) ASSERT_NEAR(own_lobes[i].first.x, lobes[i].first.x, 1e-4f) << size;
    }
}

TEST(SeamTest, ABoxOfSeparateFacesHasItsTwelveEdgesAtAnyRounding) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const double size : {0.0, 1e-16, 1e-10, 0.2 * 0x1p-22}) {
        types::Mesh box;
        const auto face = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
            const auto base = static_cast<uint32_t>(box.positions.size());
            for (const glm::dvec3& at : {corner, corner + u, corner + u + v, corner + v})
                box.positions.emplace_back(at + size * glm::dvec3(unit(random), unit(random), unit(random)));
            box.indices.insert(box.indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
        };
        const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        face({0, 0, 0}, y, x), face({0, 0, 1}, x, y), face({0, 0, 0}, x, z), face({0, 1, 0}, z, x),
            face({0, 0, 0}, z, y), face({1, 0, 0}, y, z);
        EXPECT_EQ(straightEdges(box, glm::dmat3(1), 1).edges.size(), 12u) << size;
    }
}

}  // namespace
}  // namespace insonify::sonar
