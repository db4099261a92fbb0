#include "components/scene/Scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "components/loader/ComponentLibrary.hpp"
#include "components/scene/gltf/Gltf.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

double largest(const glm::vec3& v) { return static_cast<double>(std::max({v.x, v.y, v.z})); }

/** Returns by how much the normal of a triangle turns if its corners move by one step [rad]. */
double computeTilt(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double step, double& area) {
    area = glm::length(glm::cross(b - a, c - a)) / 2;
    const double base = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    return std::atan2(step * base, 2 * area);
}

/** Returns a transform without its rotation: scale and shear, in the axes of the node. A mirroring matrix keeps its
 *  mirror in x. With a given scale, the signs are those of the scale. */
glm::dmat3 withoutRotation(const glm::dmat3& matrix, glm::dvec3 scale) {
    glm::dmat3 rotation;
    rotation[0] = glm::normalize(matrix[0]) * glm::sign(scale.x);
    rotation[1] = glm::normalize(matrix[1] - rotation[0] * glm::dot(rotation[0], matrix[1])) * glm::sign(scale.y);
    rotation[2] = glm::normalize(glm::cross(rotation[0], rotation[1]));
    if (glm::dot(rotation[2], matrix[2]) * scale.z < 0) {
        rotation[0] = -rotation[0];
        rotation[2] = -rotation[2];
    }
    return glm::transpose(rotation) * matrix;
}

constexpr SceneFormat all_formats[] = {
    {".gltf", "glTF", readGltf},        {".glb", "glTF", readGltf},         {".world", "SDF", nullptr, "sdf"},
    {".sdf", "SDF", nullptr, "sdf"},    {".urdf", "URDF", nullptr, "sdf"},  {".dae", "COLLADA", nullptr, "meshes"},
    {".obj", "OBJ", nullptr, "meshes"}, {".stl", "STL", nullptr, "meshes"}, {".ply", "PLY", nullptr, "meshes"},
};

/** Returns the names of scenes in a folder. */
std::vector<std::string> scenesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
        if (findSceneFormat(entry.path())) names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

void refuseMissing(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) return;
    const std::filesystem::path place = std::filesystem::absolute(file, error).lexically_normal();
    const std::string near =
        types::offerCurrentFolder(file) + types::didYouMean(file.filename().string(), scenesIn(place.parent_path()));
    throw types::ConfigError(file.string(), "",
                             fmt::format("does not exist; {}looked for at {}; must be a scene, which may be {}", near,
                                         place.string(), sceneEndings()));
}

/** Readers that this program is linked with, in addition to those of the table, by extension. */
struct AddedReaders {
    std::mutex mutex;
    std::map<std::string, SceneReader> readers;
};

AddedReaders& added() {
    static AddedReaders added;
    return added;
}

/** Returns the added reader of an extension; null: none was added. */
SceneReader addedReader(const std::string& extension) {
    const std::lock_guard alone(added().mutex);
    const auto found = added().readers.find(extension);
    return found == added().readers.end() ? nullptr : found->second;
}

/** Returns the transform from a node to a node at or above it; -1 is the world. */
glm::dmat4 aboveFromNode(const Scene& scene, int above, int node) {
    glm::dmat4 above_from_node(1);
    for (int i = node; i != above; i = scene.nodes[static_cast<size_t>(i)].parent)
        above_from_node = scene.nodes[static_cast<size_t>(i)].parent_from_node * above_from_node;
    return above_from_node;
}

/** Returns the reader of a component library. */
auto* libraryReader(std::string_view library, const std::filesystem::path& file) try {
    return loader::load(std::string(library)).entry<void(const std::filesystem::path&, Scene&)>("insonify_read_scene");
} catch (const types::ConfigError& error) {
    throw types::ConfigError(file.string(), "", error.diagnostics().front().text());
}

