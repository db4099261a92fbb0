#pragma once
#include <glm/mat4x4.hpp>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Of all triangles of a mesh, in its own coordinates [m]. */
double longestEdge(const types::Mesh& mesh);

/** Distance from the sonar to the nearest point of a mesh that stands where `sonar_from_mesh` says [m]; of a mesh that
 *  has very many triangles about as near as each other, that of the nearest box of triangles. 0 where it has no
 *  triangles. Allocates in `scratch` alone. */
double nearestDistance(const types::Mesh& mesh, double longest_edge, const glm::dmat4& sonar_from_mesh,
                       std::vector<float>& scratch);

}  // namespace insonify::sonar
