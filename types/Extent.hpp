#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "types/Snapshot.hpp"

namespace insonify::types {

/** A box along the axes of the world that holds what has been added to it [m]. */
struct Extent {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    bool isEmpty() const { return !(low.x <= high.x); }
    glm::dvec3 size() const { return isEmpty() ? glm::dvec3(0) : high - low; }
    void add(const glm::dvec3& point);
    void add(const Extent& other);
};

/** Of the vertices that triangles of a mesh use, in the world. */
Extent extentOf(const Mesh& mesh, const glm::dmat4& world_from_mesh);
/** Of all objects, where the geometry puts them. */
Extent extentOf(const Geometry& geometry);
/** Of all objects, where they are at that instant. */
Extent extentOf(const Snapshot& snapshot);

/** The point of all triangles that is nearest to a place. */
struct NearestPoint {
    double distance = std::numeric_limits<double>::infinity();  ///< Infinite where there is no triangle [m].
    glm::dvec3 point{0};                                        ///< In the world [m].
    uint32_t object = 0;                                        ///< Index into Geometry::objects [1].
};
/** As objects are at that instant. Takes time in proportion to the triangles. */
NearestPoint nearestPoint(const Snapshot& snapshot, const glm::dvec3& place);

/** The point of the triangle a, b, c nearest to p (Ericson, Real-Time Collision Detection, 2005, 5.1.5). */
glm::dvec3 nearestOfTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace insonify::types
