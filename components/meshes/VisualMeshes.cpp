#include "components/meshes/VisualMeshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "components/meshes/MeshFile.hpp"
#include "components/scene/Clusters.hpp"

namespace insonify::meshes {

using namespace scene;

int VisualMeshes::material(types::Material material, const Look& look) {
    if (!look.name.empty()) material.name = look.name;
    types::Diagnostics none;
    if (!look.acoustics.empty()) readAcoustics(look.acoustics, "/", none).applyTo(material);
    geometry_.materials.push_back(std::move(material));
    return static_cast<int>(geometry_.materials.size()) - 1;
}

int VisualMeshes::add(Surface surface, const std::string& name, const Look& look) {
    const auto [known, is_new] = materials_.try_emplace(look, -1);
    if (is_new) known->second = material({.name = "default"}, look);
    types::Mesh mesh;
    mesh.name = name;
    appendSurface(surface, known->second, mesh);
    buildClusters(mesh);
    geometry_.meshes.push_back(std::move(mesh));
    return static_cast<int>(geometry_.meshes.size()) - 1;
}

const std::vector<Placing>& VisualMeshes::file(const std::filesystem::path& path, const std::string& submesh,
                                               const Look& look) {
    const types::GeometryPtr& read = readOnce(path);
    const auto [known, is_new] = placings_.try_emplace({path.string(), submesh, look});
    if (is_new) known->second = merge(*read, submesh, look);
    return known->second;
}

const types::GeometryPtr& VisualMeshes::readOnce(const std::filesystem::path& path) {
    const auto [known, is_new] = files_.try_emplace(path.string());
    FileRead& read = known->second;
    if (is_new) try {
            read.geometry = readMeshFile(path, MeshAxes::AsStored);
            for (const types::Notice& notice : read.geometry->notices)
                geometry_.notices.push_back({fmt::format("{}: {}", path.string(), notice.text), notice.kind});
        } catch (const types::ConfigError& failure) {
            read.failure = failure;
        }
    if (read.failure) throw types::ConfigError(*read.failure);
    return read.geometry;
}

std::vector<Placing> VisualMeshes::merge(const types::Geometry& from, const std::string& submesh, const Look& look) {
    std::vector<Placing> placings;
    std::map<int, int> meshes, materials;  // indices in geometry_ by indices in `from`
    for (const types::Object& object : from.objects) {
        const std::string& mesh_name = from.meshes[static_cast<size_t>(object.mesh)].name;
        if (!submesh.empty() && submesh != object.name && submesh != mesh_name) continue;
        const auto [known, is_new] = meshes.try_emplace(object.mesh, -1);
        if (is_new) known->second = mergeMesh(from, object.mesh, look, materials);
        placings.push_back({known->second, object.world_from_object});
    }
    return placings;
}

int VisualMeshes::mergeMesh(const types::Geometry& from, int index, const Look& look, std::map<int, int>& materials) {
    types::Mesh mesh = from.meshes[static_cast<size_t>(index)];
    const auto merged = [&](int there) {
        const auto [known, is_new] = materials.try_emplace(there, -1);
        if (is_new) {
            types::Material own = from.materials[static_cast<size_t>(there)];
            if (own.normal_map >= 0) {
                geometry_.normal_maps.push_back(from.normal_maps[static_cast<size_t>(own.normal_map)]);
                own.normal_map = static_cast<int>(geometry_.normal_maps.size()) - 1;
            }
            known->second = material(std::move(own), look);
        }
        return known->second;
    };
    for (types::Cluster& cluster : mesh.clusters) cluster.material = merged(cluster.material);
    for (types::MappedMaterial& mapped : mesh.maps) {
        types::SurfaceMap map = *mapped.map;
        std::ranges::transform(map.materials, map.materials.begin(), merged);
        mapped = {merged(mapped.material), std::make_shared<const types::SurfaceMap>(std::move(map))};
    }
    geometry_.meshes.push_back(std::move(mesh));
    return static_cast<int>(geometry_.meshes.size()) - 1;
}

types::Extent VisualMeshes::extent(const std::vector<Placing>& placings) const {
    types::Extent box;
    for (const Placing& placing : placings)
        box.add(types::getExtent(geometry_.meshes[static_cast<size_t>(placing.mesh)], placing.visual_from_object));
    return box;
}

std::vector<Placing> VisualMeshes::centred(std::vector<Placing> placings) const {
    const types::Extent box = extent(placings);
    for (Placing& placing : placings)
        placing.visual_from_object =
            glm::translate(glm::dmat4(1), -(box.low + box.high) / 2.0) * placing.visual_from_object;
    return placings;
}

}  // namespace insonify::meshes
