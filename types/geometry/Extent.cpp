#include "types/geometry/Extent.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <span>
#include <utility>
#include <vector>

#include "types/geometry/MeshRays.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::types {
namespace {

glm::dvec3 placed(const glm::dmat4& world_from_mesh, const glm::vec3& position) {
    return glm::dvec3(world_from_mesh * glm::dvec4(position, 1));
}

/** Returns world_from_object of every object at the time of the snapshot. */
std::vector<glm::dmat4> getPlaces(const Snapshot& snapshot) {
    std::vector<glm::dmat4> places;
    for (const Object& object : snapshot.geometry->objects) places.push_back(object.world_from_object);
    for (const MovedObject& moved : snapshot.moved) places.at(moved.object) = moved.world_from_object;
    return places;
}

const Mesh& getMesh(const Geometry& geometry, size_t object) {
    return geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
}

/** Returns the place of the foot of a perpendicular along an edge, clamped to 0 to 1. */
double clampedShare(double along, double whole) { return whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0.0; }

glm::dvec3 nearestOfEdge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    return a + clampedShare(glm::dot(p - a, b - a), glm::dot(b - a, b - a)) * (b - a);
}

/** Returns whether a cluster or node has a box: boundClusters() makes none of size 0. */
bool isBounded(const glm::vec3& half) { return half != glm::vec3(0); }

/** Returns the box along the world's axes around the box of a cluster; infinite where the cluster has none. */
Extent placedBox(const glm::dmat4& world_from_mesh, const glm::vec3& centre, const glm::vec3& half) {
    if (!isBounded(half)) return {Extent().high, Extent().low};
    const glm::dmat3 linear(world_from_mesh);
    const glm::dvec3 middle = placed(world_from_mesh, centre), size(half);
    const glm::dvec3 reach = glm::abs(linear[0]) * size.x + glm::abs(linear[1]) * size.y + glm::abs(linear[2]) * size.z;
    return {middle - reach, middle + reach};
}

/** Returns the clusters whose boxes reach furthest along each axis of the world, to either side. */
std::vector<const Cluster*> outermostClusters(const Mesh& mesh, const glm::dmat4& world_from_mesh) {
    std::array<double, 6> reached;
    reached.fill(-std::numeric_limits<double>::infinity());
    std::vector<const Cluster*> outermost(mesh.clusters.empty() ? 0 : 6, mesh.clusters.data());
    const auto reach = [&](const glm::vec3& centre, const glm::vec3& half) {
        const Extent box = placedBox(world_from_mesh, centre, half);
        return std::array{-box.low.x, box.high.x, -box.low.y, box.high.y, -box.low.z, box.high.z};
    };
    const auto mayReach = [&](const glm::vec3& centre, const glm::vec3& half) {
        const auto own = reach(centre, half);
        return !std::ranges::equal(own, reached, std::less_equal<>());
    };
    anyCluster(mesh, mayReach, [&](const Cluster& cluster) {
        const auto own = reach(cluster.centre, cluster.half);
        for (size_t side = 0; side < own.size(); ++side)
            if (own[side] > reached[side]) reached[side] = own[side], outermost[side] = &cluster;
        return false;
    });
    return outermost;
}

/** The search for the point of all triangles that is nearest to a place, by the boxes of clusters. */
class NearestSearch {
public:
    explicit NearestSearch(const glm::dvec3& place) : place_(place) {}

    const NearestPoint& nearest() const { return nearest_; }

    /** Returns a lower bound of the distance to a mesh [m]. */
    double atLeast(const Mesh& mesh, const glm::dmat4& world_from_mesh) const {
        return mesh.clusters.empty() ? 0 : nearestCluster(mesh, world_from_mesh).first;
    }

    void lookAt(const Mesh& mesh, const glm::dmat4& world_from_mesh, uint32_t object) {
        if (mesh.clusters.empty())
            return look(mesh, world_from_mesh, object, 0, static_cast<uint32_t>(mesh.indices.size()));
        const auto lookAtCluster = [&](const Cluster& cluster) {
            look(mesh, world_from_mesh, object, cluster.first_index, cluster.index_count);
            return false;
        };
        lookAtCluster(*nearestCluster(mesh, world_from_mesh).second);
        anyCluster(
            mesh,
            [&](const glm::vec3& centre, const glm::vec3& half) {
                return atLeast(world_from_mesh, centre, half) <= nearest_.distance;
            },
            lookAtCluster);
    }

private:
    double atLeast(const glm::dmat4& world_from_mesh, const glm::vec3& centre, const glm::vec3& half) const {
        if (!isBounded(half)) return 0;
        const WorldBox box(world_from_mesh, centre, half);
        return std::max(0.0, glm::length(glm::max(glm::abs(place_ - box.centre) - box.half, 0.0)));  // of NaN: 0
    }

