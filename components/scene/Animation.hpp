#pragma once
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace insonify::scene {

/** What an animation changes of a node. */
enum class AnimatedPath { Translation, Rotation, Scale, Weights };

/** How values between two keys follow from the keys. */
enum class Interpolation { Step, Linear, CubicSpline };

/** Keys of an animation: values over time, as glTF 2.0 has them (appendix C). */
struct KeyFrames {
    Interpolation interpolation = Interpolation::Linear;
    bool is_rotation = false;   ///< Values are unit quaternions x, y, z, w.
    size_t width = 3;           ///< Numbers of a value [1].
    std::vector<double> times;  ///< Ascending, at least one [s].
    /** Value after value; of a cubic spline three a key: the tangent before it, the value, the tangent behind it. */
    std::vector<double> values;

    /** Fills in the value at a time, and its rate [1/s]. Before the first key and after the last their values stay. */
    void at(double time, std::span<double> value, std::span<double> rate) const;
};

/** Translation, rotation and scale of a node, and how fast they change. */
struct NodeShape {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    glm::dvec3 translation_rate{0};        ///< [1/s]
    glm::dquat rotation_rate{0, 0, 0, 0};  ///< [1/s]
    glm::dvec3 scale_rate{0};              ///< [1/s]

    glm::dmat4 matrix() const;
    glm::dmat4 matrixRate() const;  ///< [1/s]
};

/** What one animation does to one property of one node. */
struct Channel {
    int node = 0;  ///< Index into Scene::nodes.
    AnimatedPath path = AnimatedPath::Translation;
    size_t keys = 0;  ///< Index into Animation::keys.
};

/** An animation of a file. */
struct Animation {
    std::string name;  ///< Unique: the file's, else "animation_3".
    std::vector<KeyFrames> keys;
    std::vector<Channel> channels;
    double duration = 0;  ///< Time of the last key of all channels [s].
};

/** A node that animations may move. `Node::parent_from_node` is before * rest.matrix() * after. */
struct AnimatedNode {
    int node = 0;          ///< Index into Scene::nodes.
    glm::dmat4 before{1};  ///< Placement and turn to z-up of a node at the root.
    NodeShape rest;
    glm::dmat4 after{1};  ///< Scale by the configuration.
};

/** An object whose mesh has a types::Deformation. */
struct DeformingObject {
    size_t object = 0;                        ///< Index into Geometry::objects.
    std::vector<int> joints;                  ///< Indices into Scene::nodes; empty without a skin.
    std::vector<glm::dmat4> joint_from_bind;  ///< Of each joint.
    std::vector<double> rest_weights;         ///< Of each morph target, where no animation has another [1].
};

/** All of a scene that moves by itself, or may be deformed. */
struct Animations {
    std::vector<Animation> all;            ///< In the order of the file.
    std::vector<AnimatedNode> nodes;       ///< Ascending.
    std::vector<DeformingObject> objects;  ///< Ascending.

    bool empty() const { return all.empty() && objects.empty(); }
};

}  // namespace insonify::scene
