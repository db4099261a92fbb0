#include "components/scene/Gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "components/scene/Clusters.hpp"
#include "components/scene/GltfAccessor.hpp"
#include "components/scene/GltfFile.hpp"
#include "components/scene/GltfMaterials.hpp"
#include "components/scene/GltfMesh.hpp"
#include "components/scene/UniqueNames.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** Max number of instances and nodes together. */
constexpr size_t max_objects = 1'000'000;

glm::dmat4 compose(glm::dvec3 translation, glm::dquat rotation, glm::dvec3 scale) {
    return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation), scale);
}

/** Visits the nodes of one file's scene and collects objects. */
class GltfReader {
public:
    explicit GltfReader(const std::filesystem::path& file)
        : gltf_(readGltfFile(file)),
          accessors_(gltf_.model, gltf_.name),
          meshes_(gltf_, accessors_, readMaterials(gltf_, accessors_, geometry_), geometry_) {}

    Scene read() {
        walk(rootNodes());
        finishMeshes();
        addNotices();
        scene_.z_up_from_file = z_up_from_y_up;
        scene_.geometry = std::make_shared<const types::Geometry>(std::move(geometry_));
        return std::move(scene_);
    }

private:
    struct Visit {
        int node;
        int parent;  ///< Index into Scene::nodes.
        glm::dmat4 world_from_parent;
    };

