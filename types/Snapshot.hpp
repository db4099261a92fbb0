#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "types/Geometry.hpp"
#include "types/Pose.hpp"

namespace insonify::types {

/** An object that is not where the geometry put it. */
struct MovedObject {
    uint32_t object = 0;  ///< Index into Geometry::objects [1].
    glm::dmat4 world_from_object{1};
};

/** Everything that one ping needs, true at one instant. */
struct Snapshot {
    static constexpr const char* type_name = "/insonify/Snapshot";

    Time time;
    Pose sonar;  ///< Sonar frame in the world: x ahead, y port, z up.
    double max_extrapolation =
        0;  ///< How far `sonar` may be carried on by its velocities, to the time of the ping [s].
    GeometryPtr geometry;
    std::vector<MovedObject> moved;
    std::optional<double> water_surface;  ///< World z of the surface [m].
};
using SnapshotPtr = std::shared_ptr<const Snapshot>;

}  // namespace insonify::types
