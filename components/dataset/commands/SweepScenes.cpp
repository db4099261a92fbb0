#include "components/dataset/commands/SweepScenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "components/console/Sha256.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dataset {
namespace {

/** Returns the node's objects in the axes of the world, about the node's origin, turned as in the file. */
Placeable placeableOf(const scene::Scene& scene, const std::vector<scene::Part>& parts, bool tilts) {
    const types::Geometry& geometry = *scene.geometry;
    const scene::Part& first = parts.front();
    const glm::dmat4 world_from_body =
        geometry.objects[first.object].world_from_object * glm::inverse(first.body_from_object);
    Placeable placeable;
    placeable.filed.source_frame = "body";
    placeable.filed.target_frame = "world";
    placeable.filed.position = world_from_body[3];
    placeable.filed.orientation = glm::normalize(glm::quat_cast(glm::dmat3(world_from_body)));
    bool any = false;
    for (const scene::Part& part : parts)
        for (const glm::vec3& vertex :
             geometry.meshes[static_cast<size_t>(geometry.objects[part.object].mesh)].positions) {
            const glm::dvec3 in_body = part.body_from_object * glm::dvec4(vertex, 1);
            const glm::dvec3 turned = placeable.filed.orientation * in_body;
            placeable.radius = std::max(placeable.radius, std::hypot(turned.x, turned.y));
            placeable.low = any ? std::min(placeable.low, turned.z) : turned.z;
            if (tilts) placeable.points.emplace_back(turned);
            any = true;
        }
    return placeable;
}

types::Extent boxOf(const scene::Scene& scene, const std::vector<scene::Part>& parts) {
    types::Extent box;
    for (const scene::Part& part : parts) {
        const types::Object& object = scene.geometry->objects[part.object];
        box.add(types::extentOf(scene.geometry->meshes[static_cast<size_t>(object.mesh)], object.world_from_object));
    }
    return box;
}

void addTriangles(const scene::Scene& scene, size_t node, std::vector<std::array<glm::dvec3, 3>>& triangles) {
    for (const scene::Part& part : scene::partsOf(scene, static_cast<int>(node))) {
        const types::Object& object = scene.geometry->objects[part.object];
        const types::Mesh& mesh = scene.geometry->meshes[static_cast<size_t>(object.mesh)];
        const auto corner = [&](size_t i) {
            return glm::dvec3(object.world_from_object * glm::dvec4(mesh.positions[mesh.indices[i]], 1));
        };
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    }
}

/** Returns the triangles of all nodes that match a pattern. */
std::vector<std::array<glm::dvec3, 3>> groundOf(const scene::Scene& scene, const std::string& pattern) {
    std::vector<std::array<glm::dvec3, 3>> triangles;
    for (size_t node = 0; node < scene.nodes.size(); ++node)
        if (matches(pattern, scene.nodes[node].name)) addTriangles(scene, node, triangles);
    return triangles;
}

bool anyMatches(const std::vector<std::string>& patterns, const std::string& name) {
    return std::ranges::any_of(patterns, [&](const std::string& each) { return matches(each, name); });
}

void addNode(const Sweep& sweep, const scene::Scene& scene, size_t node, SceneParts& parts) {
    const std::string& name = scene.nodes[node].name;
    const std::vector<scene::Part> objects = scene::partsOf(scene, static_cast<int>(node));
    if (objects.empty()) return;
    for (const ObjectGroup& group : sweep.objects)
        if (anyMatches(group.avoid, name)) parts.boxes[name] = boxOf(scene, objects);
    const bool tilts = std::ranges::any_of(
        sweep.objects, [&](const ObjectGroup& group) { return group.tilts() && anyMatches(group.names, name); });
    parts.placeables[name] = placeableOf(scene, objects, tilts);
}

template <class T>
void addBytes(console::Sha256& hash, const std::vector<T>& values) {
    hash.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

void addMaterial(console::Sha256& hash, const types::Material& material) {
    hash.add(fmt::format("{} {} {} {} {} {} {} {} {} {}\n", material.name, material.lambert_db, material.seabed,
                         material.reflection, material.roughness_slope.value_or(-1), material.mirror,
                         material.reflectivity, material.has_acoustics, material.normal_map, material.normal_scale));
    if (!material.matter.empty()) hash.add(fmt::format("matter {}\n", material.matter));
    if (const auto& shell = material.shell)
        hash.add(fmt::format("shell {} {} {} {} {} {} {} {} {}\n", shell->thickness, shell->density, shell->sound_speed,
                             shell->shear_speed, shell->loss, shell->has_air, shell->fill_density, shell->fill_speed,
                             shell->fill_loss));
    addBytes(hash, material.measured);
}

void addMap(console::Sha256& hash, const types::MappedMaterial& mapped) {
    const types::SurfaceMap& map = *mapped.map;
    hash.add(fmt::format("map {} {} {} {} {}\n", mapped.material, map.width, map.height, map.repeat_u, map.repeat_v));
    addBytes(hash, map.strengths);
    addBytes(hash, map.classes);
    addBytes(hash, map.materials);
}

}  // namespace

SceneParts partsOf(const Sweep& sweep, const scene::Scene& scene) {
    SceneParts parts;
    if (sweep.objects.empty()) return parts;
    for (size_t node = 0; node < scene.nodes.size(); ++node) {
        addNode(sweep, scene, node, parts);
        parts.nodes.push_back(scene.nodes[node].name);
    }
    for (size_t i = 0; i < sweep.objects.size(); ++i) {
        const ObjectGroup& group = sweep.objects[i];
        const std::string path = fmt::format("objects[{}].", i);
        const auto isOfGroup = [&](const auto& each) { return anyMatches(group.names, each.first); };
        if (!group.ground || std::ranges::none_of(parts.placeables, isOfGroup)) continue;
        resolve(sweep, {*group.ground}, parts.nodes, path + "ground", group.line, group.column);
        auto& ground = parts.grounds[*group.ground] = groundOf(scene, *group.ground);
        if (ground.empty())
            throw types::ConfigError({{path + "ground", "is " + *group.ground + ", which has no surface to stand on",
                                       sweep.file, group.line, group.column}});
    }
    return parts;
}

std::vector<Lineage> lineages(const scene::Scene& scene) {
    std::vector<Lineage> all;
    for (size_t i = 0; i < scene.geometry->objects.size(); ++i) {
        Lineage& names = all.emplace_back(Lineage{scene.geometry->objects[i].name});
        for (int node = scene.object_nodes[i]; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent)
            if (scene.nodes[static_cast<size_t>(node)].name != names.back())
                names.push_back(scene.nodes[static_cast<size_t>(node)].name);
    }
    return all;
}

std::string digestOf(const types::Geometry& geometry) {
    console::Sha256 hash;
    for (const types::Mesh& mesh : geometry.meshes) {
        addBytes(hash, mesh.positions);
        addBytes(hash, mesh.normals);
        addBytes(hash, mesh.tangents);
        addBytes(hash, mesh.uvs);
        addBytes(hash, mesh.indices);
        for (const types::MappedMaterial& mapped : mesh.maps) addMap(hash, mapped);
        addBytes(hash, mesh.map_uvs);
        for (const types::Cluster& cluster : mesh.clusters)
            hash.add(fmt::format("{} {} {}\n", cluster.first_index, cluster.index_count, cluster.material));
    }
    for (const types::Object& object : geometry.objects) {
        hash.add(fmt::format("{}\n{}\n", object.name, object.mesh));
        hash.add({reinterpret_cast<const char*>(&object.world_from_object), sizeof object.world_from_object});
    }
    for (const types::Material& material : geometry.materials) addMaterial(hash, material);
    for (const types::NormalMap& map : geometry.normal_maps) {
        hash.add(fmt::format("{} {} {} {}\n", map.width, map.height, map.repeat_u, map.repeat_v));
        addBytes(hash, map.rgb);
    }
    return hash.hex();
}

}  // namespace insonify::dataset
