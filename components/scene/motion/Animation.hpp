#pragma once
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace insonify::scene {

/** Properties of a node that an animation changes. */
enum class AnimatedPath { Translation, Rotation, Scale, Weights };

/** Rule for the values between two keys. */
enum class Interpolation { Step, Linear, CubicSpline };

/** Keys of an animation: values over time (glTF 2.0, appendix C). */
struct KeyFrames {
    Interpolation interpolation = Interpolation::Linear;
    bool is_rotation = false;   ///< Values are unit quaternions x, y, z, w.
    size_t width = 3;           ///< Numbers of a value [1].
    std::vector<double> times;  ///< Ascending, at least one [s].
    /** Values in sequence. A cubic spline has three per key: in-tangent, value, out-tangent. */
    std::vector<double> values;

    /** Fills in the value at a time, and its rate [1/s]. Before the first key and after the last the value is constant.
     */
    void at(double time, std::span<double> value, std::span<double> rate) const;
};

/** Translation, rotation and scale of a node, with their rates. */
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

/** Connects one property of one node with its keys. */
struct Channel {
    int node = 0;  ///< Index into Scene::nodes.
    AnimatedPath path = AnimatedPath::Translation;
    size_t keys = 0;  ///< Index into Animation::keys.
};

/** An animation of a file. */
struct Animation {
    std::string name;  ///< Unique name from the file, else "animation_3".
    std::vector<KeyFrames> keys;
    std::vector<Channel> channels;
    double duration = 0;  ///< Time of the last key of all channels [s].
};

/** A node that animations may move. Its `Node::parent_from_node` is before * rest.matrix() * after. */
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
    std::vector<glm::dmat4> joint_from_bind;  ///< One per joint.
    std::vector<double> rest_weights;         ///< One per morph target, for weights that are not animated [1].
};

/** Animations of a scene, with the nodes that they move and the objects that deform. */
struct Animations {
    std::vector<Animation> all;            ///< In the order of the file.
    std::vector<AnimatedNode> nodes;       ///< Ascending.
    std::vector<DeformingObject> objects;  ///< Ascending.

    bool empty() const { return all.empty() && objects.empty(); }
};

}  // namespace insonify::scene
