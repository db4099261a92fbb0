#pragma once
#include <glm/mat4x4.hpp>
#include <vector>

#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Returns the longest edge of all triangles of a mesh, in its own coordinates [m]. */
double longestEdge(const types::Mesh& mesh);

/** Distances from the sonar to a mesh [m]. */
struct MeshDistances {
    double nearest = 0;   ///< To its nearest point.
    double farthest = 0;  ///< To its farthest corner.
};

/** Returns the distances to a mesh that is placed by `sonar_from_mesh`; 0 for a mesh without triangles. If very many
 *  triangles are about equally near or far, they are bounds: the distances to the nearest and to the farthest box of
 *  triangles. Allocates in `scratch` only. */
MeshDistances distancesTo(const types::Mesh& mesh, double longest_edge, const glm::dmat4& sonar_from_mesh,
                          std::vector<float>& scratch);

}  // namespace insonify::sonar
