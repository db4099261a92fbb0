#include "components/scene/Cones.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

namespace insonify::scene {
namespace {

using Indices = std::vector<uint32_t>;

/** Indices in which vertices in one place are one. */
Indices welded(const types::Mesh& mesh) {
    Indices indices(mesh.indices.size());
    meshopt_generateShadowIndexBuffer(indices.data(), mesh.indices.data(), mesh.indices.size(), mesh.positions.data(),
                                      mesh.positions.size(), sizeof(glm::vec3), sizeof(glm::vec3));
    return indices;
}

/** Whether every edge is there once in either direction. */
bool isWatertight(const Indices& indices) {
    std::vector<uint64_t> there, back;
    for (size_t i = 0; i < indices.size(); ++i) {
        const uint64_t from = indices[i], to = indices[i % 3 == 2 ? i - 2 : i + 1];
        there.push_back(from << 32 | to);
        back.push_back(to << 32 | from);
    }
    std::ranges::sort(there);
    std::ranges::sort(back);
    return std::ranges::adjacent_find(there) == there.end() && there == back;
}

/** Volume that each piece encloses, positive where it is wound outward; 0 for vertices that name no piece [m^3]. */
std::vector<double> volumes(const types::Mesh& mesh, const Indices& indices) {
    Indices piece(mesh.positions.size());
    std::iota(piece.begin(), piece.end(), 0u);
    const auto find = [&piece](uint32_t vertex) {
        while (piece[vertex] != vertex) vertex = piece[vertex] = piece[piece[vertex]];
        return vertex;
    };
    for (size_t i = 0; i < indices.size(); ++i) piece[find(indices[i])] = find(indices[i - i % 3]);
    std::vector<double> volume(piece.size());
    for (size_t i = 0; i < indices.size(); i += 3) {
        const uint32_t name = find(indices[i]);
        const glm::dvec3 origin(mesh.positions[name]), a(mesh.positions[indices[i]]), b(mesh.positions[indices[i + 1]]),
            c(mesh.positions[indices[i + 2]]);
        volume[name] += glm::dot(a - origin, glm::cross(b - origin, c - origin)) / 6;
    }
    return volume;
}

bool isClosed(const types::Mesh& mesh) {
    const Indices indices = welded(mesh);
    return isWatertight(indices) && std::ranges::none_of(volumes(mesh, indices), [](double v) { return v < 0; });
}

}  // namespace

void findCones(types::Mesh& mesh) {
    if (!isClosed(mesh)) return;
    for (types::Cluster& cluster : mesh.clusters) {
        const meshopt_Bounds bounds =
            meshopt_computeClusterBounds(&mesh.indices[cluster.first_index], cluster.index_count, &mesh.positions[0].x,
                                         mesh.positions.size(), sizeof(glm::vec3));
        cluster.cone_apex = {bounds.cone_apex[0], bounds.cone_apex[1], bounds.cone_apex[2]};
        cluster.cone_axis = {bounds.cone_axis[0], bounds.cone_axis[1], bounds.cone_axis[2]};
        cluster.cone_cutoff = bounds.cone_cutoff;
    }
}

}  // namespace insonify::scene
