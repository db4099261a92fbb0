#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "components/study/StudyScene.hpp"

namespace insonify::study {
namespace {

FractalFloor smallFloor(uint64_t seed = 1) {
    FractalFloor floor;
    floor.points = 128;
    floor.seed = seed;
    return floor;
}

/** Returns the mean power of the profiles along one axis at k waves along a side, by the defining sum. */
double profilePower(const std::vector<double>& heights, size_t n, size_t k) {
    double power = 0;
    for (size_t row = 0; row < n; ++row) {
        std::complex<double> sum = 0;
        for (size_t i = 0; i < n; ++i)
            sum += heights[row * n + i] *
                   std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i * k) / static_cast<double>(n));
        power += std::norm(sum) / static_cast<double>(n);
    }
    return power;
}

TEST(FractalFloorTest, TheSpectrumOfAProfileHasTheGivenSlope) {
    for (const double slope : {-2.7, -2.0}) {
        double low = 0, high = 0;
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            FractalFloor floor = smallFloor(seed);
            floor.slope = slope;
            const std::vector<double> heights = computeHeights(floor);
            for (const size_t k : {4, 5}) low += profilePower(heights, 128, k);
            for (const size_t k : {16, 20}) high += profilePower(heights, 128, k);
        }
        EXPECT_NEAR(std::log(high / low) / std::log(4.0), slope, 0.1);
    }
}

TEST(FractalFloorTest, HeightsHaveTheGivenRmsAboutTheirMean) {
    const std::vector<double> heights = computeHeights(smallFloor());
    double sum = 0, squares = 0;
    for (const double height : heights) sum += height, squares += height * height;
    EXPECT_NEAR(sum / static_cast<double>(heights.size()), 0, 1e-12);
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(heights.size())), 0.35, 1e-12);
}

TEST(FractalFloorTest, ASeedDeterminesTheFloor) {
    EXPECT_EQ(computeHeights(smallFloor(5)), computeHeights(smallFloor(5)));
    EXPECT_NE(computeHeights(smallFloor(5)), computeHeights(smallFloor(6)));
}

TEST(FractalFloorTest, TilesHaveTheSameTriangles) {
    using Corners = std::array<float, 9>;
    const auto collect = [](const types::Mesh& mesh, std::vector<Corners>& all) {
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            Corners corners;
            for (size_t k = 0; k < 9; ++k)
                corners[k] = mesh.positions[mesh.indices[i + k / 3]][static_cast<int>(k % 3)];
            all.push_back(corners);
        }
    };
    std::vector<Corners> whole, parts;
    collect(getMesh(smallFloor()), whole);
    const std::vector<types::Mesh> tiles = makeTiles(smallFloor(), 8);
    EXPECT_EQ(tiles.size(), 64u);
    for (const types::Mesh& tile : tiles) collect(tile, parts);
    std::ranges::sort(whole);
    std::ranges::sort(parts);
    EXPECT_EQ(whole, parts);
    EXPECT_EQ(whole.size(), 2u * 127 * 127);
}

}  // namespace
}  // namespace insonify::study
