#pragma once
#include <glm/mat4x4.hpp>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Returns the longest edge of all triangles of a mesh, in its own coordinates [m]. */
double longestEdge(const types::Mesh& mesh);

/** Returns the distance from the sonar to the nearest point of a mesh that is placed by `sonar_from_mesh` [m]. If very
 *  many triangles of the mesh are about equally near, returns a lower bound: the distance to the nearest box of
 *  triangles. Returns 0 for a mesh without triangles. Allocates in `scratch` only. */
double nearestDistance(const types::Mesh& mesh, double longest_edge, const glm::dmat4& sonar_from_mesh,
                       std::vector<float>& scratch);

}  // namespace insonify::sonar
