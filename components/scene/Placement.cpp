#include "components/scene/Placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "components/scene/gltf/Gltf.hpp"
#include "components/scene/motion/Animator.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/Extent.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** Returns the rotation that turns an axis of the file to z. */
glm::dmat4 turnTo(UpAxis up) {
    switch (up) {
        case UpAxis::X: return {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        case UpAxis::Y: return z_up_from_y_up;
        default: return glm::dmat4(1);
    }
}

glm::dmat4 zUpFromFile(const Scene& scene, const Placement& placement) {
    return placement.up ? turnTo(*placement.up) : scene.z_up_from_file;
}

glm::dmat4 worldFromZUp(const Placement& placement) {
    const types::Axes axes{placement.frame};
    const glm::dmat3 frame(axes.rockFromWorld({1, 0, 0}), axes.rockFromWorld({0, 1, 0}), axes.rockFromWorld({0, 0, 1}));
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), placement.position);
    return glm::rotate(moved, types::radians(placement.yaw_deg), {0, 0, 1}) * glm::dmat4(frame);
}

/** Returns "x" or "-z", or the numbers of a direction that is along no axis. */
std::string getName(const glm::dvec3& direction) {
    constexpr double near = 1 - 1e-9;
    for (int axis = 0; axis < 3; ++axis)
        if (glm::abs(direction[axis]) > near)
            return std::string(direction[axis] < 0 ? "-" : "") + static_cast<char>('x' + axis);
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", direction.x, direction.y, direction.z);
}

/** Returns whether a file states neither unit nor up axis. */
bool isBare(const std::filesystem::path& file) {
    const std::string extension = getExtension(file);
    return extension == ".obj" || extension == ".stl" || extension == ".ply";
}

}  // namespace

Scene placed(const Scene& scene, const Placement& placement) {
    const glm::dmat4 z_up_from_file = zUpFromFile(scene, placement);
    const glm::dmat4 sized = glm::scale(glm::dmat4(1), glm::dvec3(placement.scale.value_or(1)));
    const glm::dmat4 placed_from_scene =
        worldFromZUp(placement) * z_up_from_file * glm::inverse(scene.z_up_from_file) * sized;
    Scene result = scene;
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    for (types::Object& object : geometry->objects)
        object.world_from_object = placed_from_scene * object.world_from_object;
    for (Node& node : result.nodes)
        if (node.parent < 0) node.parent_from_node = placed_from_scene * node.parent_from_node;
    if (scene.animations) {
        Animations animations = *scene.animations;
        for (AnimatedNode& node : animations.nodes)
            if (scene.nodes[static_cast<size_t>(node.node)].parent < 0) node.before = placed_from_scene * node.before;
        result.animations = std::make_shared<const Animations>(std::move(animations));
    }
    result.geometry = std::move(geometry);
    result.z_up_from_file = z_up_from_file;
    return result;
}

Scene scaled(const Scene& scene, const std::map<std::string, double>& factors, types::Diagnostics& diagnostics) {
    Scene result = scene;
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    std::vector<std::string> names;
    for (const Node& node : scene.nodes) names.push_back(node.name);
    for (const auto& [name, factor] : factors)
        if (findNode(scene, name) < 0)
            diagnostics.push_back({"scale." + name, "is no node of the scene; " + types::didYouMean(name, names) +
                                                        "insonify scene lists them"});
    std::shared_ptr<Animations> animations;
    if (scene.animations) animations = std::make_shared<Animations>(*scene.animations);
    std::vector<glm::dmat4> world_from_node;                             // with the nodes above at their scaled size
    std::vector<glm::dmat4> resized(scene.nodes.size(), glm::dmat4(1));  // below each node, in the world
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = result.nodes[i];
        const bool has_parent = node.parent >= 0;
        const auto parent = static_cast<size_t>(node.parent);
        world_from_node.push_back(has_parent ? world_from_node[parent] * node.parent_from_node : node.parent_from_node);
        if (has_parent) resized[i] = resized[parent];
        const auto factor = factors.find(node.name);
        if (factor == factors.end()) continue;
        const glm::dmat4 about_origin = glm::scale(glm::dmat4(1), glm::dvec3(factor->second));
        resized[i] = world_from_node[i] * about_origin * glm::inverse(world_from_node[i]) * resized[i];
        if (animations)
            for (AnimatedNode& animated : animations->nodes)
                if (animated.node == static_cast<int>(i)) animated.after = animated.after * about_origin;
        node.parent_from_node = node.parent_from_node * about_origin;
        node.scale *= factor->second;
        world_from_node[i] = world_from_node[i] * about_origin;
    }
    for (size_t i = 0; i < geometry->objects.size(); ++i) {
        const int node = result.object_nodes[i];
        if (node >= 0 && resized[static_cast<size_t>(node)] != glm::dmat4(1))
            geometry->objects[i].world_from_object =
                resized[static_cast<size_t>(node)] * geometry->objects[i].world_from_object;
    }
    if (animations) {
        const NodePlaces places{world_from_node, std::vector<glm::dmat4>(world_from_node.size(), glm::dmat4(0))};
        for (const DeformingObject& object : animations->objects)
            poseAtRest(object, result.object_nodes[object.object], places,
                       geometry->meshes[static_cast<size_t>(geometry->objects[object.object].mesh)]);
    }
    result.animations = std::move(animations);
    result.geometry = std::move(geometry);
    return result;
}

