#pragma once
// A rough floor in code, the same for the same seed on every machine.
#include <cmath>
#include <random>
#include <vector>

#include "components/study/Shapes.hpp"

namespace insonify::test {

/** Heights over a square of (cells + 1)^2 corners: octaves of smooth random lattices, from `cells / 2` wide down to one
 *  cell, each `2^-0.35` times as high as the one before. Their two-dimensional power spectrum falls with the wavenumber
 *  to the power -2.7, as that of sand and rock does [m]. */
inline std::vector<double> fractalHeights(int cells, double rms, unsigned seed) {
    const int corners = cells + 1;
    std::vector<double> heights(static_cast<size_t>(corners) * corners);
    std::minstd_rand random(seed);
    double amplitude = 1;
    for (int spacing = cells / 2; spacing >= 1; spacing /= 2, amplitude *= std::pow(2, -0.35)) {
        const int across = cells / spacing + 2;
        std::vector<double> lattice(static_cast<size_t>(across) * across);
        for (double& value : lattice) value = amplitude * (static_cast<double>(random()) / random.max() - 0.5);
        const auto at = [&](int i, int j) { return lattice[static_cast<size_t>(i) * across + j]; };
        for (int i = 0; i < corners; ++i)
            for (int j = 0; j < corners; ++j) {
                const double y = static_cast<double>(i % spacing) / spacing, u = y * y * (3 - 2 * y);
                const double x = static_cast<double>(j % spacing) / spacing, v = x * x * (3 - 2 * x);
                const int a = i / spacing, b = j / spacing;
                heights[static_cast<size_t>(i) * corners + j] += (1 - u) * ((1 - v) * at(a, b) + v * at(a, b + 1)) +
                                                                 u * ((1 - v) * at(a + 1, b) + v * at(a + 1, b + 1));
            }
    }
    double mean = 0, square = 0;
    for (double height : heights) mean += height / static_cast<double>(heights.size());
    for (double height : heights) square += (height - mean) * (height - mean) / static_cast<double>(heights.size());
    for (double& height : heights) height = (height - mean) * rms / std::sqrt(square);
    return heights;
}

/** A level floor of `size` x `size` about (0, 0, z), rough by `rms`, of 2 cells^2 triangles [m]. */
inline types::Mesh roughFloor(double z, double size, int cells, double rms, unsigned seed) {
    const std::vector<double> heights = fractalHeights(cells, rms, seed);
    const auto corners = static_cast<uint32_t>(cells + 1);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < corners; ++i)
        for (uint32_t j = 0; j < corners; ++j)
            positions.emplace_back(size * (j / static_cast<double>(cells) - 0.5),
                                   size * (i / static_cast<double>(cells) - 0.5), z + heights[i * corners + j]);
    for (uint32_t i = 0; i + 1 < corners; ++i)
        for (uint32_t j = 0; j + 1 < corners; ++j) {
            const uint32_t at = i * corners + j, above = at + corners;
            indices.insert(indices.end(), {at, at + 1, above, at + 1, above + 1, above});
        }
    return study::meshOf(std::move(positions), std::move(indices));
}

}  // namespace insonify::test
