#pragma once
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** Motion, rotation and deformation of a body: the velocity of each of its points. */
struct Drift {
    glm::dmat3 linear{0};    ///< [1/s]
    glm::dvec3 constant{0};  ///< [m/s]
    double fastest = 0;      ///< Max speed of its points [m/s].

    glm::dvec3 at(const glm::dvec3& place) const { return linear * place + constant; }
};

/** Derives the motion of sonar, objects and point targets from ping to ping. It uses the velocities in the sonar's pose
 *  where it has them, else the snapshot before. Without velocities nothing moves in the first ping. */
class Motion {
public:
    /** Anything that seems to move faster than `fastest` [m/s] counts as repositioned and at rest. */
    Motion(const types::Geometry& geometry, double fastest);

    /** Switches to another geometry from the next ping on. Objects with the same number, mesh and name are the same
     *  object. Other objects are at rest at first. */
    void setScene(const types::Geometry& geometry);
    /** Updates the motion once per ping; several calls for one time count as one. Allocates nothing after the second
     *  ping. */
    void follow(const types::Snapshot& snapshot);

    const glm::dvec3& velocity() const { return velocity_; }  ///< Velocity of the sonar, in the world [m/s].
    const glm::dvec3& turn() const { return turn_; }          ///< Its angular velocity, in the world [rad/s].
    /** Returns the motion of an object in the world, about the sonar, in sonar axes; null where it is at rest.
     *  If the object deforms: the mean motion of its vertices. */
    const Drift* drift(uint32_t object) const { return drifts_[object] ? &*drifts_[object] : nullptr; }
    /** Returns the motion of one triangle of an object; fills `own` if the object deforms. */
    const Drift* findDrift(uint32_t object, uint32_t triangle, Drift& own) const;
    /** Returns the velocity of a point target, in the world [m/s]. */
    glm::dvec3 targetVelocity(size_t target) const;
    /** Returns the max speed of objects and targets [m/s]. */
    double fastest() const { return fastest_; }
    /** Returns an upper bound of the angular velocities, and other gradients of velocity, of all objects [1/s]. */
    double steepest() const { return steepest_; }

private:
    /** The part of a snapshot that matters for motion. */
    struct Mark {
        types::Pose sonar;
        std::vector<types::MovedObject> moved;
        std::vector<types::PointTarget> targets;
    };
    /** An object that deforms: its vertices about the sonar, sonar axes. */
    struct Deforming {
        std::vector<glm::dvec3> places;      ///< [m]
        std::vector<glm::dvec3> velocities;  ///< [m/s]
        types::MeshPtr mesh;
        bool moves = false;  ///< In this ping.
    };
    /** Identity of an object. */
    struct Thing {
        std::string name;
        types::MeshPtr shape;
        std::shared_ptr<MeshFacts> mesh;
        bool operator==(const Thing&) const = default;
    };
    void followSonar(const types::Snapshot& snapshot);
    void followObjects(const types::Snapshot& snapshot);
    void addDrift(const types::Pose& sonar, const types::MovedObject& now, const glm::dmat4& rate);
    void followShapes(const types::Snapshot& snapshot);
    void addShape(const types::Snapshot& snapshot, const types::DeformedObject& deformed);

    std::vector<Thing> things_;       ///< Each object.
    std::vector<glm::dmat4> places_;  ///< One per object in the geometry.
    std::optional<Mark> before_, now_;
    double fastest_allowed_;  ///< [m/s]
    double seconds_ = 0;      ///< Between `before_` and `now_` [s].
    glm::dvec3 velocity_{0}, turn_{0};
    std::vector<std::optional<Drift>> drifts_;
    std::vector<std::shared_ptr<Deforming>> deforming_;  ///< One per object; null: rigid.
    std::vector<glm::vec3> of_vertices_;                 ///< Scratch.
    double fastest_ = 0, steepest_ = 0;
};

/** Returns the angular velocity that turns one orientation into another in `seconds`, the shorter way, in the frame
 *  that both turn into [rad/s]. */
glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to, double seconds);

}  // namespace insonify::sonar
