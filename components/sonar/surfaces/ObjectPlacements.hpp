#pragma once
#include <limits>
#include <numbers>
#include <vector>

#include "components/sonar/base/Interface.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** The part of space that a sonar covers, symmetric about its look direction. */
struct Reach {
    double range_max = std::numeric_limits<double>::infinity();  ///< [m]
    double half_azimuth = std::numbers::pi;                      ///< [rad]
    double half_elevation = std::numbers::pi / 2;                ///< [rad]
};

/** The places of a scene's objects relative to the sonar in this ping. */
class ObjectPlacements {
public:
    /** `geometry` must outlive it. `all`: objects out of range are placed as well. */
    ObjectPlacements(const types::Geometry& geometry, const Reach& reach, bool all);

    /** Places the objects; call it once per ping. */
    void place(const types::Snapshot& snapshot);
    const std::vector<ObjectRecord>& records() const { return records_; }
    /** Returns whether an object is out of range and was not placed: its record is not of this ping. */
    bool isFar(size_t object) const { return far_[object]; }
    /** Returns the box of an object's mesh, in the mesh's coordinates. */
    const Box& box(size_t object) const { return meshes_[getMesh(object)]->box(); }

private:
    size_t getMesh(size_t object) const { return static_cast<size_t>(geometry_.objects[object].mesh); }
    void placeObject(size_t index, const glm::dmat4& sonar_from_object);
    /** Returns the inverse of its nearest range, and of its farthest [1/m]. */
    vec4 extent(size_t index, const glm::dmat4& sonar_from_object, double nearest_of_sphere);
    /** Finds the objects that continue each other's surface. */
    void findSurfaces();
    /** Sets the inverse ranges of all objects of one surface to those of the whole surface. */
    void joinExtents();
    /** Returns whether part of a ball may be in the sonar's reach. */
    bool reaches(const glm::dvec3& centre, double radius) const;

    const types::Geometry& geometry_;
    Reach reach_;
    bool all_;
    std::vector<std::shared_ptr<MeshFacts>> meshes_;
    std::vector<glm::dmat4> world_from_object_;
    std::vector<ObjectRecord> records_;
    std::vector<bool> far_, in_view_;
    std::vector<std::vector<size_t>> surfaces_;  ///< Each has two objects or more.
    std::vector<float> scratch_;
};

}  // namespace insonify::sonar
