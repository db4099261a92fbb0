#pragma once
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Meshes of more triangles than this are split into compact clusters, so that parts out of view can be culled [1]. */
constexpr size_t kClusteredFrom = 10'000;
/** Largest cluster of such a mesh; most have half as many at least [triangles]. */
constexpr size_t kClusterTriangles = 250;

/** Orders triangles and vertices for the GPU. On entry `mesh.clusters` are runs of one material; on return runs of
 *  a large mesh are split where their triangles lie apart, and each cluster has its bounding sphere. */
void buildClusters(types::Mesh& mesh);

}  // namespace insonify::scene
