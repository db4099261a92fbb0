#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** How the facets of a mesh bend where they stand for a smooth convex surface (ACOUSTICS.md 4.7), one record per
 *  triangle; empty where none does. A facet does if its body is closed, and neither it nor a facet that shares a corner
 *  with it has an edge that is hollow, or that is turned by 0.3 to 1.05 rad, which is a body of flat faces.
 *  @param world_from_mesh  turns and scales the mesh; the records have the metric of the world. */
std::vector<CurveRecord> facetCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh);

}  // namespace insonify::sonar
