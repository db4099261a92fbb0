#pragma once
// Intersections of straight lines with the triangles of meshes, in double precision and without a search tree.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <span>

#include "types/geometry/Geometry.hpp"

namespace insonify::types {

/** The box along the world's axes that contains a box along an object's axes, enlarged by the rounding of floats
 *  [m]. */
struct WorldBox {
    glm::dvec3 centre, half;

    WorldBox(const glm::dmat4& world_from_object, const glm::dvec3& middle, const glm::dvec3& reported)
        : centre(world_from_object * glm::dvec4(middle, 1)) {
        const glm::dmat3 linear(world_from_object);
        const glm::dvec3 reach = reported + 1e-6 * (glm::abs(middle) + reported);
        half = glm::abs(linear[0]) * reach.x + glm::abs(linear[1]) * reach.y + glm::abs(linear[2]) * reach.z;
    }
};

/** Returns whether a line from `from` to `from + way` meets a box, with a small tolerance. */
inline bool meetsBox(const glm::dvec3& from, const glm::dvec3& way, const glm::dvec3& centre, const glm::dvec3& half) {
    double enters = 0, leaves = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = half[axis] + 1e-9 * (std::abs(centre[axis]) + half[axis] + 1);
        const double low = centre[axis] - reach - from[axis], high = centre[axis] + reach - from[axis];
        if (way[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const double a = low / way[axis], b = high / way[axis];
        enters = std::max(enters, std::min(a, b));
        leaves = std::min(leaves, std::max(a, b));
    }
    return enters <= leaves;
}

/** The place on a line, as a share of its length [1], where it meets a triangle, and whether at the triangle's back. */
struct TriangleMet {
    double share;
    bool is_back;
};
/** Intersects a line from the origin with a triangle, edges included (Möller and Trumbore 1997); none for a miss. */
inline std::optional<TriangleMet> meetTriangle(const glm::dvec3& way, const glm::dvec3& a, const glm::dvec3& b,
                                               const glm::dvec3& c) {
    constexpr double slack = 1e-12;
    const glm::dvec3 along = b - a, across = c - a, p = glm::cross(way, across);
    const double volume = glm::dot(along, p);
    if (volume == 0) return {};
    const double u = -glm::dot(a, p) / volume;
    const glm::dvec3 q = glm::cross(-a, along);
    const double v = glm::dot(way, q) / volume;
    if (u < -slack || v < -slack || u + v > 1 + slack) return {};
    return TriangleMet{glm::dot(across, q) / volume, volume < 0};
}

/** Calls `use` for the clusters of a mesh for which `mayMeet` accepts the box and the boxes of all nodes above. Ends
 *  when `use` returns true, and returns that. */
bool anyCluster(const Mesh& mesh, const auto& mayMeet, const auto& use) {
    const auto among = [&](std::span<const Cluster> clusters) {
        return std::ranges::any_of(
            clusters, [&](const Cluster& cluster) { return mayMeet(cluster.centre, cluster.half) && use(cluster); });
    };
    if (mesh.cluster_nodes.empty()) return among(mesh.clusters);
    for (size_t i = 0; i < mesh.cluster_nodes.size();) {
        const ClusterNode& node = mesh.cluster_nodes[i];
        if (!mayMeet(node.centre, node.half))
            i = node.next;
        else if (++i == node.next && among(std::span(mesh.clusters).subspan(node.first_cluster, node.cluster_count)))
            return true;
    }
    return false;
}

/** The triangles of a placed mesh, and the line from `from` to `from + way`. */
struct TrianglesOnLine {
    const Mesh& mesh;
    const glm::dmat4& world_from_object;
    const glm::dvec3 &from, &way;
    bool mirrored = glm::determinant(glm::dmat3(world_from_object)) < 0;

    /** Calls `use(share, is_back, index)` for each triangle among `index_count` indices that the line meets. The share
     *  of the way [1] is above 0 and below 1, `index` is that of the triangle's first corner. Ends when `use` returns
     *  true, and returns that. */
    template <class Use>
    bool any(size_t first_index, size_t index_count, const Use& use) const {
        for (size_t i = first_index; i < first_index + index_count; i += 3) {
            const auto met = meetTriangle(way, corner(i), corner(i + 1), corner(i + 2));
            if (met && met->share > 0 && met->share < 1 && use(met->share, met->is_back != mirrored, i)) return true;
        }
        return false;
    }
    glm::dvec3 corner(size_t index) const {
        return glm::dvec3(world_from_object * glm::dvec4(mesh.positions[mesh.indices[index]], 1)) - from;
    }
};

/** Applies TrianglesOnLine::any to all triangles of a mesh. Tests only clusters whose boxes the line meets. */
bool anyTriangleMet(const Mesh& mesh, const glm::dmat4& world_from_object, const glm::dvec3& from,
                    const glm::dvec3& way, const auto& use) {
    const TrianglesOnLine line{mesh, world_from_object, from, way};
    const auto mayMeet = [&](const glm::dvec3& centre, const glm::dvec3& half) {
        const WorldBox box(world_from_object, centre, half);
        return meetsBox(from, way, box.centre, box.half);
    };
    return anyCluster(mesh, mayMeet,
                      [&](const Cluster& cluster) { return line.any(cluster.first_index, cluster.index_count, use); });
}

}  // namespace insonify::types
