#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Returns the curvatures of the facets of a mesh that represent a smooth convex surface (ACOUSTICS.md 4.7), one record
 *  per triangle; empty where no facet does. The body of a facet must be closed. Neither the facet nor a facet with a
 *  common corner may have a concave edge. Nor may they have an edge with a turn of 0.3 to 1.05 rad, as in a body of
 *  flat faces.
 *  @param world_from_mesh  rotates and scales the mesh; the records have the metric of the world. */
std::vector<CurveRecord> facetCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh);

}  // namespace insonify::sonar
