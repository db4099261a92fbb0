#pragma once
#include <compare>
#include <cstdint>
#include <numbers>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

constexpr double crease = std::numbers::pi / 3;  ///< Neighbours in one smooth part have a smaller angle [rad].

/** An edge of a triangle by the vertices at its ends, the lower first. Vertices at one place are welded. */
struct Edge {
    uint32_t low, high, triangle;
    auto operator<=>(const Edge&) const = default;
};

/** Returns for each vertex the first vertex at the same place (types::weldedPlaces()). */
std::vector<uint32_t> weld(const types::Mesh& mesh);

/** Returns the edges of all triangles of a mesh, ascending: common edges of neighbours are adjacent. Omits triangles
 *  with two corners at one place, which have no area: their neighbours meet. */
std::vector<Edge> edgesOf(const types::Mesh& mesh);

}  // namespace insonify::sonar
