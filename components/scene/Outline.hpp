#pragma once
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Triangles of a mesh's outline, at most, for each run of one material [triangles]. */
constexpr size_t kOutlineTriangles = 4000;

/** Finds `coarse_indices` of a mesh: of each patch that is part of no other, so many triangles at most. */
void findOutline(types::Mesh& mesh);

}  // namespace insonify::scene
