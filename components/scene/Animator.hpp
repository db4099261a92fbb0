#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/scene/Animation.hpp"
#include "components/scene/Scene.hpp"
#include "types/Describe.hpp"
#include "types/Snapshot.hpp"

namespace insonify::scene {

/** How one animation plays. */
struct AnimationConfig {
    bool play = true;
    double start_s = 0;
    double speed = 1;
    bool loop = true;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"play", "", "false: it is not played"}, self.play);
        visit(Field{"start_s", "s", "time within the animation at the start of the run", -1e6, 1e6}, self.start_s);
        visit(Field{"speed", "1", "seconds of the animation per second of the run; below 0: backwards", -1e3, 1e3},
              self.speed);
        visit(Field{"loop", "", "false: it stays at its end once it is there"}, self.loop);
    }
};
using AnimationConfigs = std::map<std::string, AnimationConfig>;

/** Where the nodes of a scene are in the world, and how fast that changes. */
struct NodePlaces {
    std::vector<glm::dmat4> world_from_node;
    std::vector<glm::dmat4> rate;  ///< [1/s]
};

/** Appends the poses of an object's joints.
 *  @param node  node of the object's mesh, in whose axes the joints are */
void appendJoints(const DeformingObject& object, int node, const NodePlaces& places,
                  std::vector<types::JointPose>& joints);

/** Gives a mesh the shape that nodes at rest and default weights give it. */
void poseAtRest(const DeformingObject& object, int node, const NodePlaces& places, types::Mesh& mesh);

/** A node that a port moves, and where it is by its newest pose. */
struct DrivenNode {
    int node = 0;  ///< Index into Scene::nodes.
    std::optional<glm::dmat4> world_from_node = {};
    glm::dmat4 rate{0};  ///< [1/s]
};

/** Plays the animations of a scene, and deforms meshes with skins and morph targets: those whose joints animations or
 *  ports move, and those whose weights are animated. */
class Animator {
public:
    /** Unknown names in `configs` are added to `diagnostics` as `animations.<name>`; "*" stands for all that have no
     *  block of their own.
     *  @param driven  nodes that ports may move */
    Animator(std::shared_ptr<const Scene> scene, const AnimationConfigs& configs, const std::vector<int>& driven,
             types::Diagnostics& diagnostics);

    /** Whether nothing ever moves by an animation, nor is deformed. */
    bool isIdle() const { return tracks_.empty() && live_.empty(); }
    /** What plays, and what does not for another animation moves the same. */
    const std::vector<std::string>& notices() const { return notices_; }

    /** Sets the time within an animation from now on, in place of the time of the run.
     *  @param rate  seconds of the animation per second of the run */
    void setTime(const std::string& animation, double time, double rate);
    /** All animations follow the time of the run again. */
    void forgetTimes();
    /** Takes the shape of the scene at a time after the start of the run [s]. Allocates nothing after the first call.
     */
    void take(double seconds, const std::vector<DrivenNode>& driven);

    /** Whether an animation moves a node: one of its own, or of a node above it that is not above a driven one. */
    bool isAnimated(int node) const { return animated_[static_cast<size_t>(node)]; }
    /** Where a point of a node is in the world, as placeOf() has it [m]. */
    glm::dvec3 placeOf(int node, const glm::dvec3& point) const;
    /** Adds the objects that animations move, in place of entries for the same objects. */
    void addMoved(std::vector<types::MovedObject>& moved) const;
    /** Adds the objects that are deformed. */
    void addDeformed(types::Snapshot& snapshot) const;

private:
    /** An animation that is played. */
    struct Playing {
        const Animation* animation;
        AnimationConfig config;
        std::optional<double> time = {};  ///< By a port.
        double rate = 0;                  ///< Of that time.
    };
    /** A channel that is played. */
    struct Track {
        size_t playing;
        const KeyFrames* keys;
        int node;
        AnimatedPath path;
        size_t slot;  ///< Of the node in Animations::nodes.
    };
    /** A deforming object whose shape changes. */
    struct Live {
        const DeformingObject* object;
        std::vector<types::MorphPose> morphs;
    };
    AnimationConfig configOf(const std::string& name, const AnimationConfigs& configs) const;
    void addTracks(const AnimationConfigs& configs);
    void findMovers(const std::vector<int>& driven);
    void findLive();
    std::vector<int> moversOf(int node) const;
    void takeTracks(double seconds);
    void takeNodes(const std::vector<DrivenNode>& driven);
    int nodeOf(const DeformingObject& object) const { return scene_->object_nodes[object.object]; }

    std::shared_ptr<const Scene> scene_;
    std::vector<Playing> playing_;
    std::vector<Track> tracks_;
    std::vector<Live> live_;
    std::vector<std::string> notices_;
    std::vector<bool> is_mover_;     ///< Of each node: an animation or a port may move it.
    std::vector<int> involved_;      ///< Movers and all nodes below them, parents first.
    std::vector<int> slots_;         ///< Of each node its place in Animations::nodes, -1 where no track moves it.
    std::vector<NodeShape> shapes_;  ///< Of Animations::nodes.
    std::vector<bool> animated_;     ///< Of each node, isAnimated().
    std::vector<const DrivenNode*> driven_;  ///< Of each node; null: no pose has come.
    std::vector<double> value_, rate_;       ///< Scratch.
    NodePlaces places_;
};

}  // namespace insonify::scene
