#pragma once
#include <string>
#include <vector>

#include "components/scene/gltf/GltfFile.hpp"
#include "components/scene/motion/Animation.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::scene {

/** A skin of a file: its joints, and the places of vertices relative to each joint. */
struct GltfSkin {
    std::vector<int> joints;  ///< Nodes of the file.
    std::vector<glm::dmat4> joint_from_bind;
};

/** Reads a skin. Throws types::ConfigError for wrong data.
 *  @param path  of the node's reference to it, "nodes[3].skin" */
GltfSkin readSkin(const GltfFile& gltf, const GltfAccessors& accessors, int skin, const std::string& path);

/** Returns the number of morph targets of a mesh, the same for all its primitives [1]. */
size_t targetCount(const GltfFile& gltf, size_t mesh);

/** Returns the default weights of the morph targets of a node's mesh: from the node, else from the mesh, else 0. */
std::vector<double> restWeights(const GltfFile& gltf, const tinygltf::Node& node, const std::string& path);

/** Collects joints and morph targets of the vertices of a mesh, primitive by primitive. */
class GltfDeformation {
public:
    /** @param joints  number of joints of the skin; 0: no skin */
    GltfDeformation(const GltfFile& gltf, const GltfAccessors& accessors, size_t mesh, size_t joints);

    /** Returns the number of the next primitive's first vertex in the mesh. */
    uint32_t next() const { return next_; }
    /** Reads a primitive with `count` vertices. Throws types::ConfigError for wrong counts, joints and weights. */
    void add(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    /** Returns the collected deformation in the vertex order of a mesh whose vertices have these numbers. */
    types::Deformation make(const types::Mesh& mesh, const std::vector<uint32_t>& numbers) const;
    /** Returns the number of vertices without weights; they follow the first joint of the skin [1]. */
    size_t unweighted() const { return unweighted_; }

private:
    void addShares(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    /** Adds joints and weights of one set, for example JOINTS_0. Returns false if the primitive lacks the set. */
    bool addSet(const tinygltf::Primitive& primitive, const std::string& path, int set,
                std::vector<std::vector<types::JointShare>>& of_vertices) const;
    void addTargets(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    [[noreturn]] void fail(const std::string& path, const std::string& message) const;

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    size_t joints_;
    uint32_t next_ = 0;
    size_t unweighted_ = 0;
    types::Deformation raw_;  ///< Indexed by the vertices of the file; positions unused.
};

/** Animations of a file, with counts of omitted channels. */
struct GltfAnimations {
    std::vector<Animation> all;
    size_t other_paths = 0;    ///< Channels of extensions, which animate neither a node nor weights.
    size_t outside_scene = 0;  ///< Channels whose node is not in the scene.
    size_t doubled = 0;        ///< Channels that animate the same property as an earlier channel.
};

/** Reads the animations of a file. Throws types::ConfigError for wrong data.
 *  @param node_in_scene  for each node of the file its index into Scene::nodes, -1 if it is not in the scene */
GltfAnimations readAnimations(const GltfFile& gltf, const GltfAccessors& accessors,
                              const std::vector<int>& node_in_scene);

}  // namespace insonify::scene