std::string describeLay(const Scene& scene, const Placement& placement, types::WorldFrame poses) {
    const glm::dmat3 file_from_world(glm::inverse(worldFromZUp(placement) * zUpFromFile(scene, placement)));
    const auto name = [&](const glm::dvec3& world) { return getName(file_from_world * world); };
    std::string text = fmt::format("the file's {} is north, its {} west, its {} up", name({1, 0, 0}), name({0, 1, 0}),
                                   name({0, 0, 1}));
    if (poses == types::WorldFrame::AsIs) return text;
    return text + fmt::format("; x of the poses, in {}, is along its {}, y along its {}",
                              types::EnumNames<types::WorldFrame>::names[static_cast<size_t>(poses)],
                              name(types::Axes{poses}.rockFromWorld({1, 0, 0})),
                              name(types::Axes{poses}.rockFromWorld({0, 1, 0})));
}

std::string sideWarning(const types::Geometry& geometry, const std::filesystem::path& file) {
    const bool is_gltf = isGltf(file);
    if (!is_gltf && !isBare(file)) return "";
    constexpr double suspicious = 0.6;  // share of the surface
    constexpr size_t enough = 20'000;   // triangles of an object that are added
    glm::dvec3 facing(0);               // [m2]
    for (const types::Object& object : geometry.objects) {
        const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
        const auto corner = [&](size_t k) {
            return glm::dvec3(object.world_from_object * glm::dvec4(mesh.positions[mesh.indices[k]], 1));
        };
        const size_t step = 1 + mesh.indices.size() / 3 / enough;
        for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3 * step)
            facing += glm::abs(glm::cross(corner(k + 1) - corner(k), corner(k + 2) - corner(k))) *
                      (0.5 * static_cast<double>(step));
    }
    const double all = facing.x + facing.y + facing.z;
    const glm::dvec3 size = types::getExtent(geometry).size();
    if (facing.y <= suspicious * all || size.z <= 2 * size.y) return "";
    const char* const text =
        is_gltf
            ? "the scene may lie on its side: {:.0f} % of its surface faces along y, and it is {:.3g} m high and "
              "{:.3g} "
              "m wide in y. glTF is y-up; a file written with z up looks like this: export it with +Y up, or set "
              "placement.up: z of its task"
            : "the scene may lie on its side: {:.0f} % of its surface faces along y, and it is {:.3g} m high and "
              "{:.3g} "
              "m wide in y. OBJ, STL and PLY are taken as z-up; a file written with y up looks like this: export it "
              "with Z up, or set placement.up: y of its task";
    return fmt::format(fmt::runtime(text), 100 * facing.y / all, size.z, size.y);
}

std::optional<types::Notice> askUnit(const std::filesystem::path& file, const glm::dvec3& size, const char* remedy) {
    constexpr double doubtful = 100, longest_ship = 500, flattest = 0.1;
    const double most = std::max({size.x, size.y, size.z}), least = std::min({size.x, size.y, size.z});
    if (!isBare(file) || most < doubtful) return {};
    const std::string text = fmt::format(
        "{} is {:.4g} x {:.4g} x {:.4g} m: it states no unit and is taken as metres; if it is in millimetres, {}",
        file.filename().string(), size.x, size.y, size.z, remedy);
    return most >= longest_ship && least >= flattest * most ? types::warning(text) : types::Notice(text);
}

}  // namespace insonify::scene
