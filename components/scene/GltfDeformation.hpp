#pragma once
#include <string>
#include <vector>

#include "components/scene/Animation.hpp"
#include "components/scene/GltfAccessor.hpp"
#include "components/scene/GltfFile.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** A skin of a file: nodes of the file, and how vertices are placed about each. */
struct GltfSkin {
    std::vector<int> joints;  ///< Nodes of the file.
    std::vector<glm::dmat4> joint_from_bind;
};

/** Reads a skin. What is wrong with it is a types::ConfigError.
 *  @param path  of the node's reference to it, "nodes[3].skin" */
GltfSkin readSkin(const GltfFile& gltf, const GltfAccessors& accessors, int skin, const std::string& path);

/** Number of morph targets that all primitives of a mesh have [1]. */
size_t targetCount(const GltfFile& gltf, size_t mesh);

/** Default weights of the morph targets of a node's mesh: those of the node, else of the mesh, else 0. */
std::vector<double> restWeights(const GltfFile& gltf, const tinygltf::Node& node, const std::string& path);

/** Collects how the vertices of a file's mesh follow joints and morph targets, primitive after primitive. */
class GltfDeformation {
public:
    /** @param joints  of the skin; 0: none */
    GltfDeformation(const GltfFile& gltf, const GltfAccessors& accessors, size_t mesh, size_t joints);

    /** Number of the next primitive's first vertex in the mesh. */
    uint32_t next() const { return next_; }
    /** Reads what a primitive of `count` vertices has. Wrong counts, joints and weights are a types::ConfigError. */
    void add(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    /** The collected deformation in the order of a mesh whose vertices have these numbers. */
    types::Deformation make(const types::Mesh& mesh, const std::vector<uint32_t>& numbers) const;
    /** Vertices that followed no joint, and follow the first one of the skin [1]. */
    size_t unweighted() const { return unweighted_; }

private:
    void addShares(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    /** Adds joints and weights of one set, JOINTS_0 for example; false where the primitive has no such set. */
    bool addSet(const tinygltf::Primitive& primitive, const std::string& path, int set,
                std::vector<std::vector<types::JointShare>>& of_vertices) const;
    void addTargets(const tinygltf::Primitive& primitive, const std::string& path, size_t count);
    [[noreturn]] void fail(const std::string& path, const std::string& message) const;

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    size_t joints_;
    uint32_t next_ = 0;
    size_t unweighted_ = 0;
    types::Deformation raw_;  ///< By the numbers of the file's vertices; its positions are not used.
};

}  // namespace insonify::scene
