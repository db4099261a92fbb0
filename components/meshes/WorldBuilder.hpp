#pragma once
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/meshes/ModelPaths.hpp"
#include "components/meshes/VisualMeshes.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/UniqueNames.hpp"
#include "types/ConfigError.hpp"

namespace insonify::meshes {

// Geometries of a visual, as SDF defines them, about the visual's origin [m].
struct BoxShape {
    glm::dvec3 size{0};
};
/** A sphere has three equal radii. */
struct EllipsoidShape {
    glm::dvec3 radii{0};
    bool is_sphere = false;
};
struct CylinderShape {
    double radius = 0, length = 0;  ///< Along z.
};
/** About z, its point up, its middle at the origin. */
struct ConeShape {
    double radius = 0, length = 0;  ///< The radius is that of its base.
};
/** A cylinder along z between two half spheres. */
struct CapsuleShape {
    double radius = 0, length = 0;  ///< The length is that of the cylinder.
};
struct PlaneShape {
    glm::dvec3 normal{0, 0, 1};
    glm::dvec2 size{0};
};
struct MeshShape {
    std::string uri;
    std::string submesh;  ///< Empty: all of the file.
    bool is_centred = false;
    glm::dvec3 scale{1};
    std::filesystem::path named_in;  ///< The file with the URI, where there is one.
};
struct HeightmapShape {
    std::string uri;
    glm::dvec3 size{0}, position{0};
    std::filesystem::path named_in;  ///< The file with the URI, where there is one.
};
/** A geometry that is not read. */
struct OtherShape {};
using Shape = std::variant<OtherShape, BoxShape, EllipsoidShape, CylinderShape, ConeShape, CapsuleShape, PlaneShape,
                           MeshShape, HeightmapShape>;

/** Makes a scene of a world's models, links and visuals. Nodes are models and links, objects are visuals. What cannot
 *  be shown is a notice of the scene. */
class WorldBuilder {
public:
    /** Files are looked for from `world`, see ModelPaths. */
    explicit WorldBuilder(const std::filesystem::path& world) : paths_(world), meshes_(geometry_) {}

    /** Returns the node's index. `parent` is -1 at the top. */
    int addNode(const std::string& name, int parent, const glm::dmat4& world_from_node);
    const glm::dmat4& worldFromNode(int node) const { return world_from_node_[static_cast<size_t>(node)]; }
    const scene::Node& node(int index) const { return scene_.nodes[static_cast<size_t>(index)]; }

    /** `name` starts with that of its model and link. */
    void addVisual(const std::string& name, int node, const glm::dmat4& node_from_visual, const Shape& shape,
                   const Look& look);
    /** Says in a notice why a visual is not shown. */
    void leaveOut(const std::string& visual, const std::string& why);
    void notice(std::string text) { geometry_.notices.push_back(std::move(text)); }
    std::vector<std::string>& notices() { return geometry_.notices; }
    const ModelPaths& paths() const { return paths_; }

    /** Ends the building. */
    scene::Scene take();

private:
    std::vector<Placing> placingsOf(const std::string& name, const Shape& shape, const Look& look);
    std::vector<Placing> placingsOfMesh(const std::string& name, const MeshShape& mesh, const Look& look);
    std::vector<Placing> placingsOfHeightmap(const std::string& name, const HeightmapShape& map, const Look& look);

    ModelPaths paths_;
    types::Geometry geometry_;
    VisualMeshes meshes_;
    scene::Scene scene_;
    std::vector<glm::dmat4> world_from_node_;  ///< For each node.
    scene::UniqueNames names_, object_names_;
    size_t flat_visuals_ = 0;
};

/** What is wrong with the sizes of a shape: the key of SDF, and why. The message is empty where nothing is. */
types::Diagnostic faultOf(const Shape& shape);

}  // namespace insonify::meshes
