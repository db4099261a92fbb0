#pragma once
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "components/sonar/places/MeshFacts.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** How a body moves, turns and is deformed: the velocity of each of its places. */
struct Drift {
    glm::dmat3 linear{0};    ///< [1/s]
    glm::dvec3 constant{0};  ///< [m/s]
    double fastest = 0;      ///< Of any of its places [m/s].

    glm::dvec3 at(const glm::dvec3& place) const { return linear * place + constant; }
};

/** Tells from one ping to the next how sonar, objects and point targets move: by the velocities of the sonar's pose
 *  where it has them, else by where they were in the snapshot before. Nothing moves in the first ping that has no
 *  velocities. */
class Motion {
public:
    /** What seems to move faster than `fastest` [m/s] has been put elsewhere, and is taken to be at rest. */
    Motion(const types::Geometry& geometry, double fastest);

    /** Another geometry from the next ping on. Objects are the same ones where they have the same numbers, meshes and
     *  names; the others are at rest at first. */
    void takeScene(const types::Geometry& geometry);
    /** Once a ping; several of one time are one. Allocates nothing after the second. */
    void follow(const types::Snapshot& snapshot);

    const glm::dvec3& velocity() const { return velocity_; }  ///< Of the sonar, in the world [m/s].
    const glm::dvec3& turn() const { return turn_; }          ///< Its angular velocity, in the world [rad/s].
    /** Of an object about the sonar, sonar axes; null where it is at rest. Of one that deforms, the mean of its places.
     */
    const Drift* drift(uint32_t object) const { return drifts_[object] ? &*drifts_[object] : nullptr; }
    /** The same of one triangle of an object; `own` is filled where the object deforms. */
    const Drift* driftOf(uint32_t object, uint32_t triangle, Drift& own) const;
    /** Of a point target, in the world [m/s]. */
    glm::dvec3 targetVelocity(size_t target) const;
    /** The greatest of the velocities of objects and targets [m/s]. */
    double fastest() const { return fastest_; }

private:
    /** What counts of a snapshot. */
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
    /** What counts of an object. */
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
    std::vector<glm::dmat4> places_;  ///< Of each object in the geometry.
    std::optional<Mark> before_, now_;
    double fastest_allowed_;  ///< [m/s]
    double seconds_ = 0;      ///< Between the two.
    glm::dvec3 velocity_{0}, turn_{0};
    std::vector<std::optional<Drift>> drifts_;
    std::vector<std::shared_ptr<Deforming>> deforming_;  ///< Of each object; null: it keeps its shape.
    std::vector<glm::vec3> of_vertices_;                 ///< Scratch.
    double fastest_ = 0;
};

/** The angular velocity that turns one orientation into another in so many seconds, the shorter way, in the frame that
 *  both turn into [rad/s]. */
glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to, double seconds);

}  // namespace insonify::sonar
