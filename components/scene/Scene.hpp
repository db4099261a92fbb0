#pragma once
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/scene/motion/Animation.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/samples/Plan.hpp"

namespace insonify::scene {

/** What the rounding of its coordinates to 32 bits does to a mesh that is far from its own origin. */
struct VertexRounding {
    double farthest = 0;  ///< Max coordinate [m].
    double step = 0;      ///< Step of coordinates there [m].
    double share = 0;     ///< Share of the surface whose normals may be off by max_tilt and more [1].
    double tilt = 0;      ///< Max error of the normals of that share, at most pi / 2 [rad].

    static constexpr double max_tilt = 0.01;   ///< Smooth metal, with the narrowest lobe, changes by 0.05 dB [rad].
    static constexpr double max_share = 0.01;  ///< Of the surface that may be off: slivers have no area [1].
};

/** Returns the rounding of a mesh that would be more exact about its own middle; none where its normals are good. */
std::optional<VertexRounding> findRounding(const types::Mesh& mesh);

/** Adds a notice that names the objects whose vertices are too far from their origin, if there are any. */
void noteRounding(types::GeometryPtr& geometry);

/** A node of a scene, as the file arranges them. Every parent precedes its children. */
struct Node {
    std::string name;                ///< Unique: the file's, else its mesh's, else "node_3".
    int parent = -1;                 ///< Index of a node, -1 at the root.
    glm::dmat4 parent_from_node{1};  ///< At the root: world_from_node, with the turn to z-up.
    glm::dvec3 scale{1};             ///< The scale given with translation and rotation; 1 for a matrix.
};

/** How an object is drawn by the program for which its file was made. It distinguishes drawings from bodies. */
struct Drawing {
    double transparency = 0;  ///< 0 is opaque, 1 invisible [1].
    bool casts_shadow = true;
    bool is_for_some = false;  ///< Only some cameras see it.
    bool is_for_none = false;  ///< No camera sees it.
};

/** A scene file: immutable geometry, and the tree of nodes that defines which objects move together. */
struct Scene {
    types::GeometryPtr geometry;
    std::vector<Node> nodes;
    std::vector<int> object_nodes;                      ///< For each object of the geometry, its node.
    std::vector<glm::dmat4> node_from_object;           ///< For each object; 1 except for instances and visuals.
    glm::dmat4 z_up_from_file{1};                       ///< The turn of the file's axes to the world's.
    std::shared_ptr<const Animations> animations = {};  ///< Null: nothing moves by itself, nor is deformed.
    std::vector<Drawing> drawings = {};                 ///< Empty, or one for each object.
    std::vector<types::Omission> omitted = {};  ///< Objects and materials of the file that are omitted, and why.
    std::vector<std::string> warnings = {};     ///< About omissions and objects to omit, a sentence each.
};

/** An object that moves with a node. */
struct Part {
    uint32_t object = 0;             ///< Index into Geometry::objects.
    glm::dmat4 body_from_object{1};  ///< Body: the node without its rotation, axes turned like the world's, scale kept.
};

using SceneReader = Scene (*)(const std::filesystem::path& file);

/** A format of scenes. Its files are recognised by their ending, in any case of letters. */
struct SceneFormat {
    std::string_view ending;          ///< In lower case: ".glb".
    const char* name = "";            ///< For users: "glTF".
    SceneReader read = nullptr;       ///< Null: `component` reads it.
    std::string_view component = {};  ///< The component library that reads it; empty: the core.
};
std::span<const SceneFormat> sceneFormats();
/** Returns the format of a file by its name; null: it has no ending of a scene. Does not look at the file. */
const SceneFormat* findSceneFormat(const std::filesystem::path& file);
/** Returns the endings of all formats, or of those that a component library reads: ".world, .sdf or .urdf". */
std::string sceneEndings(std::optional<std::string_view> library = {});
/** Returns the meaning of the property that names the file of a scene. It stays valid until the program ends. */
const char* sceneFileMeaning();

/** Reads a scene. .gltf or .glb is y-up and is turned to z-up: (x, y, z) of the file is (x, -z, y) of the world.
 *  .world, .sdf or .urdf is z-up and is read by the component library sdf; a mesh by the component library meshes.
 *  Throws types::ConfigError for any error in the file. Geometry::notices lists what was omitted. */
Scene readScene(const std::filesystem::path& file);

/** Adds a reader by its extension, such as ".sdf", to readScene(): for programs that are linked with a reader. */
void addFormat(const std::string& extension, SceneReader reader);

/** Reads a scene like readScene(). All holders of a file's scene share one, unless the file has changed in between. */
std::shared_ptr<const Scene> sharedScene(const std::filesystem::path& file);

/** Returns the extension in lower case: ".glb" for "Harbour.GLB". */
std::string getExtension(const std::filesystem::path& file);

/** Whether the name of a file is one of glTF. */
bool isGltf(const std::filesystem::path& file);

/** Returns the geometry of readScene(). */
types::GeometryPtr loadScene(const std::filesystem::path& file);

/** Returns true if all numbers of the matrix are finite. */
bool isFinite(const glm::dmat4& matrix);

/** Returns the index of the node with that name, -1 if there is none. */
int findNode(const Scene& scene, const std::string& name);

/** What a body that has the node's place makes of the node: scale, shear, and the turn to z-up. */
glm::dmat4 bodyFromNode(const Scene& scene, int node);

/** Returns the objects at and below a node. With a pose of the body, world_from_object = world_from_body *
 *  body_from_object. */
std::vector<Part> getParts(const Scene& scene, int node);

/** Returns a point of a node in the axes of a body. `body` is the index of a node at or above `node`, or -1 for the
 *  world. The point is given in the node's axes, without scale [m]; they are the body's axes where neither is turned.
 *  The result is not finite if the node is scaled to zero and the point is not its origin. */
glm::dvec3 getPlace(const Scene& scene, int node, int body, const glm::dvec3& point);
/** The same of a node that is where a matrix has it. */
glm::dvec3 placeIn(const Scene& scene, int node, const glm::dmat4& body_from_node, const glm::dvec3& point);

}  // namespace insonify::scene