    /** Returns the cluster whose box is nearest, and its distance [m]. */
    std::pair<double, const Cluster*> nearestCluster(const Mesh& mesh, const glm::dmat4& world_from_mesh) const {
        std::pair<double, const Cluster*> nearest(std::numeric_limits<double>::infinity(), &mesh.clusters.front());
        anyCluster(
            mesh,
            [&](const glm::vec3& centre, const glm::vec3& half) {
                return atLeast(world_from_mesh, centre, half) < nearest.first;
            },
            [&](const Cluster& cluster) {
                nearest = {atLeast(world_from_mesh, cluster.centre, cluster.half), &cluster};
                return false;
            });
        return nearest;
    }

    /** Looks at the triangles from an index on. Of points at one distance it takes the first of the scene. */
    void look(const Mesh& mesh, const glm::dmat4& world_from_mesh, uint32_t object, uint32_t first, uint32_t count) {
        const auto corner = [&](size_t k) { return placed(world_from_mesh, mesh.positions[mesh.indices[k]]); };
        for (uint32_t k = first; k + 2 < first + count; k += 3) {
            const glm::dvec3 point = nearestOfTriangle(place_, corner(k), corner(k + 1), corner(k + 2));
            const double distance = glm::distance(point, place_);
            if (!(distance <= nearest_.distance)) continue;
            if (distance == nearest_.distance && std::pair(object, k) >= std::pair(nearest_.object, index_)) continue;
            nearest_ = {distance, point, object};
            index_ = k;
        }
    }

    glm::dvec3 place_;
    NearestPoint nearest_;
    uint32_t index_ = std::numeric_limits<uint32_t>::max();  ///< Of the first corner of the nearest triangle.
};

}  // namespace

void Extent::add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
}

void Extent::add(const Extent& other) {
    if (other.isEmpty()) return;
    add(other.low);
    add(other.high);
}

Extent getExtent(const Mesh& mesh, const glm::dmat4& world_from_mesh) {
    Extent extent;
    const auto addAll = [&](std::span<const uint32_t> indices) {
        for (const uint32_t index : indices) extent.add(placed(world_from_mesh, mesh.positions[index]));
        return false;
    };
    if (mesh.clusters.empty()) addAll(mesh.indices);
    const auto add = [&](const Cluster& cluster) {
        return addAll(std::span(mesh.indices).subspan(cluster.first_index, cluster.index_count));
    };
    for (const Cluster* const outermost : outermostClusters(mesh, world_from_mesh)) add(*outermost);
    const auto mayExtend = [&](const glm::vec3& centre, const glm::vec3& half) {
        const Extent box = placedBox(world_from_mesh, centre, half);
        return !glm::all(glm::greaterThanEqual(box.low, extent.low)) ||
               !glm::all(glm::lessThanEqual(box.high, extent.high));
    };
    anyCluster(mesh, mayExtend, add);
    return extent;
}

Extent getExtent(const Geometry& geometry) {
    Extent extent;
    for (const Object& object : geometry.objects)
        extent.add(getExtent(geometry.meshes[static_cast<size_t>(object.mesh)], object.world_from_object));
    return extent;
}

Extent getExtent(const Snapshot& snapshot) {
    Extent extent;
    const std::vector<glm::dmat4> places = getPlaces(snapshot);
    const GeometryPtr geometry = posedGeometry(snapshot);
    for (size_t i = 0; i < places.size(); ++i) extent.add(getExtent(getMesh(*geometry, i), places[i]));
    return extent;
}

glm::dvec3 nearestOfTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const bool inside = glm::dot(glm::cross(b - a, p - a), normal) >= 0 &&
                        glm::dot(glm::cross(c - b, p - b), normal) >= 0 &&
                        glm::dot(glm::cross(a - c, p - c), normal) >= 0;
    const double area = glm::dot(normal, normal);
    if (inside && area > 0) return p - normal * (glm::dot(p - a, normal) / area);
    glm::dvec3 nearest = nearestOfEdge(p, a, b);
    for (const glm::dvec3& other : {nearestOfEdge(p, b, c), nearestOfEdge(p, c, a)})
        if (glm::distance(p, other) < glm::distance(p, nearest)) nearest = other;
    return nearest;
}

NearestPoint nearestPoint(const Snapshot& snapshot, const glm::dvec3& place) {
    const std::vector<glm::dmat4> places = getPlaces(snapshot);
    const GeometryPtr geometry = posedGeometry(snapshot);
    NearestSearch search(place);
    std::vector<uint32_t> order(places.size());
    std::vector<double> bounds(places.size());
    for (size_t i = 0; i < places.size(); ++i) {
        order[i] = static_cast<uint32_t>(i);
        bounds[i] = search.atLeast(getMesh(*geometry, i), places[i]);
    }
    std::ranges::sort(order, {}, [&](uint32_t i) { return std::pair(bounds[i], i); });
    for (const uint32_t i : order)
        if (bounds[i] <= search.nearest().distance) search.lookAt(getMesh(*geometry, i), places[i], i);
    return search.nearest();
}

}  // namespace insonify::types
