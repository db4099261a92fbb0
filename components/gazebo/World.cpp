#include "components/gazebo/World.hpp"

#include <fmt/format.h>
#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/TransportOptions.hpp"
#include "components/meshes/WorldBuilder.hpp"
#include "components/scene/Acoustics.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

constexpr size_t max_parts = 100'000;  ///< Max number of models, links and visuals of a world.

glm::dvec3 point(const wire::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/** Returns the matrix of a pose. A message omits the identity orientation. Not finite for an orientation without
 *  length. */
glm::dmat4 toMatrix(const wire::Pose& pose) {
    const wire::Quaternion& q = pose.orientation();
    const glm::dquat turn =
        pose.has_orientation() ? glm::normalize(glm::dquat(q.w(), q.x(), q.y(), q.z())) : glm::dquat(1, 0, 0, 0);
    const bool has_length = !pose.has_orientation() || glm::length(glm::dquat(q.w(), q.x(), q.y(), q.z())) > 0;
    const glm::dmat4 matrix = glm::translate(glm::dmat4(1), point(pose.position())) * glm::mat4_cast(turn);
    return has_length ? matrix : glm::dmat4(std::nan(""));
}

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/** Returns why the sizes of a shape are invalid; empty when they are valid. */
std::string reasonAgainst(const meshes::Shape& shape) {
    if (const types::Diagnostic fault = meshes::findFault(shape); !fault.message.empty())
        return fmt::format("its {} {}", fault.path, fault.message);
    if (const auto* mesh = std::get_if<meshes::MeshShape>(&shape); mesh && !isFinite(mesh->scale))
        return "its scale is not finite";
    if (const auto* map = std::get_if<meshes::HeightmapShape>(&shape);
        map && !(isFinite(map->size) && isFinite(map->position)))
        return "its size or position is not finite";
    const auto* plane = std::get_if<meshes::PlaneShape>(&shape);
    if (plane && !(isFinite(plane->normal) && isFinite({plane->size, 0}))) return "its normal or size is not finite";
    return "";
}

/** Whether a visual of a model casts a shadow. */
bool castsShadows(const wire::Model& model) {
    const auto has = [](const auto& holder) {
        return std::ranges::any_of(holder.visual(), &wire::Visual::cast_shadows);
    };
    return has(model) || std::ranges::any_of(model.link(), has) || std::ranges::any_of(model.model(), castsShadows);
}

class SceneReader {
public:
    /** A Gazebo that runs has resolved its paths, which may be anywhere. */
    explicit SceneReader(const std::filesystem::path& folder)
        : builder_(folder / "world", meshes::ModelPaths::Reach::Anywhere) {}

    World read(const wire::Scene& message) {
        for (const wire::Light& light : message.light()) names_.insert(light.name());
        sends_shadows_ = std::ranges::any_of(message.model(), castsShadows);
        for (const wire::Model& model : message.model()) addModel(model, "", -1, glm::dmat4(1));
        return {builder_.take(), std::move(names_)};
    }

private:
    /** `scope` is the name of the parent with "::" behind it. */
    void addModel(const wire::Model& model, const std::string& scope, int parent, const glm::dmat4& world_from_scope) {
        names_.insert(model.name());
        const auto node = addNode("model", scope + model.name(), parent, world_from_scope, model.pose());
        if (!node) return;
        const std::string inner = scope + model.name() + "::";
        const glm::dmat4 world_from_model = builder_.worldFromNode(*node);
        for (const wire::Visual& visual : model.visual()) addVisual(visual, inner, *node, {model.name()});
        for (const wire::Link& link : model.link()) {
            names_.insert(link.name());
            for (const wire::Light& light : link.light()) names_.insert(light.name());
            const auto below = addNode("link", inner + link.name(), *node, world_from_model, link.pose());
            if (!below) continue;
            for (const wire::Visual& visual : link.visual())
                addVisual(visual, inner + link.name() + "::", *below, {link.name(), model.name()});
        }
        for (const wire::Model& nested : model.model()) addModel(nested, inner, *node, world_from_model);
    }

    /** Returns the index of the new node; none when its pose is invalid. */
    std::optional<int> addNode(const char* kind, const std::string& name, int parent,
                               const glm::dmat4& world_from_parent, const wire::Pose& pose) {
        count();
        const glm::dmat4 world_from_node = world_from_parent * toMatrix(pose);
        if (!scene::isFinite(world_from_node)) {
            builder_.notice(
                fmt::format("{} {} is omitted: its pose is not finite, or its orientation has no length", kind, name));
            return {};
        }
        const int node = builder_.addNode(name, parent, world_from_node);
        if (const std::string& given = builder_.node(node).name; given != name)
            builder_.notice(fmt::format("{} {} exists twice; the second is named {} here", kind, name, given));
        return node;
    }

    /** `holders` are the names of its link and model, the innermost first. */
    void addVisual(const wire::Visual& visual, const std::string& scope, int node,
                   const std::vector<std::string>& holders) {
        count();
        names_.insert(visual.name());
        const std::string name = scope + visual.name();
        if (!visual.has_geometry()) return builder_.leaveOut(name, "it has no geometry");
        if (visual.geometry().type() == wire::Geometry::EMPTY) return;
        const glm::dmat4 node_from_visual = toMatrix(visual.pose());
        const meshes::Shape shape = getShape(visual.geometry());
        const std::string fault = scene::isFinite(node_from_visual)
                                      ? reasonAgainst(shape)
                                      : "its pose is not finite, or its orientation has no length";
        if (!fault.empty()) return builder_.leaveOut(name, fault);
        builder_.addVisual(
            name, node, node_from_visual, shape, {getMaterial(visual, holders), {}},
            {.transparency = visual.transparency(), .casts_shadow = visual.cast_shadows() || !sends_shadows_});
    }

    /** Returns the name of a material. Gazebo sends colours, but no names of materials; the name is that of the visual,
     *  or of its link or model, if it contains a matter. Empty for no material, or for a mesh, which has its own. */
    static std::string getMaterial(const wire::Visual& visual, const std::vector<std::string>& holders) {
        const std::string& given = visual.material().script().name();
        if (!given.empty() || visual.geometry().type() == wire::Geometry::MESH) return given;
        if (!scene::matterIn(visual.name()).empty()) return visual.name();
        for (const std::string& holder : holders)
            if (!scene::matterIn(holder).empty()) return holder;
        return "";
    }

    meshes::Shape getShape(const wire::Geometry& geometry) const {
        switch (geometry.type()) {
            case wire::Geometry::BOX: return meshes::BoxShape{point(geometry.box().size())};
            case wire::Geometry::SPHERE: return meshes::EllipsoidShape{glm::dvec3(geometry.sphere().radius()), true};
            case wire::Geometry::ELLIPSOID: return meshes::EllipsoidShape{point(geometry.ellipsoid().radii()), false};
            case wire::Geometry::CYLINDER:
                return meshes::CylinderShape{geometry.cylinder().radius(), geometry.cylinder().length()};
            case wire::Geometry::CONE: return meshes::ConeShape{geometry.cone().radius(), geometry.cone().length()};
            case wire::Geometry::CAPSULE:
                return meshes::CapsuleShape{geometry.capsule().radius(), geometry.capsule().length()};
            case wire::Geometry::PLANE: {
                const wire::Plane& plane = geometry.plane();
                return meshes::PlaneShape{plane.has_normal() ? point(plane.normal()) : glm::dvec3(0, 0, 1),
                                          {plane.size().x(), plane.size().y()}};
            }
            case wire::Geometry::MESH: {
                const wire::Mesh& mesh = geometry.mesh();
                return meshes::MeshShape{getPlace(mesh.filename()),
                                         mesh.submesh(),
                                         mesh.center_submesh(),
                                         mesh.has_scale() ? point(mesh.scale()) : glm::dvec3(1),
                                         {}};
            }
            case wire::Geometry::HEIGHTMAP: {
                const wire::Heightmap& map = geometry.heightmap();
                return meshes::HeightmapShape{getPlace(map.filename()), point(map.size()), point(map.origin()), {}};
            }
            default: return meshes::OtherShape{};
        }
    }

    /** Returns the path on this machine of a file with a path or URI on Gazebo's machine; `uri` itself if not found. */
    std::string getPlace(const std::string& uri) const {
        if (builder_.paths().find(uri, {})) return uri;
        const std::filesystem::path path = uri.starts_with("file://") ? uri.substr(7) : uri;
        if (!path.is_absolute()) return uri;
        std::filesystem::path last_parts = path.relative_path();
        while (last_parts.has_parent_path()) {  // at least a folder and the file
            if (const auto found = builder_.paths().find("model://" + last_parts.string(), {})) return found->string();
            last_parts = last_parts.lexically_relative(*last_parts.begin());
        }
        return uri;
    }

    void count() {
        if (++parts_ > max_parts)
            throw types::ConfigError("", "world",
                                     fmt::format("has more than {} models, links and visuals in Gazebo, which is too "
                                                 "many",
                                                 max_parts));
    }

    meshes::WorldBuilder builder_;
    std::set<std::string> names_;
    bool sends_shadows_ = false;  ///< Whether any visual has cast_shadows, which is absent where it is false.
    size_t parts_ = 0;
};

std::mutex taken_mutex;

/** Returns the names of entities by the qualified name of the world's service. */
std::map<std::string, std::set<std::string>>& taken() {
    static std::map<std::string, std::set<std::string>> worlds;
    return worlds;
}

std::string getService(const std::string& world) { return "/world/" + world + "/scene/info"; }

}  // namespace

