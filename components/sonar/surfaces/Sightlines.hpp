#pragma once
#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Straight lines of sight from the sonar, computed with the triangles themselves in double: what hides a point, and
 *  what encloses the sonar. Uses neither rays, which a build may lack, nor images, which show the fan only. Its results
 *  thus do not depend on the way the echoes are rendered. */
class Sightlines {
public:
    static constexpr double nearest = 1e-3;  ///< Surfaces nearer to either end hide nothing [m].

    enum class Lines { Few, Many };

    /** `geometry` must outlive it. For many lines per ping, meshes get trees of their triangles. */
    explicit Sightlines(const types::Geometry& geometry, Lines lines = Lines::Few);

    /** Places the objects; call it once per ping, before any query. Allocates nothing. */
    void place(const types::Snapshot& snapshot);
    /** Returns whether the sonar sees a point in the world. */
    bool isOpen(const glm::dvec3& point) const { return isOpen(sonar_, point); }
    /** Returns whether one point in the world is visible from another. */
    bool isOpen(const glm::dvec3& from, const glm::dvec3& to) const;
    /** A wall that a line of sight crosses. */
    struct WallHit {
        double range;     ///< From the line's start [m].
        double cosine;    ///< Cosine of the angle between the line and the wall's normal [1].
        size_t material;  ///< [1]
    };
    /** Finds the walls between two points, by their range. `are_walls` has a value for each material. Returns false
     *  where a surface of another material hides one point from the other. A line through the common edge of two
     *  triangles crosses both. */
    bool findWalls(const glm::dvec3& from, const glm::dvec3& to, const std::vector<bool>& are_walls,
                   std::vector<WallHit>& walls) const;
    /** Returns the object that encloses the sonar, of which it sees only back faces; none where it is in open water. */
    std::optional<uint32_t> enclosing() const;

private:
    /** Place of an object, and its box along the world's axes. */
    struct Placed {
        glm::dmat4 world_from_object;
        glm::dvec3 centre, half;
        glm::dmat3 object_from_world;  ///< Without the translation.
        bool has_inverse;              ///< False where the object is flat.
    };
    void placeObject(size_t object, const glm::dmat4& world_from_object);
    const types::Mesh& getMesh(size_t object) const;
    /** Returns the unit normal of the triangle with a first index, in the world; 0 where it has no area. */
    glm::dvec3 normalAt(size_t object, size_t index) const;
    /** Calls `use(share, is_back, index)` for each triangle of an object that the line from `from` along the vector
     *  `end` hits; `share` is the hit's part of its length [1], `index` that of the triangle's first corner. Stops when
     *  `use` returns true. Returns whether it did. */
    bool anyMet(size_t object, const glm::dvec3& from, const glm::dvec3& end, const auto& use) const;

    const types::Geometry& geometry_;
    std::vector<Placed> placed_;
    std::vector<std::shared_ptr<MeshFacts>> meshes_;  ///< Meshes of the geometry; empty for few lines.
    std::vector<uint32_t> displaced_;                 ///< Objects that are moved from their place in the geometry.
    glm::dvec3 sonar_{0};                             ///< Position in the world [m].
};

}  // namespace insonify::sonar
