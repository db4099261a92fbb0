// Vertices at one place, whatever their rounding.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::types {
namespace {

/** A grid of `side` x `side` vertices, `step` apart, at an offset; triangles of neighbours. */
struct Grid {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;

    Grid(uint32_t side, double step, const glm::dvec3& offset) {
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x) positions.emplace_back(offset + glm::dvec3(x * step, y * step, 0));
        for (uint32_t y = 0; y + 1 < side; ++y)
            for (uint32_t x = 0; x + 1 < side; ++x) {
                const uint32_t i = y * side + x;
                indices.insert(indices.end(), {i, i + 1, i + side, i + 1, i + side + 1, i + side});
            }
    }
};

TEST(WeldTest, RandomRoundingKeepsPlacesAndDetailOf1e5OfTheExtentStays) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int trial = 0; trial < 50; ++trial) {
        const double extent = std::exp(unit(random) * 5);
        std::vector<glm::dvec3> places;
        for (int i = 0; i < 200; ++i)
            places.emplace_back(extent * unit(random), extent * unit(random), extent * unit(random));
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        for (int copy = 0; copy < 3; ++copy)
            for (const glm::dvec3& place : places) {
                positions.emplace_back(place +
                                       0.05 * 0x1p-22 * extent * glm::dvec3(unit(random), unit(random), unit(random)));
                indices.push_back(static_cast<uint32_t>(indices.size()));
            }
        const auto first = weldedPlaces(positions, indices);
        for (uint32_t i = 0; i < positions.size(); ++i) ASSERT_EQ(first[i], i % 200) << trial;
    }
}

TEST(WeldTest, FineGridsFarFromTheOriginStayApart) {
    for (const double offset : {0.0, 1e3, 1e5}) {
        const Grid grid(40, std::max(0.002, offset * 1e-6), {offset, -offset, offset});
        const auto first = weldedPlaces(grid.positions, grid.indices);
        for (uint32_t i = 0; i < grid.positions.size(); ++i) ASSERT_EQ(first[i], i) << offset;
    }
}

TEST(WeldTest, AnyPlacesAreFiniteWork) {
    EXPECT_TRUE(weldedPlaces({}, {}).empty());
    EXPECT_EQ(weldedPlaces({{1, 2, 3}, {1, 2, 3}, {-0.0f, 0, 0}}, {0, 1, 0}), (std::vector<uint32_t>{0, 0, 2}));
    const std::vector<glm::vec3> huge = {{1e15f, 1e15f, -1e15f}, {1e15f, 1e15f, -1e15f}, {-1e15f, 1e-30f, 0}};
    EXPECT_EQ(weldedPlaces(huge, {0, 1, 2}), (std::vector<uint32_t>{0, 0, 2}));
}

}  // namespace
}  // namespace insonify::types
