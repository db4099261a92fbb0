#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace insonify::scene {

/** Triangles of one material, as they come from a file: three vertices each, in parallel arrays. */
struct Surface {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   ///< Empty, or unit vectors, as many as positions.
    std::vector<glm::vec4> tangents;  ///< Empty, or unit vectors and handedness, as many as positions.
    std::vector<glm::vec2> uvs;       ///< Empty, or as many as positions.
    std::vector<uint32_t> indices;
};

/** Gives every triangle its own three vertices with the normal of its plane. */
void makeFlatNormals(Surface& surface);

/** Tangents along growing u from positions, normals and uvs; w says that -dP/dv is w cross(normal, tangent), as glTF
 *  means it. A vertex between triangles whose uvs are mirrored is doubled. */
void makeTangents(Surface& surface);

}  // namespace insonify::scene