/** Reads a file that exists by the reader of its extension. */
Scene readByExtension(const std::filesystem::path& file) {
    const std::string extension = getExtension(file);
    if (const SceneReader read = addedReader(extension)) return read(file);
    const SceneFormat* const format = findSceneFormat(file);
    if (!format)
        throw types::ConfigError(file.string(), "",
                                 fmt::format("has extension \"{}\"; may be {}", extension, sceneEndings()));
    if (format->read) return format->read(file);
    Scene scene;
    libraryReader(format->component, file)(file, scene);
    return scene;
}

}  // namespace

std::optional<VertexRounding> findRounding(const types::Mesh& mesh) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const types::Cluster& cluster : mesh.clusters) {
        low = glm::min(low, cluster.centre - cluster.half);
        high = glm::max(high, cluster.centre + cluster.half);
    }
    VertexRounding rounding;
    rounding.farthest = largest(glm::max(glm::abs(low), glm::abs(high)));
    if (mesh.indices.empty() || rounding.farthest < 2 * largest(high - low)) return {};  // two bits are too few
    const auto farthest = static_cast<float>(rounding.farthest);
    rounding.step = static_cast<double>(std::nextafter(farthest, std::numeric_limits<float>::max()) - farthest);
    double all = 0, off = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        double area = 0;
        const double tilt = computeTilt(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                                        mesh.positions[mesh.indices[i + 2]], rounding.step, area);
        all += area;
        if (tilt < VertexRounding::max_tilt) continue;
        off += area;
        rounding.tilt = std::max(rounding.tilt, tilt);
    }
    rounding.share = all > 0 ? off / all : 0;
    if (!(rounding.share > VertexRounding::max_share)) return {};
    return rounding;
}

namespace {

/** Returns a warning that names the objects with rounded meshes; none: there are none. */
std::optional<types::Notice> roundingNotice(const types::Geometry& geometry) {
    constexpr size_t shown = 5;
    std::vector<std::optional<VertexRounding>> known(geometry.meshes.size());
    for (size_t i = 0; i < known.size(); ++i) known[i] = findRounding(geometry.meshes[i]);
    std::vector<std::string> names;
    VertexRounding worst;
    for (const types::Object& object : geometry.objects) {
        const auto& rounding = known[static_cast<size_t>(object.mesh)];
        if (!rounding) continue;
        names.push_back(object.name);
        if (rounding->tilt * rounding->share > worst.tilt * worst.share) worst = *rounding;
    }
    if (names.empty()) return {};
    const size_t more = names.size() - std::min(shown, names.size());
    names.resize(names.size() - more);
    return types::warning(fmt::format(
        "vertices far from the origin of their own mesh have coarse coordinates, which turns small triangles "
        "and changes their echoes: {}{}, up to {:.4g} m away in steps of {:.2g} mm: {:.3g} % of the surface is turned "
        "by up to {:.2g} deg; keep vertices near the origin of the file, and place the object by its node, its link "
        "or `placement`",
        fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "", worst.farthest, 1e3 * worst.step,
        100 * worst.share, types::degrees(worst.tilt)));
}

}  // namespace

void noteRounding(types::GeometryPtr& geometry) {
    auto notice = roundingNotice(*geometry);
    if (!notice) return;
    auto noted = std::make_shared<types::Geometry>(*geometry);
    noted->notices.push_back(std::move(*notice));
    geometry = std::move(noted);
}

std::span<const SceneFormat> sceneFormats() { return all_formats; }

const SceneFormat* findSceneFormat(const std::filesystem::path& file) { return types::findFormat(all_formats, file); }

std::string sceneEndings(std::optional<std::string_view> library) {
    return types::alternativeEndings(
        all_formats, [&](const SceneFormat& format) { return !library || format.component == *library; });
}

const char* sceneFileMeaning() {
    static const std::string text =
        "scene: " + sceneEndings() + ", relative to the deployment; may be absent with gazebo or bathymetry";
    return text.c_str();
}

void addFormat(const std::string& extension, SceneReader reader) {
    const std::lock_guard alone(added().mutex);
    added().readers[extension] = reader;
}

