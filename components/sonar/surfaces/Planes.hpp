#pragma once
#include <span>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Returns the planes of a mesh's triangles. */
std::vector<PlaneRecord> planesOf(const types::Mesh& mesh);
/** Fills a list of that size with the planes of a mesh's triangles. */
void findPlanes(const types::Mesh& mesh, std::span<PlaneRecord> planes);
/** Returns the planes of all meshes' triangles, mesh after mesh, in their order. */
std::vector<PlaneRecord> planesOf(const types::Geometry& geometry);

}  // namespace insonify::sonar
