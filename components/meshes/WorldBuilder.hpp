#pragma once
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/meshes/ModelPaths.hpp"
#include "components/meshes/VisualMeshes.hpp"
#include "components/scene/Scene.hpp"
#include "components/scene/Surface.hpp"
#include "components/scene/UniqueNames.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::meshes {

// Shapes of SDF about their origins, faces outward. Round shapes have 64 facets around. Their vertices are on the true
// surface, from which the facets deviate by at most 0.12 % of the radius.

scene::Surface unitBox();       ///< Side 1 [m].
scene::Surface unitPlane();     ///< A square of side 1 in z = 0 that faces up [m].
scene::Surface unitSphere();    ///< Radius 1 [m].
scene::Surface unitCylinder();  ///< Radius 1 and height 1 along z [m].
scene::Surface unitCone();      ///< Radius 1 at its base, height 1 along z, its point up [m].
/** A cylinder of `length` along z between half spheres of `radius` [m]. */
scene::Surface capsule(double radius, double length);

/** Makes terrain from a grey picture, 8 or 16 bits, PNG, JPEG or binary PGM. White is `size.z` above black, columns run
 *  along x, the top row is at +y, and the centre of its black plane is at the origin. Each pixel is a vertex; a picture
 *  with a side of more than 2049 pixels is subsampled. Throws std::runtime_error for a picture that cannot be read. */
scene::Surface readHeightmap(const std::filesystem::path& file, glm::dvec3 size);

// Geometries of a visual, as defined by SDF, about the visual's origin [m].
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
/** A cone about z, its apex up, its middle at the origin. */
struct ConeShape {
    double radius = 0, length = 0;  ///< Radius of the base.
};
/** A cylinder along z between two half spheres. */
struct CapsuleShape {
    double radius = 0, length = 0;  ///< Length of the cylinder.
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
    std::filesystem::path named_in;  ///< The file that contains the URI, if any.
};
struct HeightmapShape {
    std::string uri;
    glm::dvec3 size{0}, position{0};
    std::filesystem::path named_in;  ///< The file that contains the URI, if any.
};
/** A geometry that is not supported. */
struct OtherShape {
    std::string name;  ///< Its element; empty: unknown.
};
using Shape = std::variant<OtherShape, BoxShape, EllipsoidShape, CylinderShape, ConeShape, CapsuleShape, PlaneShape,
                           MeshShape, HeightmapShape>;

/** Builds a scene from a world's models, links and visuals. Nodes are models and links, objects are visuals.
 *  Unsupported parts are notices of the scene. */
class WorldBuilder {
public:
    /** Searches files from `world`, see ModelPaths. */
    explicit WorldBuilder(const std::filesystem::path& world, ModelPaths::Reach reach = ModelPaths::Reach::OwnPlaces)
        : paths_(world, reach), meshes_(geometry_) {}

    /** Adds a node and returns its index. `parent` is -1 at the top. */
    int addNode(const std::string& name, int parent, const glm::dmat4& world_from_node);
    const glm::dmat4& worldFromNode(int node) const { return world_from_node_[static_cast<size_t>(node)]; }
    const scene::Node& node(int index) const { return scene_.nodes[static_cast<size_t>(index)]; }

    /** Adds a visual. `name` starts with the names of its model and link. */
    void addVisual(const std::string& name, int node, const glm::dmat4& node_from_visual, const Shape& shape,
                   const Look& look, const scene::Drawing& drawing);
    /** Notes why a visual is omitted: visuals with the same reason share one notice. */
    void leaveOut(const std::string& visual, const std::string& why);
    /** Notes that a file is not found, for the notice of where files were searched. */
    void missed(const std::string& uri) { searched_.insert(paths_.searched(uri)); }
    void notice(std::string text) { geometry_.notices.push_back(std::move(text)); }
    types::Notices& notices() { return geometry_.notices; }
    const ModelPaths& paths() const { return paths_; }

    /** Finishes and returns the scene. */
    scene::Scene take();

private:
    std::vector<Placing> getPlacings(const std::string& name, const Shape& shape, const Look& look);
    std::vector<Placing> placingsOfMesh(const std::string& name, const MeshShape& mesh, const Look& look);
    std::vector<Placing> placingsOfHeightmap(const std::string& name, const HeightmapShape& map, const Look& look);

    ModelPaths paths_;
    types::Geometry geometry_;
    VisualMeshes meshes_;
    scene::Scene scene_;
    std::vector<glm::dmat4> world_from_node_;  ///< For each node.
    scene::UniqueNames names_, object_names_;
    struct LeftOut {
        size_t notice = 0;  ///< Index into the notices.
        std::vector<std::string> visuals;
    };
    std::map<std::string, LeftOut> left_out_;  ///< By the reason.
    std::set<std::string> unit_questions_;     ///< Already given.
    std::set<std::string> searched_;           ///< Sentences about files that are not found.
    size_t flat_visuals_ = 0;
};

/** Returns an invalid size of a shape: its key in SDF, and the reason. The message is empty if all sizes are valid. */
types::Diagnostic findFault(const Shape& shape);

}  // namespace insonify::meshes
