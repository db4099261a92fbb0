#include "types/Extent.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "types/PosedMesh.hpp"

namespace insonify::types {
namespace {

glm::dvec3 placed(const glm::dmat4& world_from_mesh, const glm::vec3& position) {
    return glm::dvec3(world_from_mesh * glm::dvec4(position, 1));
}

/** Returns world_from_object of every object at the time of the snapshot. */
std::vector<glm::dmat4> placesOf(const Snapshot& snapshot) {
    std::vector<glm::dmat4> places;
    for (const Object& object : snapshot.geometry->objects) places.push_back(object.world_from_object);
    for (const MovedObject& moved : snapshot.moved) places.at(moved.object) = moved.world_from_object;
    return places;
}

const Mesh& meshOf(const Geometry& geometry, size_t object) {
    return geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
}

/** Returns the place of the foot of a perpendicular along an edge, clamped to 0 to 1. */
double clampedShare(double along, double whole) { return whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0.0; }

glm::dvec3 nearestOfEdge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    return a + clampedShare(glm::dot(p - a, b - a), glm::dot(b - a, b - a)) * (b - a);
}

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

Extent extentOf(const Mesh& mesh, const glm::dmat4& world_from_mesh) {
    Extent extent;
    for (const uint32_t index : mesh.indices) extent.add(placed(world_from_mesh, mesh.positions[index]));
    return extent;
}

Extent extentOf(const Geometry& geometry) {
    Extent extent;
    for (const Object& object : geometry.objects)
        extent.add(extentOf(geometry.meshes[static_cast<size_t>(object.mesh)], object.world_from_object));
    return extent;
}

Extent extentOf(const Snapshot& snapshot) {
    Extent extent;
    const std::vector<glm::dmat4> places = placesOf(snapshot);
    const GeometryPtr geometry = posedGeometry(snapshot);
    for (size_t i = 0; i < places.size(); ++i) extent.add(extentOf(meshOf(*geometry, i), places[i]));
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
    NearestPoint nearest;
    const std::vector<glm::dmat4> places = placesOf(snapshot);
    const GeometryPtr geometry = posedGeometry(snapshot);
    for (size_t i = 0; i < places.size(); ++i) {
        const Mesh& mesh = meshOf(*geometry, i);
        const auto corner = [&](size_t k) { return placed(places[i], mesh.positions[mesh.indices[k]]); };
        for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
            const glm::dvec3 point = nearestOfTriangle(place, corner(k), corner(k + 1), corner(k + 2));
            const double distance = glm::distance(point, place);
            if (distance < nearest.distance) nearest = {distance, point, static_cast<uint32_t>(i)};
        }
    }
    return nearest;
}

}  // namespace insonify::types
