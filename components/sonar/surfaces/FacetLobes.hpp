#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "components/sonar/surfaces/StraightEdges.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Returns the lobe records of the facets of a mesh (ACOUSTICS.md 3.6), one per triangle. In two principal directions
 *  they contain the mean square slope of the steps to the neighbours [1], that of diffraction at the length without
 *  curvature [1], and the curvature [1/m]. An edge of 60 deg or more is an edge, not a curve.
 *  @param world_from_mesh  rotates and scales the mesh; the records have the metric of the world.
 *  @param wavelength  [m], 0: unknown, and nothing is diffracted.
 *  @param edges  edges of the mesh with their own echoes; null: none. */
std::vector<FacetRecord> facetLobes(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double wavelength,
                                    const StraightEdges* edges = nullptr);

/** Returns whether any triangle of a mesh has a material whose law has a lobe. */
bool hasLobes(const types::Mesh& mesh, const MaterialLaws& laws);
/** Returns the rotation and scale of the first object with a mesh; 1 where there is none. */
glm::dmat3 worldFromMesh(const types::Geometry& geometry, size_t mesh);

/** Returns the records of all meshes' triangles, mesh after mesh, each as placed by the first object with the mesh.
 *  Zeros for meshes whose materials have no lobe; empty where no material has a lobe. */
std::vector<FacetRecord> facetLobes(const types::Geometry& geometry, const MaterialLaws& laws);

/** Returns the curvatures of the facets of a mesh that represent a smooth convex surface (ACOUSTICS.md 4.7), one record
 *  per triangle; empty where no facet does. The body of a facet must be closed. Neither the facet nor a facet with a
 *  common corner may have a concave edge. Nor may they have an edge with a turn of 0.3 to 1.05 rad, as in a body of
 *  flat faces.
 *  @param world_from_mesh  rotates and scales the mesh; the records have the metric of the world. */
std::vector<CurveRecord> facetCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh);

}  // namespace insonify::sonar
