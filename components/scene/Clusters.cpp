#include "components/scene/Clusters.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <thread>
#include <utility>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::scene {
namespace {

using Indices = std::vector<uint32_t>;

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

/** Returns the number of patch sizes below a number of triangles; each size is 4 times the one before. */
int patchSizesBelow(size_t triangles) {
    int count = 0;
    for (size_t size = min_node_triangles; size < triangles; size *= 4) ++count;
    return count;
}

/** Returns the number of threads for a mesh. Smaller meshes are built several at a time (Gltf.cpp). */
unsigned countThreads(size_t triangles) {
    return triangles < 500'000 ? 1 : std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
}

/** Calls work(i) for each i below `count`, on some threads where the system permits them. */
void forEach(size_t count, size_t parts, const auto& work) {
    std::vector<std::future<void>> others;
    const auto workOn = [&](size_t part) {
        for (size_t i = part * count / parts; i < (part + 1) * count / parts; ++i) work(i);
    };
    for (size_t part = 1; part < parts; ++part)
        others.push_back(std::async(std::launch::async | std::launch::deferred, workOn, part));
    workOn(0);
    for (std::future<void>& other : others) other.get();
}

/** A triangle of a run that is being split, by its number in the mesh, and three times its centroid. */
struct Item {
    glm::vec3 centroid;
    uint32_t triangle;
};

size_t halve(std::span<Item> items) {
    Box box;
    for (const Item& item : items) box.add(item.centroid);
    const int axis = box.longestAxis();
    const size_t half = items.size() / 2;
    std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(half),
                             [axis](const Item& a, const Item& b) { return a.centroid[axis] < b.centroid[axis]; });
    return half;
}

/** Halves items at the median of the longest axis until each part is small enough for a cluster. `threads`: that may
 *  work on them. */
void arrange(std::span<Item> items, unsigned threads) {
    if (items.size() <= cluster_triangles) return;
    const size_t half = halve(items);
    std::future<void> other;
    if (threads > 1)
        other = std::async(std::launch::async | std::launch::deferred, arrange, items.first(half), threads / 2);
    else
        arrange(items.first(half), 1);
    arrange(items.subspan(half), threads - threads / 2);
    if (other.valid()) other.get();
}

/** Adds the clusters and patches of arranged triangles to a mesh. */
class Splitter {
public:
    explicit Splitter(types::Mesh& mesh) : mesh_(mesh) {}

    /** Adds one patch of `triangles`, with the patches and clusters below it. */
    void addPatch(size_t triangles, const types::Cluster& run) {
        const size_t node = mesh_.cluster_nodes.size();
        mesh_.cluster_nodes.push_back({.first_cluster = static_cast<uint32_t>(mesh_.clusters.size())});
        split(triangles, run);
        types::ClusterNode& done = mesh_.cluster_nodes[node];
        done.cluster_count = static_cast<uint32_t>(mesh_.clusters.size()) - done.first_cluster;
        done.next = static_cast<uint32_t>(mesh_.cluster_nodes.size());
    }

private:
    /** Halves `triangles` as arrange() does. The first part that is small enough for a patch size becomes a patch. */
    void split(size_t triangles, types::Cluster cluster) {
        if (triangles <= cluster_triangles) {
            cluster.index_count = static_cast<uint32_t>(3 * triangles);
            mesh_.clusters.push_back(cluster);
            return;
        }
        const size_t half = triangles / 2;
        for (const size_t part : {half, triangles - half}) {
            if (patchSizesBelow(part) < patchSizesBelow(triangles))
                addPatch(part, cluster);
            else
                split(part, cluster);
            cluster.first_index += static_cast<uint32_t>(3 * half);
        }
    }

    types::Mesh& mesh_;
};

