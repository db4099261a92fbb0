#include "components/scene/Clusters.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace insonify::scene {
namespace {

using Triangle = std::array<uint32_t, 3>;
static_assert(sizeof(Triangle) == 3 * sizeof(uint32_t));

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    void add(glm::vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    int longestAxis() const {
        const glm::vec3 size = high - low;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }
};

/** Halves `triangles` at the median of the longest axis until each part is small enough; appends a cluster for each. */
void split(types::Mesh& mesh, std::span<Triangle> triangles, types::Cluster cluster,
           std::vector<types::Cluster>& clusters) {
    if (triangles.size() <= kClusterTriangles) {
        cluster.index_count = static_cast<uint32_t>(3 * triangles.size());
        clusters.push_back(cluster);
        return;
    }
    const auto centroid = [&mesh](const Triangle& t) {  // times 3
        return mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]];
    };
    Box box;
    for (const Triangle& triangle : triangles) box.add(centroid(triangle));
    const int axis = box.longestAxis();
    const size_t half = triangles.size() / 2;
    std::ranges::nth_element(
        triangles, triangles.begin() + static_cast<std::ptrdiff_t>(half),
        [&](const Triangle& a, const Triangle& b) { return centroid(a)[axis] < centroid(b)[axis]; });
    split(mesh, triangles.first(half), cluster, clusters);
    cluster.first_index += static_cast<uint32_t>(3 * half);
    split(mesh, triangles.subspan(half), cluster, clusters);
}

void splitRuns(types::Mesh& mesh) {
    std::vector<types::Cluster> clusters;
    auto* triangles = reinterpret_cast<Triangle*>(mesh.indices.data());
    for (const types::Cluster& run : mesh.clusters)
        split(mesh, {triangles + run.first_index / 3, run.index_count / 3}, run, clusters);
    mesh.clusters = std::move(clusters);
}

/** Orders the triangles of one cluster for the vertex cache; local numbers keep the cost that of the cluster. */
void orderTriangles(std::span<uint32_t> indices) {
    std::vector<uint32_t> vertices(indices.begin(), indices.end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (uint32_t& index : indices)
        index = static_cast<uint32_t>(std::ranges::lower_bound(vertices, index) - vertices.begin());
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
    for (uint32_t& index : indices) index = vertices[index];
}

/** Rounded up, so that centre +- half holds every vertex. */
void bound(const types::Mesh& mesh, types::Cluster& cluster) {
    Box box;
    for (const uint32_t index : std::span(mesh.indices).subspan(cluster.first_index, cluster.index_count))
        box.add(mesh.positions[index]);
    cluster.centre = box.low + (box.high - box.low) / 2.0f;
    const glm::vec3 half = glm::max(box.high - cluster.centre, cluster.centre - box.low);
    for (int axis = 0; axis < 3; ++axis)
        cluster.half[axis] = std::nextafter(half[axis], std::numeric_limits<float>::infinity());
}

template <class T>
void remap(std::vector<T>& values, const std::vector<uint32_t>& new_place, size_t count) {
    if (values.empty()) return;
    std::vector<T> placed(count);
    meshopt_remapVertexBuffer(placed.data(), values.data(), values.size(), sizeof(T), new_place.data());
    values = std::move(placed);
}

/** Vertices in the order of their first use; those that no triangle uses are gone. */
void orderVertices(types::Mesh& mesh) {
    std::vector<uint32_t> new_place(mesh.positions.size());
    const size_t used = meshopt_optimizeVertexFetchRemap(new_place.data(), mesh.indices.data(), mesh.indices.size(),
                                                         mesh.positions.size());
    meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(), new_place.data());
    remap(mesh.positions, new_place, used);
    remap(mesh.normals, new_place, used);
    remap(mesh.tangents, new_place, used);
    remap(mesh.uvs, new_place, used);
}

}  // namespace

void buildClusters(types::Mesh& mesh) {
    if (mesh.indices.size() / 3 > kClusteredFrom) splitRuns(mesh);
    for (types::Cluster& cluster : mesh.clusters) {
        orderTriangles(std::span(mesh.indices).subspan(cluster.first_index, cluster.index_count));
        bound(mesh, cluster);
    }
    orderVertices(mesh);
}

}  // namespace insonify::scene
