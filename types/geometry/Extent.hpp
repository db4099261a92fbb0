#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "types/geometry/Snapshot.hpp"

namespace insonify::types {

/** A box along the axes of the world that contains all added points and boxes [m]. */
struct Extent {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    bool isEmpty() const { return !(low.x <= high.x); }
    glm::dvec3 size() const { return isEmpty() ? glm::dvec3(0) : high - low; }
    void add(const glm::dvec3& point);
    void add(const Extent& other);
};

/** Returns the extent in the world of the vertices that triangles of a mesh use. Looks only at clusters whose boxes are
 *  not inside of the extent so far: a small share of a large mesh. */
Extent getExtent(const Mesh& mesh, const glm::dmat4& world_from_mesh);
/** Returns the extent of all objects at their places in the geometry. */
Extent getExtent(const Geometry& geometry);
/** Returns the extent of all objects at the time of the snapshot. */
Extent getExtent(const Snapshot& snapshot);

/** The point of all triangles that is nearest to a place. */
struct NearestPoint {
    double distance = std::numeric_limits<double>::infinity();  ///< Infinite without triangles [m].
    glm::dvec3 point{0};                                        ///< In the world [m].
    uint32_t object = 0;                                        ///< Index into Geometry::objects [1].
};
/** Returns the nearest point of all objects at the time of the snapshot. Looks only at clusters whose boxes are nearer
 *  than the nearest point so far: a small share of a large mesh, except where most of it is equally near. */
NearestPoint nearestPoint(const Snapshot& snapshot, const glm::dvec3& place);

/** Returns the point of the triangle a, b, c nearest to p (Ericson, Real-Time Collision Detection, 2005, 5.1.5). */
glm::dvec3 nearestOfTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace insonify::types
