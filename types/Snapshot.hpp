#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "types/Geometry.hpp"
#include "types/Pose.hpp"
#include "types/Transmission.hpp"

namespace insonify::types {

/** An object that is moved from its place in the geometry. */
struct MovedObject {
    uint32_t object = 0;  ///< Index into Geometry::objects [1].
    glm::dmat4 world_from_object{1};
};

/** A target with an echo that is too small to be resolved. */
struct PointTarget {
    glm::dvec3 position{0};  ///< In the world [m].
    double strength_db = 0;  ///< Target strength [dB re 1 m^2].
};

/** Everything that one ping needs, true at one instant. */
struct Snapshot {
    static constexpr const char* type_name = "/insonify/Snapshot";
    static constexpr bool shared = true;

    Time time;
    Pose sonar;  ///< Sonar frame in the world: x ahead, y port, z up.
    double max_extrapolation =
        0;  ///< Max time for which the pose `sonar` may be extrapolated by its velocities, to the time of the ping [s].
    GeometryPtr geometry;
    /** Meshes that later geometries may have, so that their data can be prepared. Null: none known. */
    std::shared_ptr<const std::vector<MeshPtr>> ahead;
    std::vector<MovedObject> moved;
    std::vector<PointTarget> targets;
    std::vector<TransmissionPtr> transmissions;  ///< Pulses of other sonars that may reach this sonar; none is null.
    std::shared_ptr<const std::vector<std::string>> target_names;  ///< Names of `targets`; may be null without targets.
    std::optional<double> water_surface;                           ///< World z of the surface [m].
};
using SnapshotPtr = std::shared_ptr<const Snapshot>;

}  // namespace insonify::types
