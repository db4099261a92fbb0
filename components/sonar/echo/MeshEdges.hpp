#pragma once
#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

constexpr double crease = std::numbers::pi / 3;  ///< Between neighbours of one smooth part there is less [rad].

/** An edge of a triangle by the places of its ends, the lesser first: meshes have a vertex several times. */
struct Edge {
    uint32_t low, high, triangle;
    auto operator<=>(const Edge&) const = default;
};

/** Returns for each vertex the first vertex at the same place. */
std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions);

/** The edges of all triangles of a mesh, ascending: those of neighbours follow each other. */
std::vector<Edge> edgesOf(const types::Mesh& mesh);

}  // namespace insonify::sonar