void splitRuns(types::Mesh& mesh) {
    const std::vector<types::Cluster> runs = std::exchange(mesh.clusters, {});
    auto* const triangles = reinterpret_cast<Triangle*>(mesh.indices.data());
    for (const types::Cluster& run : runs) {
        const size_t first = run.first_index / 3, count = run.index_count / 3;
        std::vector<Item> items(count);
        for (size_t i = 0; i < count; ++i) {
            const auto& [a, b, c] = triangles[first + i];
            items[i] = {mesh.positions[a] + mesh.positions[b] + mesh.positions[c], static_cast<uint32_t>(first + i)};
        }
        arrange(items, countThreads(count));
        std::vector<Triangle> arranged(count);
        for (size_t i = 0; i < count; ++i) arranged[i] = triangles[items[i].triangle];
        std::ranges::copy(arranged, triangles + first);
        Splitter(mesh).addPatch(count, run);
    }
}

template <class T>
void remap(std::vector<T>& values, const std::vector<uint32_t>& new_place, size_t count) {
    if (values.empty()) return;
    std::vector<T> placed(count);
    meshopt_remapVertexBuffer(placed.data(), values.data(), values.size(), sizeof(T), new_place.data());
    values = std::move(placed);
}

/** Merges vertices at the same place, which files keep separate for light's normals and textures. */
void weld(types::Mesh& mesh) {
    std::vector<uint32_t> new_place(mesh.positions.size());
    const size_t count = meshopt_generateVertexRemap(new_place.data(), mesh.indices.data(), mesh.indices.size(),
                                                     mesh.positions.data(), mesh.positions.size(), sizeof(glm::vec3));
    meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(), new_place.data());
    remap(mesh.positions, new_place, count);
}

/** Orders triangles that are rasterised together for the vertex cache, at a cost that depends on their number and not
 *  on their mesh's. */
void orderTriangles(std::span<uint32_t> indices) {
    std::vector<uint32_t> vertices(indices.begin(), indices.end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (uint32_t& index : indices)
        index = static_cast<uint32_t>(std::ranges::lower_bound(vertices, index) - vertices.begin());
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
    for (uint32_t& index : indices) index = vertices[index];
}

/** Orders vertices by their first use and removes unused vertices. */
void orderVertices(types::Mesh& mesh, std::vector<uint32_t>* numbers) {
    std::vector<uint32_t> new_place(mesh.positions.size());
    const size_t used = meshopt_optimizeVertexFetchRemap(new_place.data(), mesh.indices.data(), mesh.indices.size(),
                                                         mesh.positions.size());
    meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(), new_place.data());
    remap(mesh.positions, new_place, used);
    remap(mesh.normals, new_place, used);
    remap(mesh.tangents, new_place, used);
    remap(mesh.uvs, new_place, used);
    remap(mesh.map_uvs, new_place, used);
    if (numbers) remap(*numbers, new_place, used);
}

std::span<const uint32_t> getTriangles(const types::Mesh& mesh, const types::ClusterNode& node) {
    const types::Cluster &first = mesh.clusters[node.first_cluster],
                         &last = mesh.clusters[node.first_cluster + node.cluster_count - 1];
    return std::span(mesh.indices).subspan(first.first_index, last.first_index + last.index_count - first.first_index);
}

