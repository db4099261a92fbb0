#include "components/sonar/FacetSlopes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <tuple>

namespace insonify::sonar {
namespace {

constexpr double flat = 1e-3;                      ///< Facets whose normals differ by less are one [rad].
constexpr double crease = std::numbers::pi / 3;  ///< [rad]

/** An edge of a triangle by the places of its ends, the lesser first: meshes have a vertex several times. */
struct Edge {
    uint32_t low, high, triangle;
    auto operator<=>(const Edge&) const = default;
};

/** Sets of triangles that are joined one by one. */
class Patches {
public:
    explicit Patches(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

private:
    std::vector<uint32_t> parent_;
};

/** For each vertex the first one at the same place. */
std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions) {
    std::vector<uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z, i); };
    std::ranges::sort(order, {}, key);
    for (size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    return first;
}

std::vector<Edge> edgesOf(const types::Mesh& mesh) {
    const std::vector<uint32_t> first = weld(mesh.positions);
    std::vector<Edge> edges;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = first[mesh.indices[i + k]], b = first[mesh.indices[i + (k + 1) % 3]];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<uint32_t>(i / 3)});
        }
    std::ranges::sort(edges);
    return edges;
}

/** Of each triangle its normal, as long as twice its area. */
std::vector<glm::dvec3> areasOf(const types::Mesh& mesh) {
    std::vector<glm::dvec3> areas;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[i + k]]); };
        areas.push_back(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    }
    return areas;
}

}  // namespace

std::vector<float> facetSlopes(const types::Mesh& mesh, double scale, double wavelength) {
    const std::vector<glm::dvec3> areas = areasOf(mesh);
    std::vector<double> slopes(areas.size()), patch_areas(areas.size());
    Patches patches(areas.size());
    const std::vector<Edge> edges = edgesOf(mesh);
    for (size_t k = 1; k < edges.size(); ++k) {
        const Edge &one = edges[k - 1], &other = edges[k];
        if (one.low != other.low || one.high != other.high) continue;
        const glm::dvec3 &a = areas[one.triangle], &b = areas[other.triangle];
        const double step = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        if (step < flat) patches.join(one.triangle, other.triangle);
        if (!(step < crease)) continue;
        for (const uint32_t triangle : {one.triangle, other.triangle}) slopes[triangle] += step * step / 4;
    }
    for (uint32_t i = 0; i < areas.size(); ++i)
        patch_areas[patches.find(i)] += glm::length(areas[i]) / 2 * scale * scale;
    std::vector<float> all;
    for (uint32_t i = 0; i < areas.size(); ++i) {
        const double area = std::max(patch_areas[patches.find(i)], 1e-12);
        all.push_back(static_cast<float>(slopes[i] + wavelength * wavelength / (4 * std::numbers::pi * area)));
    }
    return all;
}

}  // namespace insonify::sonar
