#include "components/scene/gltf/Gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "components/scene/Clusters.hpp"
#include "components/scene/UniqueNames.hpp"
#include "components/scene/gltf/GltfAnimation.hpp"
#include "components/scene/gltf/GltfFile.hpp"
#include "components/scene/gltf/GltfMesh.hpp"
#include "components/scene/motion/Animator.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** Max number of instances and nodes together. */
constexpr size_t max_objects = 1'000'000;
/** A small file may let any number of nodes share a mesh that deforms, of which each has a copy. */
constexpr size_t max_posed = 200'000'000;

/** A node whose mesh has a skin or morph targets. */
struct DeformingNode {
    int node;                                 ///< Number in the file.
    std::shared_ptr<const types::Mesh> mesh;  ///< Before joints and targets move it.
    GltfSkin skin;
    std::string path;
};

/** Visits the nodes of one file's scene and collects objects. */
class GltfReader {
public:
    explicit GltfReader(const std::filesystem::path& file)
        : gltf_(readGltfFile(file)),
          accessors_(gltf_.model, gltf_.name),
          meshes_(gltf_, accessors_, readMaterials(gltf_, accessors_, geometry_), geometry_),
          node_in_scene_(gltf_.model.nodes.size(), -1) {}

    Scene read() {
        walk(rootNodes());
        finishMeshes();
        addAnimations();
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
        node.name = names_.add(getName(from, visit.node), !from.name.empty());
        const NodeShape shape = getShape(from, path);
        node.parent_from_node = from.matrix.empty() ? shape.matrix() : toMatrix(from, path);
        node.scale = shape.scale;
        node_in_scene_[static_cast<size_t>(visit.node)] = static_cast<int>(scene_.nodes.size());
        const glm::dmat4 world_from_node = visit.world_from_parent * node.parent_from_node;
        if (visit.parent < 0) node.parent_from_node = world_from_node;
        if (!isFinite(world_from_node)) fail(path, "has a transform that is not finite");
        scene_.nodes.push_back(node);
        world_from_node_.push_back(world_from_node);
        if (from.mesh >= 0)
            addObjects(visit.node, node.name, world_from_node, path);
        else if (from.mesh != -1)
            fail(path + ".mesh", fmt::format("is {}", from.mesh));
        return world_from_node;
    }

    std::string getName(const tinygltf::Node& node, int index) const {
        if (!node.name.empty()) return node.name;
        const auto mesh = static_cast<size_t>(node.mesh);
        if (node.mesh >= 0 && mesh < gltf_.model.meshes.size() && !gltf_.model.meshes[mesh].name.empty())
            return gltf_.model.meshes[mesh].name;
        return fmt::format("node_{}", index);
    }

    /** Whether a list of a node has numbers; their number must be `count`. */
    bool has(const std::vector<double>& values, size_t count, const std::string& path) const {
        if (!values.empty() && values.size() != count)
            fail(path, fmt::format("has {} numbers; must have {}", values.size(), count));
        return !values.empty();
    }

    glm::dmat4 toMatrix(const tinygltf::Node& node, const std::string& path) const {
        has(node.matrix, 16, path + ".matrix");
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
        for (int c = 0; c < 4; ++c) matrix[c][3] = c == 3;
        return matrix;
    }

