#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "types/Snapshot.hpp"

namespace insonify::nav {

/** What lies around a log, for straight beams: the triangles of a scene, moved objects where they are, or a level
 *  bottom. */
class Bottom {
public:
    /** A level bottom at a height of the world [m]; none: nothing is met. */
    explicit Bottom(std::optional<double> height = {}) : height_(height) {}

    /** The scene instead, as of this snapshot. What is not moved is looked at once for each geometry. */
    void take(types::SnapshotPtr snapshot);
    bool hasScene() const { return snapshot_ != nullptr; }
    /** Whether a place is in the water, as far as the scene has a surface. */
    bool isUnderWater(const glm::dvec3& place) const;

    /** How far it is from a place in the world along a unit vector, at most `farthest`; none: nothing is met [m]. */
    std::optional<double> range(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

private:
    /** Where an object is, and a box along the world's axes that holds it. */
    struct Placed {
        glm::dmat4 world_from_object{1};
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    };
    void place(size_t object, const glm::dmat4& world_from_object);
    const types::Mesh& meshOf(size_t object) const;
    std::optional<double> rangeOfScene(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

    std::optional<double> height_;
    types::SnapshotPtr snapshot_;
    std::vector<Placed> placed_;  ///< Of each object of the geometry.
    std::vector<size_t> moved_;   ///< Objects that are not where the geometry has them.
};

}  // namespace insonify::nav
