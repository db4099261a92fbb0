#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <vector>

#include "types/geometry/Geometry.hpp"

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
std::vector<Edge> findEdges(const types::Mesh& mesh);
/** The same with the result of weld(). */
std::vector<Edge> findEdges(const types::Mesh& mesh, const std::vector<uint32_t>& welded);

/** A face that ends at an edge. */
struct EdgeFace {
    glm::dvec3 inward;  ///< Unit vector across the edge into the face, in the axes of the world.
    double width;       ///< Extent of the face's flat part along `inward` [m].
    int material;       ///< Index into Geometry::materials.
    bool is_enclosed;   ///< Whether StraightEdges::encloses holds for the flat part.
};

/** A straight edge, of which a mesh may have many pieces. */
struct StraightEdge {
    glm::dvec3 from, to;             ///< Ends, in the axes of the mesh [m].
    std::array<EdgeFace, 2> faces;   ///< Both are equal at the edge of a thin sheet.
    std::array<uint32_t, 2> corner;  ///< First vertices at the places of both ends.
};

/** The straight, sharp edges of a mesh. */
struct StraightEdges {
    std::vector<StraightEdge> edges;
    std::vector<uint8_t> encloses;  ///< For each triangle, 1 where its flat part ends only at these edges, else 0.
};

/** Returns the edges at which the surface turns by at least an angle, and those with one face only (ACOUSTICS.md 3.12).
 *  Pieces on one line between the same two flat parts are one edge, independent of the triangles. Omits edges of three
 *  or more faces. Omits edges that represent a curve: at both ends they continue in the same flat part with a bend of
 *  less than 60 deg.
 *  @param world_from_mesh  rotates and scales the mesh; angles and lengths are those of the world
 *  @param min_turn  [rad], above 0 */
StraightEdges straightEdges(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double min_turn);

}  // namespace insonify::sonar
