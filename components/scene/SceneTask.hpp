#pragma once
#include <atomic>
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
#include "components/scene/Animator.hpp"
#include "components/scene/Bathymetry.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/Targets.hpp"
#include "types/ConfigError.hpp"
#include "types/RecurringDiagnostic.hpp"
#include "types/Snapshot.hpp"

namespace insonify::scene {

/** Holds a scene and says, for each pose of the vehicle, what the sonar has before it.
 *
 *  In: `pose`, body in the world (x north, y west, z up); each new one gives one `snapshot`, with its time.
 *  In: `<animation>.time` for any animation of the file that a connection names: time within the animation [s], in
 *  place of the time since the start of the run. The newest is taken; it does not trigger.
 *  In: `<node>.pose` for any node of the file (in SDF any model or link, "rov", "rov::arm") that a connection names:
 *  the node's place in the world, instead of its translation and rotation in the file; axes turned like the world's,
 *  scale kept, nodes below move along. The newest is taken; it does not trigger. Before the first the node is where the
 *  file has it. Out: `snapshot`, sonar in the world (body times `mount`), shared geometry, moved objects,
 *  point targets where they are by then: one on a node moves with it.
 *
 *  A pose that is not finite, or whose orientation has no length, is dropped: RunTimeError until the next good one. So
 *  it is when no pose of the body, or of a node that a connection names, comes for `pose_timeout`, by their stamps, or
 *  one comes that is as old or far ahead of the clock: there is no snapshot then. A run that ends so has not failed:
 *  who sent the poses may have gone home. Waiting for the body's first pose is no error: it is told once. In realtime
 * on the wall clock a timeout that is not given is 1 s; otherwise there is none. With `extrapolate` the snapshot has
 * the sonar's velocities, by which the sonar's task carries it on to its ping. With `bathymetry` the geometry has the
 *  floor about the sonar, and is another one each time that more of it is read. */
class SceneTask final : public framework::TaskContext, public framework::Waits, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<SceneConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::SnapshotPtr> snapshot{this, "snapshot", "sonar, objects and geometry at one instant"};

    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Diagnostics& diagnostics) const override;
    std::vector<std::string> notices() const override;
    double wakeAfter() const override;
    std::string indivisible() const override;
    bool waits() const override { return is_stale_ && newest_came_; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void cleanupHook() override;

    /** Why there is no pose to go by, empty when there is one. */
    std::string staleness() const;
    /** Without a pose of late: tells that it waits for the first, or is in error. */
    void lackPose(const std::string& why);
    double poseTimeout() const;  ///< [s]; infinite: none.

    /** A node that follows a port. */
    struct Movable {
        std::unique_ptr<framework::InputPort<types::Pose>> port;
        std::string node_name;
        int node = -1;  ///< Index into Scene::nodes.
        std::vector<Part> parts;
        std::optional<glm::dmat4> world_from_body;  ///< None before its first pose.
        types::Time newest;                         ///< Stamp of that pose; the start before the first.
        types::Time arrived;                        ///< When that pose came; the start before the first.
        glm::dmat4 rate{0};                         ///< Of world_from_body, by the pose or the one before [1/s].
    };
    /** An animation that follows a port. */
    struct Timed {
        std::unique_ptr<framework::InputPort<double>> port;
        std::string animation;
        std::optional<double> newest;  ///< [s]; none before the first.
        types::Time taken;             ///< Stamp of the snapshot that had it first.
    };

    std::shared_ptr<const Scene> load() const;
    /** What file or Gazebo have, placed and scaled; null without them. */
    std::shared_ptr<const Scene> loadModels() const;
    /** Asks Gazebo anew where it has not answered before. */
    std::shared_ptr<const Scene> loadToRun();
    std::string layText(const Scene& scene) const;
    std::unique_ptr<Bathymetry> openSurvey() const;  ///< Null without one.
    /** Those of the configuration, their tables read; what is wrong with them goes to `diagnostics`. */
    std::map<std::string, Acoustics> materials(types::Diagnostics& diagnostics) const;
    bool readMovables();
    void placeTargets(const Scene& scene, types::Diagnostics& diagnostics);
    void addMoved(std::vector<types::MovedObject>& moved);
    void addTargets(std::vector<types::PointTarget>& targets) const;
    const Movable* movableOf(int node) const;
    framework::InputPortBase* makeTimeInput(const std::string& port);
    void makeAnimator(const std::shared_ptr<const Scene>& scene, types::Diagnostics& diagnostics);
    void animate(types::Time time);
    void readTimes(types::Time time);

    mutable std::shared_ptr<const Scene> scene_;  ///< Read once for check, ports and configure.
    mutable std::string scene_file_;
    mutable std::optional<GazeboConfig> scene_gazebo_;
    mutable std::optional<types::ConfigError>
        gazebo_failure_;  ///< Why scene_gazebo_ is not there; kept, for it has cost a wait.
    mutable std::optional<Placement> scene_placement_;
    mutable std::map<std::string, double> scene_scale_;
    std::string lay_;                                ///< How the scene lies; empty: as everywhere.
    mutable bool scene_has_survey_ = false;          ///< Whether the floor's material is in it.
    mutable std::optional<MosaicConfig> scene_map_;  ///< The classes of its mosaic are among the materials.
    types::GeometryPtr geometry_;                    ///< From file or gazebo, with all materials.
    std::unique_ptr<Bathymetry> bathymetry_;
    std::vector<Movable> movables_;       ///< Outer nodes before inner ones, once configured.
    size_t part_count_ = 0;               ///< Of all movables, room for which is made before they move.
    std::vector<const Movable*> mover_;   ///< For each object, who moves it now.
    std::unique_ptr<Animator> animator_;  ///< Null: nothing moves by itself, nor is deformed.
    std::vector<Timed> timed_;
    std::vector<DrivenNode> driven_;  ///< Of each movable, for the animator.
    std::vector<PlacedTarget> targets_;
    std::shared_ptr<const std::vector<std::string>> target_names_;
    framework::SamplePool<types::Snapshot> pool_;
    types::Time newest_;                      ///< Stamp of the newest usable pose; the start before the first.
    types::Time arrived_;                     ///< When that pose came; the start before the first.
    types::RecurringDiagnostic odd_lengths_;  ///< Of the body's quaternions.
    bool newest_came_ = false;                ///< A pose of the body has come since the start.
    bool waiting_is_told_ = false;            ///< That none has.
    std::atomic<bool> is_stale_ = false;      ///< In error for want of poses, not for what is wrong with one.
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::scene
