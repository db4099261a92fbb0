#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "types/Geometry.hpp"
#include "types/Pose.hpp"
#include "types/Transmission.hpp"

namespace insonify::types {

/** An object that is not where the geometry put it. */
struct MovedObject {
    uint32_t object = 0;  ///< Index into Geometry::objects [1].
    glm::dmat4 world_from_object{1};
};

/** What gives an echo and is too small to be resolved. */
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
        0;  ///< How far `sonar` may be carried on by its velocities, to the time of the ping [s].
    GeometryPtr geometry;
    /** Meshes that later geometries may have: what takes long to make of them may be made before. Null: none known. */
    std::shared_ptr<const std::vector<MeshPtr>> ahead;
    std::vector<MovedObject> moved;
    std::vector<PointTarget> targets;
    std::vector<TransmissionPtr> transmissions;  ///< Pulses of other sonars that this one may hear; none is null.
    std::shared_ptr<const std::vector<std::string>> target_names;  ///< Of each of `targets`; may be null without any.
    std::optional<double> water_surface;                           ///< World z of the surface [m].
};
using SnapshotPtr = std::shared_ptr<const Snapshot>;

}  // namespace insonify::types
