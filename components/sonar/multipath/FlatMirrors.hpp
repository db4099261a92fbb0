#pragma once
#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "components/sonar/base/BoxTree.hpp"
#include "components/sonar/multipath/Mirrors.hpp"
#include "types/geometry/Snapshot.hpp"

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

/** A flat mirror of the scene, or the water surface, in a ping; world axes. */
struct PlacedMirror {
    MirrorPlane plane;
    const FlatMirror* flat = nullptr;  ///< Null for the water surface.
    bool is_there = false;             ///< Whether it reflects in this ping, within the range.
    glm::dvec3 sonar_image{0};         ///< [m]
    double sonar_side = 0;             ///< Signed distance of the sonar from the plane [m].
    Box box;                           ///< Bounds. The water surface has none.
};

/** The mirrors that the sonar's sound may reach after each first mirror. They are the same for all targets of a ping.
 *  None is missing; a few may be superfluous. */
class MirrorReach {
public:
    /** For `count` mirrors, the first of which may be the water surface. */
    explicit MirrorReach(size_t count);

    /** Takes a ping's mirrors, which must stay valid until the next. Paths are at most `longest` [m]; `doubt` bounds
     *  the rounding of places [m]. Allocates in the first ping only. */
    void place(std::span<const PlacedMirror> mirrors, double longest, double doubt);

    /** Calls `use(second)` for the mirrors that may follow a first. */
    void forEachAfter(size_t first, const auto& use) const {
        const Found& found = found_[first];
        if (!found.is_complete) return forEachMet(first, use);
        for (const uint32_t second : std::span(seconds_).subspan(found.begin, found.count)) use(size_t{second});
    }

private:
    /** The space that sound reaches via a first mirror: a pyramid from the sonar's image through the mirror's outline,
     *  on the sonar's side of the mirror. */
    struct Beam {
        glm::dvec3 apex;
        MirrorPlane front;                   ///< Its normal points to the sonar's side.
        std::array<glm::dvec3, 4> inward{};  ///< Normals of the sides, 0 where there is no side [m^2].
        std::array<double, 4> product{},
            sum{};              ///< Product and sum of the distances of a side's two corners [m^2], [m].
        double longest, doubt;  ///< [m]

        Beam(const PlacedMirror& mirror, double longest_way, double rounding);
        bool mayMeet(const Box& box) const;
        bool mayMeet(const std::array<glm::dvec3, 4>& outline) const;
    };
    /** The second mirrors of a first mirror. */
    struct Found {
        uint32_t begin = 0, count = 0;  ///< Range in seconds_.
        bool is_complete = false;       ///< False: they did not fit.
    };

    void forEachMet(size_t first, const auto& use) const {
        if (!mirrors_[first].is_there || std::abs(mirrors_[first].sonar_side) <= doubt_) return;
        const Beam beam(mirrors_[first], longest_, doubt_);
        if (first > 0 && mirrors_[0].is_there) use(size_t{0});
        tree_.any([&](const Box& box) { return beam.mayMeet(box); },
                  [&](size_t item) {
                      const PlacedMirror& second = mirrors_[item + 1];
                      if (item + 1 != first && second.is_there && beam.mayMeet(second.flat->outline)) use(item + 1);
                      return false;
                  });
    }

    std::span<const PlacedMirror> mirrors_;
    double longest_ = 0, doubt_ = 0;  ///< [m]
    std::vector<Box> boxes_;          ///< Boxes of all mirrors except the water surface.
    BoxTree tree_;
    bool has_tree_ = false;
    std::vector<Found> found_;       ///< For each first mirror.
    std::vector<uint32_t> seconds_;  ///< Second mirrors, grouped by first mirror.
};

}  // namespace insonify::sonar
