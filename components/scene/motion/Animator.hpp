#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/scene/Scene.hpp"
#include "components/scene/motion/Animation.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/text/Describe.hpp"

namespace insonify::scene {

/** Playback of one animation. */
struct AnimationConfig {
    bool play = true;
    double start_s = 0;
    double speed = 1;
    bool loop = true;

    static void describe(auto& self, auto& visit) {
        visit({"play", "", "false: not played"}, self.play);
        visit({"start_s", "s", "time within the animation at the start of the run", -1e6, 1e6}, self.start_s);
        visit({"speed", "1", "seconds of the animation per second of the run; below 0: backwards", -1e3, 1e3},
              self.speed);
        visit({"loop", "", "false: plays once and stays at its end"}, self.loop);
    }
};
using AnimationConfigs = std::map<std::string, AnimationConfig>;

/** Places of the nodes of a scene in the world, with their rates. */
struct NodePlaces {
    std::vector<glm::dmat4> world_from_node;
    std::vector<glm::dmat4> rate;  ///< [1/s]
};

/** Appends the poses of an object's joints.
 *  @param node  node of the object's mesh; joints are in its axes */
void appendJoints(const DeformingObject& object, int node, const NodePlaces& places,
                  std::vector<types::JointPose>& joints);

/** Poses a mesh by nodes at rest and default weights. */
void poseAtRest(const DeformingObject& object, int node, const NodePlaces& places, types::Mesh& mesh);

/** A node that a port moves, with its place from the newest pose. */
struct DrivenNode {
    int node = 0;  ///< Index into Scene::nodes.
    std::optional<glm::dmat4> world_from_node = {};
    glm::dmat4 rate{0};  ///< [1/s]
};

/** Plays the animations of a scene. Deforms the meshes whose joints are moved by animations or ports, and those whose
 *  morph weights are animated. */
class Animator {
public:
    /** Adds unknown names in `configs` to `diagnostics` as `animations.<name>`; "*" matches all animations without a
     *  block of their own.
     *  @param driven  nodes that ports may move */
    Animator(std::shared_ptr<const Scene> scene, const AnimationConfigs& configs, const std::vector<int>& driven,
             types::Diagnostics& diagnostics);

    /** Returns whether no animation plays and no mesh deforms. */
    bool isIdle() const { return tracks_.empty() && live_.empty(); }
    /** Returns the animations that play, and those omitted because another animation moves the same property. */
    const types::Notices& notices() const { return notices_; }

    /** Sets the time within an animation; it no longer follows the time of the run.
     *  @param rate  seconds of the animation per second of the run */
    void setTime(const std::string& animation, double time, double rate);
    /** Makes all animations follow the time of the run again. */
    void forgetTimes();
    /** Computes the shape of the scene at a time after the start of the run [s]. Allocates nothing after the first
     * call.
     */
    void take(double seconds, const std::vector<DrivenNode>& driven);

    /** Returns whether an animation moves the node itself, or a node above it with no driven node between. */
    bool isAnimated(int node) const { return animated_[static_cast<size_t>(node)]; }
    /** Returns the place of a point of a node in the world, like getPlace() [m]. */
    glm::dvec3 getPlace(int node, const glm::dvec3& point) const;
    /** Adds the objects that animations move; replaces entries for the same objects. */
    void addMoved(std::vector<types::MovedObject>& moved) const;
    /** Adds the objects that are deformed. */
    void addDeformed(types::Snapshot& snapshot) const;

private:
    /** An animation that plays. */
    struct Playing {
        const Animation* animation;
        AnimationConfig config;
        std::optional<double> time = {};  ///< Set by a port.
        double rate = 0;                  ///< Rate of `time` [1].
    };
    /** A channel that plays. */
    struct Track {
        size_t playing;
        const KeyFrames* keys;
        int node;
        AnimatedPath path;
        size_t slot;  ///< Index of the node in Animations::nodes.
    };
    /** A deforming object whose shape changes. */
    struct Live {
        const DeformingObject* object;
        std::vector<types::MorphPose> morphs;
    };
    AnimationConfig getConfig(const std::string& name, const AnimationConfigs& configs) const;
    void addTracks(const AnimationConfigs& configs);
    void findMovers(const std::vector<int>& driven);
    void findLive();
    std::vector<int> movers(int node) const;
    void applyTracks(double seconds);
    void applyNodes(const std::vector<DrivenNode>& driven);
    int getNode(const DeformingObject& object) const { return scene_->object_nodes[object.object]; }

    std::shared_ptr<const Scene> scene_;
    std::vector<Playing> playing_;
    std::vector<Track> tracks_;
    std::vector<Live> live_;
    types::Notices notices_;
    std::vector<bool> is_mover_;             ///< Whether an animation or a port may move each node.
    std::vector<int> involved_;              ///< Movers and all nodes below them, parents first.
    std::vector<int> slots_;                 ///< Index of each node in Animations::nodes, -1 without a track.
    std::vector<NodeShape> shapes_;          ///< One per Animations::nodes.
    std::vector<bool> animated_;             ///< isAnimated() of each node.
    std::vector<const DrivenNode*> driven_;  ///< One per node; null: no pose yet.
    std::vector<double> value_, rate_;       ///< Scratch.
    NodePlaces places_;
};

}  // namespace insonify::scene