bool isGltf(const std::filesystem::path& file) {
    const SceneFormat* const format = findSceneFormat(file);
    return format && format->read == readGltf;
}

std::string getExtension(const std::filesystem::path& file) { return types::lowered(file.extension().string()); }

Scene readScene(const std::filesystem::path& file) {
    refuseMissing(file);
    Scene scene = readByExtension(file);
    noteRounding(scene.geometry);
    return scene;
}

std::shared_ptr<const Scene> sharedScene(const std::filesystem::path& file) {
    using Key = std::tuple<std::filesystem::path, std::filesystem::file_time_type, uintmax_t>;
    static std::mutex mutex;
    static std::map<Key, std::weak_ptr<const Scene>> scenes;
    std::error_code none;  // readScene() reports errors of the file
    const Key key(std::filesystem::weakly_canonical(file, none), std::filesystem::last_write_time(file, none),
                  std::filesystem::file_size(file, none));
    const std::lock_guard alone(mutex);
    std::erase_if(scenes, [](const auto& each) { return each.second.expired(); });
    if (const auto known = scenes.find(key); known != scenes.end())
        if (auto scene = known->second.lock()) return scene;
    auto scene = std::make_shared<const Scene>(readScene(file));
    scenes[key] = scene;
    return scene;
}

bool isFinite(const glm::dmat4& matrix) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(matrix[c][r])) return false;
    return true;
}

types::GeometryPtr loadScene(const std::filesystem::path& file) { return readScene(file).geometry; }

int findNode(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.nodes, name, &Node::name);
    return found == scene.nodes.end() ? -1 : static_cast<int>(found - scene.nodes.begin());
}

glm::dmat4 bodyFromNode(const Scene& scene, int node) {
    const glm::dmat3 world_from_node(aboveFromNode(scene, -1, node));
    return scene.z_up_from_file *
           glm::dmat4(withoutRotation(world_from_node, scene.nodes[static_cast<size_t>(node)].scale));
}

std::vector<Part> getParts(const Scene& scene, int node) {
    // body_from_node of the nodes at and below; children come after their parents
    std::vector<glm::dmat4> body_from_node(scene.nodes.size());
    std::vector<bool> moves(scene.nodes.size());
    const auto top = static_cast<size_t>(node);
    body_from_node[top] = bodyFromNode(scene, node);
    moves[top] = true;
    for (size_t i = top + 1; i < scene.nodes.size(); ++i) {
        const Node& below = scene.nodes[i];
        if (below.parent < 0 || !moves[static_cast<size_t>(below.parent)]) continue;
        moves[i] = true;
        body_from_node[i] = body_from_node[static_cast<size_t>(below.parent)] * below.parent_from_node;
    }
    std::vector<Part> parts;
    for (size_t i = 0; i < scene.object_nodes.size(); ++i)
        if (const auto at = static_cast<size_t>(scene.object_nodes[i]); moves[at])
            parts.push_back({static_cast<uint32_t>(i), body_from_node[at] * scene.node_from_object[i]});
    return parts;
}

glm::dvec3 getPlace(const Scene& scene, int node, int body, const glm::dvec3& point) {
    if (node == body) return point;
    glm::dmat4 body_from_node = aboveFromNode(scene, body, node);
    if (body >= 0) body_from_node = bodyFromNode(scene, body) * body_from_node;
    return placeIn(scene, node, body_from_node, point);
}

glm::dvec3 placeIn(const Scene& scene, int node, const glm::dmat4& body_from_node, const glm::dvec3& point) {
    const glm::dvec3 origin(body_from_node[3]);
    if (point == glm::dvec3(0)) return origin;
    const glm::dmat3 linear(body_from_node);
    const glm::dmat3 shape = withoutRotation(linear, scene.nodes[static_cast<size_t>(node)].scale);
    const glm::dmat3 rotation = linear * glm::inverse(shape);
    return origin + rotation * glm::transpose(glm::dmat3(scene.z_up_from_file)) * point;
}

}  // namespace insonify::scene
