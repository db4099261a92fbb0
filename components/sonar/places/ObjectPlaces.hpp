#pragma once
#include <limits>
#include <numbers>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/places/MeshFacts.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** What of space a sonar hears, ahead of it and to as much on either side. */
struct Reach {
    double range_max = std::numeric_limits<double>::infinity();  ///< [m]
    double half_azimuth = std::numbers::pi;                      ///< [rad]
    double half_elevation = std::numbers::pi / 2;                ///< [rad]
};
Reach reachOf(const RenderPlan& plan);

/** Where the objects of a scene stand about the sonar in this ping. */
class ObjectPlaces {
public:
    /** `geometry` must outlive it. `all`: what is out of range is placed as well. */
    ObjectPlaces(const types::Geometry& geometry, const Reach& reach, bool all);

    /** Once a ping. */
    void place(const types::Snapshot& snapshot);
    const std::vector<ObjectRecord>& records() const { return records_; }
    /** Out of range and not placed: its record is not of this ping. */
    bool isFar(size_t object) const { return far_[object]; }
    /** Of an object's mesh, in its coordinates. */
    const Box& box(size_t object) const { return meshes_[meshOf(object)]->box(); }

private:
    size_t meshOf(size_t object) const { return static_cast<size_t>(geometry_.objects[object].mesh); }
    void placeObject(size_t index, const glm::dmat4& sonar_from_object);
    vec4 extent(size_t index, const glm::dmat4& sonar_from_object, bool in_view);
    /** Finds the objects that continue each other's surface. */
    void findSurfaces();
    /** Gives the objects of one surface the inverse ranges of the whole surface. */
    void joinExtents();
    /** Whether any of a ball may be heard. */
    bool reaches(const glm::dvec3& centre, double radius) const;

    const types::Geometry& geometry_;
    Reach reach_;
    bool all_;
    std::vector<std::shared_ptr<MeshFacts>> meshes_;
    std::vector<glm::dmat4> world_from_object_;
    std::vector<ObjectRecord> records_;
    std::vector<bool> far_, in_view_;
    std::vector<std::vector<size_t>> surfaces_;  ///< Each of two objects or more.
    std::vector<float> scratch_;
};

}  // namespace insonify::sonar
