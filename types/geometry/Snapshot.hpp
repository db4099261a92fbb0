#pragma once
#include <glm/mat4x3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "types/geometry/Geometry.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Transmission.hpp"

namespace insonify::types {

/** An object that is moved from its place in the geometry. */
struct MovedObject {
    uint32_t object = 0;  ///< Index into Geometry::objects [1].
    glm::dmat4 world_from_object{1};
    /** Rate of the matrix from an animation; absent: it follows from the snapshot before [1/s]. */
    std::optional<glm::dmat4> rate = {};
};

/** Pose of a joint of a skin. */
struct JointPose {
    glm::dmat4x3 mesh_from_bind{1};  ///< Moves a vertex that follows this joint alone, in the axes of the mesh.
    glm::dmat4x3 rate{0};            ///< [1/s]

    bool operator==(const JointPose&) const = default;
};

/** Weight of a morph target. */
struct MorphPose {
    double weight = 0;  ///< [1]
    double rate = 0;    ///< [1/s]

    bool operator==(const MorphPose&) const = default;
};

/** An object whose mesh has another shape than in the geometry (PosedMesh.hpp). */
struct DeformedObject {
    uint32_t object = 0;       ///< Index into Geometry::objects; its mesh has a Deformation [1].
    uint32_t first_joint = 0;  ///< Index of its first joint in Snapshot::joints [1].
    uint32_t first_morph = 0;  ///< Index of its first target in Snapshot::morphs [1].

    bool operator==(const DeformedObject&) const = default;
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
    /** Objects that this or a later snapshot may move, ascending, so that sonars need not take them out of the scene at
     *  rest when they do. Null: none known. */
    std::shared_ptr<const std::vector<uint32_t>> movable;
    std::vector<DeformedObject> deformed;  ///< Ascending by object, each at most once.
    std::vector<JointPose> joints;         ///< Joints or targets of all deformed objects.
    std::vector<MorphPose> morphs;         ///< Joints or targets of all deformed objects.
    std::vector<PointTarget> targets;
    std::vector<TransmissionPtr> transmissions;  ///< Pulses of other sonars that may reach this sonar; none is null.
    std::shared_ptr<const std::vector<std::string>> target_names;  ///< Names of `targets`; may be null without targets.
    std::optional<double> water_surface;                           ///< World z of the surface [m].
};
using SnapshotPtr = std::shared_ptr<const Snapshot>;

}  // namespace insonify::types