    /** Neutral for a node with a matrix. */
    NodeShape getShape(const tinygltf::Node& node, const std::string& path) const {
        NodeShape shape;
        if (!node.matrix.empty()) return shape;
        if (has(node.translation, 3, path + ".translation"))
            shape.translation = {node.translation[0], node.translation[1], node.translation[2]};
        if (has(node.scale, 3, path + ".scale")) shape.scale = {node.scale[0], node.scale[1], node.scale[2]};
        if (has(node.rotation, 4, path + ".rotation")) {
            shape.rotation = {node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]};
            const double length = glm::length(shape.rotation);
            if (!(length > 1e-6) || !std::isfinite(length))
                fail(path + ".rotation", "has no length; must be a unit quaternion x, y, z, w");
            shape.rotation /= length;
        }
        return shape;
    }

    void addObjects(int number, const std::string& name, const glm::dmat4& world_from_node, const std::string& path) {
        const tinygltf::Node& node = gltf_.model.nodes[static_cast<size_t>(number)];
        if (static_cast<size_t>(node.mesh) >= gltf_.model.meshes.size())
            fail(path + ".mesh", fmt::format("is {}; the file has {}", node.mesh, gltf_.model.meshes.size()));
        const bool deforms = node.skin != -1 || targetCount(gltf_, static_cast<size_t>(node.mesh)) > 0;
        const int mesh = deforms ? deformingIndex(number, path) : meshIndex(static_cast<size_t>(node.mesh));
        if (mesh == no_mesh) return;
        drawn_.transparency = 1 - meshes_.opacityOfMesh(static_cast<size_t>(node.mesh));
        const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
        if (instancing == node.extensions.end()) return addObject(name, mesh, world_from_node, glm::dmat4(1), path);
        const std::vector<glm::dmat4> instances =
            readInstances(instancing->second, path + ".extensions.EXT_mesh_gpu_instancing");
        for (size_t i = 0; i < instances.size(); ++i)
            addObject(names_.add(fmt::format("{}[{}]", name, i), false), mesh, world_from_node, instances[i], path);
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
        scene_.drawings.push_back(drawn_);
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
            NodeShape shape;
            if (!translations.empty()) shape.translation = translations[i];
            shape.rotation = glm::normalize(glm::dquat(q.w, q.x, q.y, q.z));
            if (!scales.empty()) shape.scale = scales[i];
            instances.push_back(shape.matrix());
        }
        return instances;
    }

    static constexpr int no_mesh = -1;

    /** Index into Geometry::meshes, no_mesh for a mesh without triangles. Reads the mesh on its first use. */
    int meshIndex(size_t mesh) {
        const auto [known, is_new] = mesh_indices_.try_emplace(mesh, no_mesh);
        if (!is_new) return known->second;
        types::Mesh read = meshes_.read(mesh);
        if (read.indices.empty()) return no_mesh;
        known->second = static_cast<int>(geometry_.meshes.size());
        cluster(std::move(read));
        return known->second;
    }

    /** The number of a node among those that deform, as -2 and less; no_mesh for a mesh without triangles. */
    int deformingIndex(int number, const std::string& path) {
        const tinygltf::Node& node = gltf_.model.nodes[static_cast<size_t>(number)];
        DeformingNode deforming{number, nullptr, {}, path};
        if (node.skin != -1) deforming.skin = readSkin(gltf_, accessors_, node.skin, path + ".skin");
        const auto [known, is_new] = deforming_meshes_.try_emplace({node.mesh, node.skin});
        if (is_new)
            known->second = std::make_shared<const types::Mesh>(
                meshes_.readDeforming(static_cast<size_t>(node.mesh), deforming.skin.joints.size()));
        if (known->second->indices.empty()) return no_mesh;
        deforming.mesh = known->second;
        deforming_.push_back(std::move(deforming));
        return no_mesh - static_cast<int>(deforming_.size());
    }

    /** Gives objects that deform a mesh in the shape that the nodes of the file give it. */
    void poseAtRest(std::vector<DeformingObject>& objects) {
        const NodePlaces places{world_from_node_, std::vector<glm::dmat4>(world_from_node_.size(), glm::dmat4(0))};
        for (size_t i = 0; i < geometry_.objects.size(); ++i) {
            types::Object& object = geometry_.objects[i];
            if (object.mesh >= 0) continue;
            const DeformingNode& from = deforming_[static_cast<size_t>(no_mesh - object.mesh - 1)];
            DeformingObject& deforming = objects.emplace_back();
            deforming.object = i;
            deforming.joint_from_bind = from.skin.joint_from_bind;
            const tinygltf::Node& node = gltf_.model.nodes[static_cast<size_t>(from.node)];
            for (size_t k = 0; k < from.skin.joints.size(); ++k) {
                const int joint = from.skin.joints[k];
                deforming.joints.push_back(node_in_scene_[static_cast<size_t>(joint)]);
                if (deforming.joints.back() < 0)
                    fail(fmt::format("skins[{}].joints[{}]", node.skin, k),
                         fmt::format("is nodes[{}], which is not in the scene", joint));
            }
            posed_ += from.mesh->positions.size() + from.mesh->indices.size();
            if (posed_ > max_posed)
                fail(
                    from.path,
                    fmt::format("brings the file over {} vertices and indices of meshes that deform, one mesh for each "
                                "node",
                                max_posed));
            deforming.rest_weights = restWeights(gltf_, node, from.path);
            types::Mesh mesh = *from.mesh;
            scene::poseAtRest(deforming, scene_.object_nodes[i], places, mesh);
            object.mesh = static_cast<int>(geometry_.meshes.size());
            geometry_.meshes.push_back(std::move(mesh));
        }
    }

    void addAnimations() {
        auto animations = std::make_shared<Animations>();
        poseAtRest(animations->objects);
        GltfAnimations read = readAnimations(gltf_, accessors_, node_in_scene_);
        animations->all = std::move(read.all);
        not_animated_ = {read.other_paths, read.outside_scene, read.doubled};
        std::set<int> moved;
        for (const Animation& animation : animations->all)
            for (const Channel& channel : animation.channels)
                if (channel.path != AnimatedPath::Weights) moved.insert(channel.node);
        for (size_t i = 0; i < node_in_scene_.size(); ++i)
            if (const int node = node_in_scene_[i]; moved.contains(node))
                animations->nodes.push_back(
                    {node, scene_.nodes[static_cast<size_t>(node)].parent < 0 ? z_up_from_y_up : glm::dmat4(1),
                     getShape(gltf_.model.nodes[i], fmt::format("nodes[{}]", i))});
        std::ranges::sort(animations->nodes, {}, &AnimatedNode::node);
        if (!animations->empty()) scene_.animations = std::move(animations);
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
        constexpr auto if_possible = std::launch::async | std::launch::deferred;  // without a thread on this one
        building_.emplace_back(geometry_.meshes.size() - 1, std::async(if_possible, std::move(built)));
    }

    void finishMeshes() {
        for (auto& [place, mesh] : building_) geometry_.meshes[place] = mesh.get();
        building_.clear();
    }

    void addNotices() {
        types::Notices& notices = geometry_.notices;
        notices.insert(notices.end(), gltf_.notices.begin(), gltf_.notices.end());
        const auto count = [&notices](size_t number, const char* what) { addCount(number, what, notices); };
        const Omissions& omissions = meshes_.omissions();
        omissions.dropped.addTo(notices);
        count(omissions.other_primitives, "primitives of points or lines omitted, they have no surface");
        count(omissions.unweighted_vertices, "vertices of skins without weights follow the first joint of their skin");
        count(omissions.unmapped_primitives, "primitives loaded without their map, they have no texture coordinates");
        count(flat_objects_, "objects omitted, their scale is zero in some direction");
        count(not_animated_[0], "channels of animations omitted, they animate what is not read");
        count(not_animated_[1], "channels of animations omitted, their nodes are not in the scene");
        count(not_animated_[2], "channels of animations omitted, an earlier one animates the same");
        for (const int material : omissions.invisible)
            scene_.omitted.push_back({geometry_.materials[static_cast<size_t>(material)].name,
                                      "the material is wholly transparent (alpha) and has no acoustics"});
        if (const std::string renamed = names_.describeRenamed(); !renamed.empty()) notices.push_back(renamed);
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
    Drawing drawn_;  ///< How the objects of the present node are drawn.
    size_t flat_objects_ = 0;
    std::array<size_t, 3> not_animated_{};     ///< Channels of other paths, outside of the scene, doubled.
    std::vector<int> node_in_scene_;           ///< One per node of the file, -1 if it is not in the scene.
    std::vector<glm::dmat4> world_from_node_;  ///< One per node of the scene.
    std::vector<DeformingNode> deforming_;
    size_t posed_ = 0;  ///< Vertices and indices of meshes that were posed.
    /** Meshes before joints and targets move them, by mesh and skin of the file. */
    std::map<std::pair<int, int>, std::shared_ptr<const types::Mesh>> deforming_meshes_;
};

}  // namespace

Scene readGltf(const std::filesystem::path& file) { return GltfReader(file).read(); }

}  // namespace insonify::scene
