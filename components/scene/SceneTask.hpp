#pragma once
#include <atomic>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/scene/Bathymetry.hpp"
#include "components/scene/Drawings.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/motion/Animator.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Notice.hpp"

namespace insonify::scene {

/** A configured point target, with its place for each node that may carry it. */
struct PlacedTarget {
    /** A moving node at or above the target's node. */
    struct Carrier {
        int node = -1;        ///< Index into Scene::nodes.
        glm::dvec3 place{0};  ///< In the axes of the node's body, as in Part::body_from_object [m].
    };
    glm::dvec3 in_world{0};         ///< Place before any node has moved [m].
    double strength_db = 0;         ///< [dB re 1 m^2]
    std::vector<Carrier> carriers;  ///< Inner nodes before outer nodes.
    int node = -1;                  ///< The target's node, -1 for none.
    glm::dvec3 offset{0};           ///< Place in the axes of that node, as in the configuration [m].
};

/** Places targets in a scene whose nodes `moving` move. Adds errors to `diagnostics` at paths `targets[0].attached_to`
 *  and `targets[0].geodetic`. @param datum the world's origin on the earth, which targets with latitudes need */
std::vector<PlacedTarget> placeTargets(const Scene& scene, const std::vector<TargetConfig>& targets,
                                       const std::vector<int>& moving, types::Diagnostics& diagnostics,
                                       const std::optional<types::Datum>& datum = {});

/** Holds a scene and publishes, for each pose of the vehicle, a snapshot of what the sonar has in front of it.
 *
 *  In: `pose`, body in the world (x north, y west, z up); each new one gives one `snapshot`, with its time.
 *  In: `<animation>.time` for any animation of the file that a connection names: time within the animation [s], in
 *  place of the time since the start of the run. The newest is taken; it does not trigger.
 *  In: `<node>.pose` for any node of the file (in SDF any model or link, "rov", "rov::arm") that a connection names:
 *  the node's place in the world, which replaces its translation and rotation in the file. Its axes are turned like
 *  the world's; its scale stays; nodes below it move along. The newest pose is taken; it does not trigger. Before the
 *  first pose the node is at its place in the file.
 *  Out: `snapshot`, with the sonar in the world (body times `mount`), shared geometry, moved objects, and point targets
 *  at their current places. A target on a node moves with the node.
 *
 *  A pose that is not finite, or whose orientation has zero length, is dropped; the task is in RunTimeError until the
 *  next valid pose. The task is also in RunTimeError, and writes no snapshot, when the newest pose of the body or of a
 *  connected node is older than `pose_timeout` by its stamp, or its stamp is as far ahead of the clock (at least 1 s).
 *  A run that ends in this state has not failed: the sender of the poses may have stopped. Waiting for the body's first
 *  pose is no error; it is reported once. The default timeout is 1 s in realtime on the wall clock, otherwise there is
 *  none.
 *
 *  With `extrapolate` the snapshot has the sonar's velocities, with which the sonar's task extrapolates the pose to the
 *  time of its ping. With `bathymetry` the geometry includes the floor around the sonar, and is replaced when more of
 *  it is read. */
class SceneTask final : public framework::TaskContext, public framework::Waits, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<SceneConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::SnapshotPtr> snapshot{this, "snapshot", "sonar, objects and geometry at one instant"};

    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Diagnostics& diagnostics) const override;
    types::Notices notices() const override;
    double wakeAfter() const override;
    std::string indivisible() const override;
    bool waits() const override { return is_stale_ && newest_came_; }
    /** Names objects that hide() may hide, as indices into Geometry::objects, so that sonars prepare for it. To be
     *  called before the first snapshot. */
    void setHideable(std::vector<uint32_t> objects);
    /** Hides these objects, and shows all others, from the next snapshot on: they are far below the world. */
    void hide(std::vector<uint32_t> objects) { hidden_ = std::move(objects); }
    /** Returns what of the scene is omitted, by the properties. */
    OmitRules omitRules() const;

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void cleanupHook() override;

    /** Returns why there is no usable pose, or an empty string if there is one. */
    std::string staleness() const;
    /** Handles a missing pose: reports once that the task waits for the first one, or enters the error state. */
    void lackPose(const std::string& why);
    double poseTimeout() const;  ///< [s]; infinite: none.

    /** A node that follows a port. */
    struct Movable {
        std::unique_ptr<framework::InputPort<types::Pose>> port;
        std::string node_name;
        int node = -1;  ///< Index into Scene::nodes.
        std::vector<Part> parts;
        std::optional<glm::dmat4> world_from_body;  ///< None before its first pose.
        types::Time newest;                         ///< Stamp of that pose; the start time before the first.
        types::Time arrived;                        ///< When that pose came; the start before the first.
        glm::dmat4 rate{0};                         ///< Rate of world_from_body, by the pose or the one before [1/s].
    };
    /** An animation that follows a port. */
    struct Timed {
        std::unique_ptr<framework::InputPort<double>> port;
        std::string animation;
        std::optional<double> newest;  ///< [s]; none before the first.
        types::Time taken;             ///< Stamp of the snapshot that had it first.
    };

    std::shared_ptr<const Scene> load() const;
    /** Returns the models of the file or of Gazebo, placed and scaled; null if neither is configured. */
    std::shared_ptr<const Scene> loadModels() const;
    /** Returns what of the models is omitted. */
    /** Loads the scene again if Gazebo has not answered before. */
    std::shared_ptr<const Scene> loadToRun();
    std::string layText(const Scene& scene) const;
    types::Notices describePlacement(const Scene& scene) const;
    std::unique_ptr<Bathymetry> openSurvey() const;  ///< Null without one.
    /** Returns the configured materials with their tables read. Adds errors to `diagnostics`. */
    std::map<std::string, Acoustics> materials(types::Diagnostics& diagnostics) const;
    void warnAboveWater(double z);
    bool readMovables();
    void placeTargets(const Scene& scene, types::Diagnostics& diagnostics);
    void addMoved(std::vector<types::MovedObject>& moved);
    void addHidden(std::vector<types::MovedObject>& moved) const;
    /** Returns the objects that movables or hide() move, ascending; null: there are none. */
    std::shared_ptr<const std::vector<uint32_t>> getMovableObjects() const;
    void addTargets(std::vector<types::PointTarget>& targets) const;
    const Movable* findMovable(int node) const;
    framework::InputPortBase* makeTimeInput(const std::string& port);
    void makeAnimator(const std::shared_ptr<const Scene>& scene, types::Diagnostics& diagnostics);
    void animate(types::Time time);
    void readTimes(types::Time time);

    mutable std::shared_ptr<const Scene> scene_;  ///< Read once for check, ports and configure.
    mutable std::shared_ptr<const Scene> read_;   ///< As read: while it lives, tasks of one file share its meshes.
    mutable std::string scene_file_;
    mutable std::optional<GazeboConfig> scene_gazebo_;
    mutable std::optional<types::ConfigError>
        gazebo_failure_;  ///< Why scene_gazebo_ could not be loaded. It is kept because asking again would wait again.
    mutable std::optional<Placement> scene_placement_;
    mutable std::map<std::string, double> scene_scale_;
    mutable OmitRules scene_rules_;
    types::Notices placement_notices_;               ///< How the scene is oriented, and questions about its file.
    mutable bool scene_has_survey_ = false;          ///< Whether scene_ has the floor's material.
    mutable std::optional<MosaicConfig> scene_map_;  ///< The mosaic whose classes are among the materials of scene_.
    types::GeometryPtr geometry_;                    ///< From file or gazebo, with all materials.
    std::unique_ptr<Bathymetry> bathymetry_;
    std::vector<Movable> movables_;  ///< Outer nodes before inner nodes, once configured.
    size_t part_count_ = 0;          ///< Parts of all movables; their memory is allocated before they move.
    std::shared_ptr<const std::vector<uint32_t>> movable_objects_;  ///< Null: no port moves an object.
    std::vector<uint32_t> hideable_, hidden_;                       ///< See hide().
    std::vector<const Movable*> mover_;                             ///< For each object, the movable that moves it now.
    std::unique_ptr<Animator> animator_;                            ///< Null: nothing moves by itself, nor is deformed.
    std::vector<Timed> timed_;
    std::vector<DrivenNode> driven_;  ///< One per movable, for the animator.
    std::vector<PlacedTarget> targets_;
    std::shared_ptr<const std::vector<std::string>> target_names_;
    framework::SamplePool<types::Snapshot> pool_;
    types::Time newest_;                      ///< Stamp of the newest usable pose; the start before the first.
    types::Time arrived_;                     ///< When that pose came; the start before the first.
    types::RecurringDiagnostic odd_lengths_;  ///< Reports quaternions of the body that are not of unit length.
    types::RecurringDiagnostic above_water_;  ///< Reports sonars above the water surface.
    bool newest_came_ = false;                ///< A pose of the body has come since the start.
    bool waiting_is_reported_ = false;        ///< Whether waiting for the first pose has been reported.
    std::atomic<bool> is_stale_ = false;      ///< In error because no pose came, not because a pose was invalid.
};

/** Registers the tasks of this folder for deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::scene
