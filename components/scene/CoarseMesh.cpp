#include "components/scene/CoarseMesh.hpp"

#include <meshoptimizer.h>

#include <span>

namespace insonify::scene {
namespace {

std::span<const uint32_t> trianglesOf(const types::Mesh& mesh, const types::ClusterNode& node) {
    const types::Cluster &first = mesh.clusters[node.first_cluster],
                         &last = mesh.clusters[node.first_cluster + node.cluster_count - 1];
    return std::span(mesh.indices).subspan(first.first_index, last.first_index + last.index_count - first.first_index);
}

}  // namespace

void findCoarseMesh(types::Mesh& mesh) {
    mesh.coarse_indices.clear();
    for (size_t root = 0; root < mesh.cluster_nodes.size(); root = mesh.cluster_nodes[root].next) {
        const std::span<const uint32_t> fine = trianglesOf(mesh, mesh.cluster_nodes[root]);
        std::vector<uint32_t> coarse(fine.size());
        coarse.resize(meshopt_simplifySloppy(coarse.data(), fine.data(), fine.size(), &mesh.positions[0].x,
                                             mesh.positions.size(), sizeof(glm::vec3), 3 * max_coarse_triangles, 1.0f,
                                             nullptr));
        mesh.coarse_indices.insert(mesh.coarse_indices.end(), coarse.begin(), coarse.end());
    }
}

}  // namespace insonify::scene
