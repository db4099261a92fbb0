#pragma once
#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "components/sonar/base/BoxTree.hpp"
#include "components/sonar/multipath/Mirrors.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Coplanar triangles with `mirror: true` of one object, within the precision of their corners' floats. */
struct FlatMirror {
    /** In the ping; world axes. */
    MirrorPlane plane;
    std::array<glm::dvec3, 4>
        outline{};          ///< Corners, in order, of a part of the plane that contains all triangles [m].
    bool is_there = false;  ///< False: no area in this ping.

    /** In the mesh. */
    size_t object = 0;
    std::array<glm::dvec3, 3> corners{};          ///< The largest triangle, whose plane is used for all [m].
    std::array<glm::dvec3, 4> outline_in_mesh{};  ///< [m]
    int u = 0, v = 1;                             ///< The axes of the mesh that measure places in the plane.
    uint32_t first = 0, count = 0;                ///< Triangles, ascending.
    BoxTree tree;                                 ///< Over the triangles; empty for few triangles.

    /** Transform from the world to the axes u and v of the mesh, within the plane. */
    glm::dvec3 origin{0}, per_u{0}, per_v{0};
};

/** A triangle of a flat mirror, on the axes u and v, counter-clockwise [m]. */
struct MirrorTriangle {
    std::array<glm::dvec2, 3> corners;
    double power = 1;    ///< Share of the sound's power that is reflected [1].
    uint32_t place = 0;  ///< Index among all mirror triangles of the scene [1].
};

/** The flat mirrors of a scene. One image of a point serves all triangles of a plane. */
class FlatMirrors {
public:
    /** `geometry` must outlive it. With 0 bounces there is no mirror. */
    FlatMirrors(const types::Geometry& geometry, int bounces);

    /** Takes the places of a ping. Allocates nothing where no mirror deforms. */
    void place(const types::Snapshot& snapshot);
    std::span<const FlatMirror> all() const { return mirrors_; }
    /** Returns the triangle at a point of the mirror's plane, null where there is none. Triangles include their edges,
     *  and `slack` [m] beyond. Where several triangles meet, it is the first in the order of the scene. */
    const MirrorTriangle* triangleAt(const FlatMirror& mirror, const glm::dvec3& point, double slack) const;

private:
    void addAll();
    void addObject(size_t object, int bounces, uint32_t& count);

    const types::Geometry& geometry_;
    int bounces_;
    std::vector<bool> reflects_;             ///< Whether each object has a mirror, in any shape.
    std::vector<const glm::dmat4*> places_;  ///< Place of each object.
    std::vector<FlatMirror> mirrors_;
    std::vector<MirrorTriangle> triangles_;
};

}  // namespace insonify::sonar