World getWorld(std::string_view message, const std::filesystem::path& folder) {
    wire::Scene scene;
    if (message.size() >= size_t{1} << 31 || !scene.ParseFromArray(message.data(), static_cast<int>(message.size())))
        throw types::ConfigError("", "world", "has a service that answers bytes which are no message Scene");
    return SceneReader(folder).read(scene);
}

scene::Scene readWorld(const scene::GazeboConfig& config, const std::filesystem::path& folder) {
    const TransportOptions options = TransportOptions::fromEnvironment(config.partition);
    const std::string service = getService(config.world);
    const auto name = qualifiedName(options.partition, service);
    if (!name)
        throw types::ConfigError("", "world",
                                 "is " + config.world + ", which Gazebo's transport does not take for a name");
    const Reply reply =
        request(options, {service, "Empty", "Scene"}, "", std::chrono::duration<double>(config.timeout));
    if (!reply.failure.empty())
        throw types::ConfigError("", "world",
                                 fmt::format("is {}; its service {} {}", config.world, service, reply.failure));
    World world = getWorld(reply.message, folder);
    const std::lock_guard lock(taken_mutex);
    taken()[*name] = std::move(world.names);
    return std::move(world.scene);
}

std::string requestSdf(const scene::GazeboConfig& config) {
    const TransportOptions options = TransportOptions::fromEnvironment(config.partition);
    const std::string service = "/world/" + config.world + "/generate_world_sdf";
    if (!qualifiedName(options.partition, service))
        throw types::ConfigError("", "world",
                                 "is " + config.world + ", which Gazebo's transport does not take for a name");
    wire::SdfGeneratorConfig wanted;
    wanted.mutable_global_entity_gen_config()->mutable_expand_include_tags()->set_data(true);
    const Reply reply = request(options, {service, "SdfGeneratorConfig", "StringMsg"}, wanted.SerializeAsString(),
                                std::chrono::duration<double>(config.timeout));
    if (!reply.failure.empty())
        throw types::ConfigError("", "world",
                                 fmt::format("is {}; its service {} {}", config.world, service, reply.failure));
    wire::StringMsg text;
    if (!text.ParseFromString(reply.message) || text.data().empty())
        throw types::ConfigError("", "world",
                                 fmt::format("is {}; its service {} answers no SDF", config.world, service));
    return text.data();
}

std::optional<std::set<std::string>> namesTaken(const std::string& world, const std::string& partition) {
    const auto name = qualifiedName(partition, getService(world));
    const std::lock_guard lock(taken_mutex);
    const auto found = name ? taken().find(*name) : taken().end();
    return found == taken().end() ? std::nullopt : std::optional(found->second);
}

}  // namespace insonify::gazebo
