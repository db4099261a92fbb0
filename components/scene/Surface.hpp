#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "types/geometry/Geometry.hpp"

namespace insonify::scene {

/** Triangles of one material as read from a file: three vertices each, in parallel arrays. */
struct Surface {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   ///< Empty, or one unit vector per position.
    std::vector<glm::vec4> tangents;  ///< Empty, or one unit vector and handedness per position.
    std::vector<glm::vec2> uvs;       ///< Empty, or one per position.
    std::vector<glm::vec2> map_uvs;   ///< Empty, or one per position: of a surface map.
    std::vector<uint32_t> numbers;    ///< Empty, or one per position: vertices in the file's mesh that deforms.
    std::vector<uint32_t> indices;
};

/** Numbers of triangles that were dropped, by reason. */
struct DroppedTriangles {
    size_t bad = 0;    ///< Triangles with a vertex that is not a finite number.
    size_t empty = 0;  ///< Triangles without area.

    void addTo(types::Notices& notices) const;
};

/** Drops triangles that cannot be rasterised, and counts them. A damaged vertex, which is no longer used, is set to 0.
 *  Triangles without area stay where the surface has `numbers`, for a pose may open them. */
void cleanUp(Surface& surface, DroppedTriangles& dropped);

/** Calls `use(a, b, c, d)` for each cell of a grid whose vertices are stored row by row. a and b are neighbours in one
 *  row, c and d the vertices opposite them in the next row. */
void forEachCell(size_t columns, size_t rows, auto&& use) {
    const auto stride = static_cast<uint32_t>(columns);
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column + 1 < stride; ++column) {
            const uint32_t a = row * stride + column, c = a + stride;
            use(a, a + 1, c, c + 1);
        }
}

/** Adds a surface to a mesh as one more cluster, without bounds yet. */
void appendSurface(const Surface& surface, int material, types::Mesh& mesh);

/** Extends the arrays that only some surfaces of a mesh have to the number of its positions. */
void fillAttributes(types::Mesh& mesh);

/** Adds "<what>: <number>" to the notices unless the number is 0. */
void addCount(size_t number, const char* what, types::Notices& notices);

/** Gives each triangle three vertices of its own with the normal of its plane. */
void makeFlatNormals(Surface& surface);

/** Makes tangents along increasing u from positions, normals and uvs. As in glTF, -dP/dv is w cross(normal, tangent). A
 *  vertex between triangles whose uvs are mirrored is duplicated. */
void makeTangents(Surface& surface);

}  // namespace insonify::scene
