#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/echo/MaterialLaws.hpp"
#include "components/sonar/echo/StraightEdges.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** How the facets of a mesh spread a lobe (ACOUSTICS.md 3.6), one record per triangle: in two principal directions the
 *  mean square slope of the steps to the neighbours [1], that of diffraction at the length without curvature [1], and
 *  the curvature [1/m]. An edge of 60 deg or more is an edge, and no curve.
 *  @param world_from_mesh  turns and scales the mesh; the records have the metric of the world.
 *  @param wavelength  [m], 0: none is known, and nothing is diffracted.
 *  @param edges  the edges of the mesh that echo themselves; null: none do. */
std::vector<FacetRecord> facetLobes(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double wavelength,
                                    const StraightEdges* edges = nullptr);

/** Whether any triangle of a mesh has a material whose law has a lobe. */
bool hasLobes(const types::Mesh& mesh, const MaterialLaws& laws);
/** How the first object that is a mesh turns and scales it into the world; 1 where there is none. */
glm::dmat3 worldFromMesh(const types::Geometry& geometry, size_t mesh);

/** Records of all meshes' triangles, mesh after mesh, each as the first object of the mesh places it. Zeros for meshes
 *  whose materials have no lobe; empty where no material has one. */
std::vector<FacetRecord> facetLobes(const types::Geometry& geometry, const MaterialLaws& laws);

}  // namespace insonify::sonar
