#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "types/geometry/Geometry.hpp"

namespace insonify::scene {

/** Meshes with more triangles than this are split into compact clusters, so that parts out of view can be culled
 *  [1]. */
constexpr size_t clustered_from = 10'000;
/** Max triangles of a cluster of a split mesh. Most clusters have at least half of it. */
constexpr size_t cluster_triangles = 250;
/** Max triangles of the smallest kind of patch, which has at least half of it. Each larger kind has 4 times the number.
 */
constexpr size_t min_node_triangles = 1000;
/** Max triangles of a mesh's outline, for each run of one material. */
constexpr size_t max_coarse_triangles = 4000;

/** Orders triangles and vertices for the GPU. On entry `mesh.clusters` are runs of one material. On return each has its
 *  box. Runs of a large mesh are split where their triangles are far apart, with patches over them and an outline of
 *  few triangles. If such a mesh is closed, its clusters have the cones from which only their backs are visible.
 *  @param numbers  of a mesh that deforms: one for each vertex, which takes the vertex's new place. Such a mesh keeps
 *  vertices apart that are in one place, and has no cones. */
void buildClusters(types::Mesh& mesh, std::vector<uint32_t>* numbers = nullptr);

}  // namespace insonify::scene