    std::vector<int> rootNodes() const {
        const tinygltf::Model& model = gltf_.model;
        if (!model.scenes.empty()) {
            const int scene = std::max(model.defaultScene, 0);
            if (static_cast<size_t>(scene) >= model.scenes.size())
                fail("scene", fmt::format("is {}; the file has {} scenes", scene, model.scenes.size()));
            return model.scenes[static_cast<size_t>(scene)].nodes;
        }
        std::set<int> children;
        for (const tinygltf::Node& node : model.nodes) children.insert(node.children.begin(), node.children.end());
        std::vector<int> roots;
        for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i)
            if (!children.contains(i)) roots.push_back(i);
        return roots;
    }

    /** Visits nodes depth first without recursion, so that a deep file cannot overflow the stack. */
    void walk(const std::vector<int>& roots) {
        std::vector<Visit> waiting;
        const auto add = [&waiting](const std::vector<int>& nodes, int parent, const glm::dmat4& world_from_parent) {
            for (size_t i = nodes.size(); i-- > 0;) waiting.push_back({nodes[i], parent, world_from_parent});
        };
        add(roots, -1, z_up_from_y_up);
        std::vector<bool> seen(gltf_.model.nodes.size());
        while (!waiting.empty()) {
            const Visit visit = waiting.back();
            waiting.pop_back();
            const std::string path = fmt::format("nodes[{}]", visit.node);
            if (visit.node < 0 || static_cast<size_t>(visit.node) >= seen.size())
                fail(path, fmt::format("does not exist; the file has {}", seen.size()));
            if (seen[static_cast<size_t>(visit.node)])
                fail(path, "is reached twice; a node may have one parent and no cycle");
            seen[static_cast<size_t>(visit.node)] = true;
            const glm::dmat4 world_from_node = addNode(visit, path);
            add(gltf_.model.nodes[static_cast<size_t>(visit.node)].children, static_cast<int>(scene_.nodes.size()) - 1,
                world_from_node);
        }
    }

    /** Adds a node and its objects; returns world_from_node. */
    glm::dmat4 addNode(const Visit& visit, const std::string& path) {
        const tinygltf::Node& from = gltf_.model.nodes[static_cast<size_t>(visit.node)];
        Node node;
        node.parent = visit.parent;
        node.name = names_.add(nameOf(from, visit.node));
        node.parent_from_node = transform(from, path, node.scale);
        const glm::dmat4 world_from_node = visit.world_from_parent * node.parent_from_node;
        if (visit.parent < 0) node.parent_from_node = world_from_node;
        if (!isFinite(world_from_node)) fail(path, "has a transform that is not finite");
        scene_.nodes.push_back(node);
        if (from.mesh >= 0)
            addObjects(from, node.name, world_from_node, path);
        else if (from.mesh != -1)
            fail(path + ".mesh", fmt::format("is {}", from.mesh));
        has_skin_ = has_skin_ || from.skin >= 0;
        return world_from_node;
    }

    std::string nameOf(const tinygltf::Node& node, int index) const {
        if (!node.name.empty()) return node.name;
        const auto mesh = static_cast<size_t>(node.mesh);
        if (node.mesh >= 0 && mesh < gltf_.model.meshes.size() && !gltf_.model.meshes[mesh].name.empty())
            return gltf_.model.meshes[mesh].name;
        return fmt::format("node_{}", index);
    }

    glm::dmat4 transform(const tinygltf::Node& node, const std::string& path, glm::dvec3& scale) const {
        const auto expect = [&](const std::vector<double>& values, size_t count, const char* key) {
            if (!values.empty() && values.size() != count)
                fail(path + key, fmt::format("has {} numbers; must have {}", values.size(), count));
            return !values.empty();
        };
        if (expect(node.matrix, 16, ".matrix")) {
            glm::dmat4 matrix;
            for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
            for (int c = 0; c < 4; ++c) matrix[c][3] = c == 3;
            return matrix;
        }
        glm::dvec3 translation{0};
        glm::dquat rotation{1, 0, 0, 0};
        if (expect(node.translation, 3, ".translation"))
            translation = {node.translation[0], node.translation[1], node.translation[2]};
        if (expect(node.scale, 3, ".scale")) scale = {node.scale[0], node.scale[1], node.scale[2]};
        if (expect(node.rotation, 4, ".rotation")) {
            rotation = {node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]};
            const double length = glm::length(rotation);
            if (!(length > 1e-6) || !std::isfinite(length))
                fail(path + ".rotation", "has no length; must be a unit quaternion x, y, z, w");
            rotation /= length;
        }
        return compose(translation, rotation, scale);
    }

    void addObjects(const tinygltf::Node& node, const std::string& name, const glm::dmat4& world_from_node,
                    const std::string& path) {
        if (static_cast<size_t>(node.mesh) >= gltf_.model.meshes.size())
            fail(path + ".mesh", fmt::format("is {}; the file has {}", node.mesh, gltf_.model.meshes.size()));
        const int mesh = meshIndex(static_cast<size_t>(node.mesh));
        if (mesh < 0) return;
        const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
        if (instancing == node.extensions.end()) return addObject(name, mesh, world_from_node, glm::dmat4(1), path);
        const std::vector<glm::dmat4> instances =
            readInstances(instancing->second, path + ".extensions.EXT_mesh_gpu_instancing");
        for (size_t i = 0; i < instances.size(); ++i)
            addObject(names_.add(fmt::format("{}[{}]", name, i)), mesh, world_from_node, instances[i], path);
    }

    void addObject(const std::string& name, int mesh, const glm::dmat4& world_from_node,
                   const glm::dmat4& node_from_object, const std::string& path) {
        const glm::dmat4 world_from_object = world_from_node * node_from_object;
        if (!isFinite(world_from_object)) fail(path, "has a transform that is not finite");
        if (glm::determinant(glm::dmat3(world_from_object)) == 0) {
            ++flat_objects_;
            return;
        }
        if (geometry_.objects.size() == max_objects)
            fail(path, fmt::format("brings the file over {} objects", max_objects));
        geometry_.objects.push_back({name, mesh, world_from_object});
        scene_.object_nodes.push_back(static_cast<int>(scene_.nodes.size()) - 1);
        scene_.node_from_object.push_back(node_from_object);
    }

    std::vector<glm::dmat4> readInstances(const tinygltf::Value& extension, const std::string& path) const {
        if (!extension.IsObject() || !extension.Has("attributes") || !extension.Get("attributes").IsObject())
            fail(path, "has no `attributes`");
        const tinygltf::Value& attributes = extension.Get("attributes");
        std::optional<size_t> count;
        const auto read = [&]<class Vector>(const char* key, Vector) {
            if (!attributes.Has(key)) return std::vector<Vector>{};
            const tinygltf::Value& accessor = attributes.Get(key);
            std::vector<Vector> values = accessors_.vectors<Vector>(accessor.IsInt() ? accessor.GetNumberAsInt() : -1);
            if (count.value_or(values.size()) != values.size()) fail(path, "has attributes of different counts");
            count = values.size();
            return values;
        };
        const auto translations = read("TRANSLATION", glm::vec3());
        const auto rotations = read("ROTATION", glm::vec4());
        const auto scales = read("SCALE", glm::vec3());
        std::vector<glm::dmat4> instances;
        for (size_t i = 0; i < count.value_or(0); ++i) {
            const glm::dvec4 q = rotations.empty() ? glm::dvec4(0, 0, 0, 1) : glm::dvec4(rotations[i]);
            if (!(glm::length(q) > 1e-6)) fail(path, "has a rotation without length; must be unit quaternions");
            instances.push_back(compose(translations.empty() ? glm::dvec3(0) : glm::dvec3(translations[i]),
                                        glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)),
                                        scales.empty() ? glm::dvec3(1) : glm::dvec3(scales[i])));
        }
        return instances;
    }

    /** Index into Geometry::meshes, -1 for a mesh without triangles. Reads the mesh on its first use. */
    int meshIndex(size_t mesh) {
        const auto [known, is_new] = mesh_indices_.try_emplace(mesh, -1);
        if (!is_new) return known->second;
        types::Mesh read = meshes_.read(mesh);
        if (read.indices.empty()) return -1;
        known->second = static_cast<int>(geometry_.meshes.size());
        cluster(std::move(read));
        return known->second;
    }

    /** Adds a mesh in clusters. A large mesh is split while others are read, and is stored by finishMeshes(). */
    void cluster(types::Mesh&& mesh) {
        types::Mesh& place = geometry_.meshes.emplace_back();
        if (mesh.indices.size() / 3 <= clustered_from) {
            buildClusters(mesh);
            place = std::move(mesh);
            return;
        }
        auto built = [mesh = std::move(mesh)]() mutable {
            buildClusters(mesh);
            return std::move(mesh);
        };
        if (building_.size() >= std::max(1u, std::thread::hardware_concurrency())) finishMeshes();
        building_.emplace_back(geometry_.meshes.size() - 1, std::async(std::launch::async, std::move(built)));
    }

    void finishMeshes() {
        for (auto& [place, mesh] : building_) geometry_.meshes[place] = mesh.get();
        building_.clear();
    }

    void addNotices() {
        std::vector<std::string>& notices = geometry_.notices;
        notices.insert(notices.end(), gltf_.notices.begin(), gltf_.notices.end());
        const auto count = [&notices](size_t number, const char* what) { addCount(number, what, notices); };
        const Omissions& omissions = meshes_.omissions();
        omissions.dropped.addTo(notices);
        count(omissions.other_primitives, "primitives of points or lines omitted, they have no surface");
        count(omissions.morphed_meshes, "meshes with morph targets loaded unmorphed");
        count(omissions.unmapped_primitives, "primitives loaded without their map, they have no texture coordinates");
        count(flat_objects_, "objects omitted, their scale is zero in some direction");
        count(gltf_.model.animations.size(), "animations not played, the scene is loaded at rest");
        if (has_skin_) notices.push_back("skins not applied, the meshes are loaded at rest");
        if (geometry_.objects.empty()) notices.push_back("the scene has no triangles: an empty sea");
    }

    [[noreturn]] void fail(const std::string& path, const std::string& message) const {
        throw types::ConfigError(gltf_.name, path, message);
    }

    types::Geometry geometry_;
    Scene scene_;
    GltfFile gltf_;
    GltfAccessors accessors_;
    GltfMeshes meshes_;
    std::vector<std::pair<size_t, std::future<types::Mesh>>> building_;
    std::map<size_t, int> mesh_indices_;
    UniqueNames names_;
    size_t flat_objects_ = 0;
    bool has_skin_ = false;
};

}  // namespace

Scene readGltf(const std::filesystem::path& file) { return GltfReader(file).read(); }

}  // namespace insonify::scene