/** Returns indices in which vertices at the same place are one, without triangles that have two corners there. */
Indices welded(const types::Mesh& mesh) {
    const std::vector<uint32_t> first = types::weldedPlaces(mesh.positions, mesh.indices);
    Indices indices;
    indices.reserve(mesh.indices.size());
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Triangle corners{first[mesh.indices[i]], first[mesh.indices[i + 1]], first[mesh.indices[i + 2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        indices.insert(indices.end(), corners.begin(), corners.end());
    }
    return indices;
}

/** Returns whether every edge occurs once in either direction. `vertices`: their number. */
bool isWatertight(const Indices& indices, size_t vertices) {
    const auto forEachEdge = [&indices](const auto& add) {
        for (size_t i = 0; i < indices.size(); ++i) {
            const uint32_t from = indices[i], to = indices[i % 3 == 2 ? i - 2 : i + 1];
            // the higher vertex, and the direction
            add(std::min(from, to), uint64_t{std::max(from, to)} << 1 | (from < to ? 1u : 0u));
        }
    };
    bool is_watertight = true;
    types::sortByVertex<uint64_t>(vertices, forEachEdge, [&](std::span<const uint64_t> edges) {
        is_watertight = is_watertight && edges.size() % 2 == 0;
        for (size_t i = 0; is_watertight && i < edges.size(); i += 2)
            is_watertight = edges[i] % 2 == 0 && edges[i + 1] == edges[i] + 1;
    });
    return is_watertight;
}

/** Returns the volume of each connected piece, positive if it is wound outward; 0 for vertices that represent no piece
 *  [m^3]. */
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

/** Returns whether a mesh is certainly open: the areas of its triangles, as vectors, do not add up to 0. Welding moves
 *  corners by at most 2^-21 of the largest coordinate (types::weldedPlaces()), which changes the sum by the lengths of
 *  edges times that. */
bool isOpen(const types::Mesh& mesh) {
    glm::dvec3 sum(0);
    double edges = 0, areas = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b = glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - a,
                                                             c = glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - a;
        const glm::dvec3 across = glm::cross(b, c);
        sum += across;
        areas += glm::length(across);
        edges += glm::length(b) + glm::length(c);
    }
    double largest = 0;
    for (const types::Cluster& cluster : mesh.clusters)
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, static_cast<double>(std::abs(cluster.centre[axis]) + cluster.half[axis]));
    const double moved = 0x1p-20 * largest, triangles = static_cast<double>(mesh.indices.size()) / 3;
    return glm::length(sum) > 4 * moved * (edges + triangles * moved) + 1e-9 * areas;
}

bool isClosed(const types::Mesh& mesh) {
    if (isOpen(mesh)) return false;
    const Indices indices = welded(mesh);
    return isWatertight(indices, mesh.positions.size()) &&
           std::ranges::none_of(volumes(mesh, indices), [](double v) { return v < 0; });
}

/** Sets `coarse_indices` of a mesh: at most this number of triangles for each patch that is part of no other. */
void findCoarseMesh(types::Mesh& mesh) {
    mesh.coarse_indices.clear();
    for (size_t root = 0; root < mesh.cluster_nodes.size(); root = mesh.cluster_nodes[root].next) {
        const std::span<const uint32_t> fine = getTriangles(mesh, mesh.cluster_nodes[root]);
        std::vector<uint32_t> coarse(fine.begin(), fine.end());
        if (fine.size() > 3 * max_coarse_triangles)  // meshoptimizer aborts if asked for more than there are
            coarse.resize(meshopt_simplifySloppy(coarse.data(), fine.data(), fine.size(), &mesh.positions[0].x,
                                                 mesh.positions.size(), sizeof(glm::vec3), 3 * max_coarse_triangles,
                                                 1.0f, nullptr));
        mesh.coarse_indices.insert(mesh.coarse_indices.end(), coarse.begin(), coarse.end());
    }
}

/** Sets the cones of a closed mesh's clusters. From inside a cone only a cluster's back is visible, hidden by the
 *  mesh's front. Closed: every edge joins two triangles of opposite winding, and every piece encloses a positive
 *  volume. */
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

}  // namespace

void buildClusters(types::Mesh& mesh, std::vector<uint32_t>* numbers) {
    if (mesh.indices.size() / 3 > clustered_from) {
        for (glm::vec3& position : mesh.positions) position += 0.0f;  // -0 becomes 0, so that both are the same place
        if (mesh.uvs.empty() && mesh.map_uvs.empty() && !numbers) weld(mesh);
        splitRuns(mesh);
    }
    forEach(mesh.clusters.size(), countThreads(mesh.indices.size() / 3), [&mesh](size_t i) {
        const types::Cluster& cluster = mesh.clusters[i];
        orderTriangles(std::span(mesh.indices).subspan(cluster.first_index, cluster.index_count));
    });
    orderVertices(mesh, numbers);
    types::boundClusters(mesh);
    if (mesh.cluster_nodes.empty()) return;
    findCoarseMesh(mesh);
    if (!numbers) findCones(mesh);
}

}  // namespace insonify::scene
