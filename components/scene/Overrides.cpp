#include "components/scene/Overrides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "types/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** True when the name belongs to a material. */
bool overrideMaterial(types::Geometry& geometry, const std::string& name, const Acoustics& acoustics) {
    bool found = false;
    for (types::Material& material : geometry.materials)
        if (material.name == name) {
            acoustics.applyTo(material);
            found = true;
        }
    return found;
}

/** Gives an object a mesh of its own whose materials are its own as well. */
void overrideObject(types::Geometry& geometry, types::Object& object, const Acoustics& acoustics) {
    types::Mesh mesh = geometry.meshes[static_cast<size_t>(object.mesh)];
    std::map<int, int> own;
    for (types::Cluster& cluster : mesh.clusters) {
        const auto [known, is_new] = own.try_emplace(cluster.material, static_cast<int>(geometry.materials.size()));
        if (is_new) {
            types::Material material = geometry.materials[static_cast<size_t>(cluster.material)];
            acoustics.applyTo(material);
            geometry.materials.push_back(std::move(material));
        }
        cluster.material = known->second;
    }
    object.mesh = static_cast<int>(geometry.meshes.size());
    geometry.meshes.push_back(std::move(mesh));
}

types::Diagnostic unknown(const Scene& scene, const std::string& name) {
    std::set<std::string> names;
    for (const types::Material& material : scene.geometry->materials) names.insert(material.name);
    for (const Node& node : scene.nodes) names.insert(node.name);
    constexpr size_t shown = 50;
    const auto last = names.size() <= shown ? names.end() : std::next(names.begin(), shown);
    const std::string near = types::didYouMean(name, {names.begin(), names.end()});
    return {"materials." + name, fmt::format("is neither a material nor a model of the scene; {}may be {}{}", near,
                                             fmt::join(names.begin(), last, ", "), last == names.end() ? "" : ", ...")};
}

}  // namespace

types::GeometryPtr overrideMaterials(const Scene& scene, const std::map<std::string, Acoustics>& materials,
                                     types::Diagnostics& diagnostics) {
    if (materials.empty()) return scene.geometry;
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    std::set<std::string> used;
    for (const auto& [name, acoustics] : materials)
        if (overrideMaterial(*geometry, name, acoustics)) used.insert(name);
    for (const auto& [name, acoustics] : materials) {
        const int node = findNode(scene, name);
        if (node < 0 && !used.contains(name)) diagnostics.push_back(unknown(scene, name));
        if (node >= 0)
            for (const Part& part : partsOf(scene, node))
                overrideObject(*geometry, geometry->objects[part.object], acoustics);
    }
    return geometry;
}

}  // namespace insonify::scene
