#pragma once
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Triangles of a mesh's outline, at most, for each run of one material [triangles]. */
constexpr size_t max_coarse_triangles = 4000;

/** Finds `coarse_indices` of a mesh: of each patch that is part of no other, so many triangles at most. */
void findCoarseMesh(types::Mesh& mesh);

}  // namespace insonify::scene
