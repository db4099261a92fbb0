#pragma once
#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "components/sonar/places/MeshFacts.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Straight lines from the sonar, by the triangles themselves and in double: what stands before a point, and what is
 *  around the sonar. It asks neither rays, which a build may be without, nor pictures, which show the fan alone, so
 *  it tells the same wherever echoes come from. */
class Sightlines {
public:
    static constexpr double nearest = 1e-3;  ///< What is nearer to either end hides nothing [m].

    enum class Lines { Few, Many };

    /** `geometry` must outlive it. For many lines a ping, meshes get trees of their triangles. */
    explicit Sightlines(const types::Geometry& geometry, Lines lines = Lines::Few);

    /** Once a ping, before anything is asked of it. Allocates nothing. */
    void place(const types::Snapshot& snapshot);
    /** Whether a point in the world is seen. */
    bool isOpen(const glm::dvec3& point) const { return isOpen(sonar_, point); }
    /** Whether one point in the world is seen from another. */
    bool isOpen(const glm::dvec3& from, const glm::dvec3& to) const;
    /** The object that the sonar is inside of, as all that it sees of it are backs; none where it is in the open. */
    std::optional<uint32_t> enclosing() const;

private:
    /** Where an object is, and a box along the world's axes that holds it. */
    struct Placed {
        glm::dmat4 world_from_object;
        glm::dvec3 centre, half;
        glm::dmat3 object_from_world;  ///< Without the shift.
        bool has_inverse;              ///< False where the object is flat.
    };
    void placeObject(size_t object, const glm::dmat4& world_from_object);
    const types::Mesh& meshOf(size_t object) const;
    /** Calls `use(share, is_back)` for each triangle of an object that the line from a point meets to `end`, a vector
     *  from there, at so much of its length [1]; ends when it says true, which is then returned. */
    template <class Use>
    bool anyMet(size_t object, const glm::dvec3& from, const glm::dvec3& end, const Use& use) const;

    const types::Geometry& geometry_;
    std::vector<Placed> placed_;
    std::vector<std::shared_ptr<MeshFacts>> meshes_;  ///< Of the geometry; empty for few lines.
    std::vector<uint32_t> displaced_;                 ///< Objects that are not where the geometry has them.
    glm::dvec3 sonar_{0};                             ///< In the world [m].
};

}  // namespace insonify::sonar
