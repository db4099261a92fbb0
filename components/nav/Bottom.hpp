#pragma once
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "types/Snapshot.hpp"

namespace insonify::nav {

/** The surroundings of a Doppler velocity log, for straight beams: the triangles of a scene including moved and
 *  deformed objects, or a level bottom. */
class Bottom {
public:
    /** @param height of a level bottom in the world [m]; none: no bottom */
    explicit Bottom(std::optional<double> height = {}) : height_(height) {}

    /** Replaces the bottom by the scene of this snapshot, and poses its meshes that deform. Other objects that are not
     *  moved are placed once per geometry. */
    void take(types::SnapshotPtr snapshot);
    /** Returns whether a place is under the water surface; true when the scene has no surface. */
    bool isUnderWater(const glm::dvec3& place) const;

    /** Returns the range from a place in the world along a unit vector [m]; none when nothing is within `farthest`. */
    std::optional<double> range(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

private:
    /** The pose of an object, and its bounding box along the world's axes. */
    struct Placed {
        glm::dmat4 world_from_object{1};
        const types::Mesh* mesh = nullptr;  ///< Mesh of the geometry, or its posed copy.
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    };
    void place(size_t object, const glm::dmat4& world_from_object, const types::Mesh& mesh);
    const types::Mesh& meshOf(size_t object) const;
    /** Returns the mesh of an object in the shape of the snapshot. */
    const types::Mesh& posed(const types::DeformedObject& deformed);
    std::optional<double> rangeOfScene(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const;

    std::optional<double> height_;
    types::SnapshotPtr snapshot_;
    std::vector<Placed> placed_;           ///< One per object of the geometry.
    std::vector<size_t> changed_;          ///< Objects that are moved from their place in the geometry, or deformed.
    std::map<size_t, types::Mesh> posed_;  ///< Meshes of the objects that have been deformed.
};

}  // namespace insonify::nav
