#include "components/scene/gltf/GltfMesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numeric>
#include <utility>

#include "components/scene/Clusters.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** Max vertices and indices of a file: a small file may refer to the same data any number of times. */
constexpr size_t max_elements = 200'000'000;

/** Returns the corners of triangles from the corners of a list, strip or fan. `restart` ends a strip or fan. */
std::vector<uint32_t> triangulate(std::vector<uint32_t>&& corners, int mode, uint32_t restart) {
    if (mode == TINYGLTF_MODE_TRIANGLES && std::ranges::find(corners, restart) == corners.end()) {
        corners.resize(corners.size() / 3 * 3);
        return std::move(corners);
    }
    std::vector<uint32_t> triangles;
    size_t first = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] == restart) {
            first = i + 1;
            continue;
        }
        const size_t k = i - first;
        if (k < 2) continue;
        if (mode == TINYGLTF_MODE_TRIANGLES && k % 3 == 2)
            triangles.insert(triangles.end(), {corners[i - 2], corners[i - 1], corners[i]});
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.insert(triangles.end(), {corners[first], corners[i - 1], corners[i]});
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
            triangles.insert(triangles.end(), {corners[i - 2 + k % 2], corners[i - 1 - k % 2], corners[i]});
    }
    return triangles;
}

glm::vec3 unitOr(glm::vec3 vector, glm::vec3 otherwise) {
    const float length = glm::length(vector);
    return std::isfinite(length) && length > 1e-12f ? vector / length : otherwise;
}

int getMode(const tinygltf::Primitive& primitive) {
    return primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
}

void normalise(Surface& surface) {
    for (glm::vec3& normal : surface.normals) normal = unitOr(normal, {0, 1, 0});
    for (glm::vec4& tangent : surface.tangents)
        tangent = glm::vec4(unitOr(glm::vec3(tangent), {1, 0, 0}), tangent.w < 0 ? -1.0f : 1.0f);
    for (auto* const uvs : {&surface.uvs, &surface.map_uvs})
        for (glm::vec2& uv : *uvs)
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = glm::vec2(0);
}

}  // namespace

void GltfMeshes::fail(const std::string& path, const std::string& message) const {
    throw types::ConfigError(gltf_.name, path, message);
}

void GltfMeshes::charge(size_t elements, const std::string& path) {
    elements_ += elements;
    if (elements_ > max_elements)
        fail(path, fmt::format("brings the file over {} vertices and indices; split it", max_elements));
}

int GltfMeshes::material(const tinygltf::Primitive& primitive, const std::string& path) {
    const size_t count = gltf_.model.materials.size();
    if (primitive.material >= 0 && static_cast<size_t>(primitive.material) < count) return primitive.material;
    if (primitive.material != -1)
        fail(path + ".material", fmt::format("is {}; the file has {}", primitive.material, count));
    if (default_material_ < 0) {
        default_material_ = static_cast<int>(geometry_.materials.size());
        geometry_.materials.emplace_back().name = "default";
    }
    return default_material_;
}

float GltfMeshes::opacityOfMesh(size_t mesh) const {
    const auto& primitives = gltf_.model.meshes[mesh].primitives;
    float opacity = primitives.empty() ? 1 : 0;
    for (const tinygltf::Primitive& primitive : primitives) opacity = std::max(opacity, getOpacity(primitive.material));
    return opacity;
}

int GltfMeshes::withoutMap(int material, bool of_surface) {
    ++omissions_.unmapped_primitives;
    const auto [known, is_new] =
        unmapped_.try_emplace({material, of_surface}, static_cast<int>(geometry_.materials.size()));
    if (is_new) {
        types::Material plain = geometry_.materials[static_cast<size_t>(material)];
        if (of_surface)
            plain.max_map_strength = 0;
        else
            plain.normal_map = -1;
        geometry_.materials.push_back(std::move(plain));
    }
    return known->second;
}

/** The accessors of a primitive. */
struct GltfMeshes::Attributes {
    const tinygltf::Primitive& primitive;
    const GltfMeshes& meshes;
    std::string path;
    size_t count;

    /** Returns an attribute; empty if the primitive does not have it. */
    template <class Vector>
    std::vector<Vector> read(const std::string& name) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return {};
        std::vector<Vector> values = meshes.accessors_.vectors<Vector>(found->second);
        if (values.size() != count)
            meshes.fail(path + ".attributes." + name,
                        fmt::format("has {} elements; POSITION has {}", values.size(), count));
        return values;
    }
    std::vector<glm::vec2> uvs(const NormalMapping& mapping) const {
        auto uvs = read<glm::vec2>(fmt::format("TEXCOORD_{}", mapping.uv_set));
        for (glm::vec2& uv : uvs) uv = mapping.transform * glm::vec3(uv, 1);
        return uvs;
    }
    /** Reads the attributes that a normal map needs. */
    void readMapped(const NormalMapping& mapping, Surface& surface) const {
        surface.uvs = uvs(mapping);
        if (surface.uvs.empty()) return;
        surface.normals = read<glm::vec3>("NORMAL");
        if (!surface.normals.empty()) surface.tangents = read<glm::vec4>("TANGENT");
    }
};

void GltfMeshes::append(const tinygltf::Primitive& primitive, const std::string& path, types::Mesh& mesh) {
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end()) return;
    const int mode = getMode(primitive);
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) fail(path + ".mode", fmt::format("is {}; may be 0 to 6", mode));
    if (mode < TINYGLTF_MODE_TRIANGLES) return void(++omissions_.other_primitives);
    const int drawn = material(primitive, path);
    if (getOpacity(drawn) == 0 && !geometry_.materials[static_cast<size_t>(drawn)].has_acoustics)
        return void(omissions_.invisible.insert(drawn));

    Surface surface = getSurface(primitive, positions->second, path);
    if (surface.indices.empty()) return;
    const int material = mapped(primitive, path, surface, mesh);
    numbers_.insert(numbers_.end(), surface.numbers.begin(), surface.numbers.end());
    appendSurface(surface, material, mesh);
}

Surface GltfMeshes::getSurface(const tinygltf::Primitive& primitive, int positions, const std::string& path) {
    Surface surface;
    surface.positions = accessors_.vectors<glm::vec3>(positions);
    const size_t count = surface.positions.size();
    charge(count, path);
    if (deformation_) {
        charge(count * primitive.targets.size(), path);
        surface.numbers.resize(count);
        std::iota(surface.numbers.begin(), surface.numbers.end(), deformation_->next());
        deformation_->add(primitive, path, count);
    }
    constexpr uint32_t no_restart = ~0u;
    std::vector<uint32_t> corners;
    uint32_t restart = no_restart;
    const int mode = getMode(primitive);
    if (primitive.indices >= 0) {
        corners = accessors_.indices(primitive.indices);
        if (mode != TINYGLTF_MODE_TRIANGLES) restart = accessors_.restartIndex(primitive.indices);
    } else {
        corners.resize(count);
        for (size_t i = 0; i < count; ++i) corners[i] = static_cast<uint32_t>(i);
    }
    charge(corners.size(), path);
    for (const uint32_t index : corners)
        if (index >= count && index != restart)
            fail(path + ".indices", fmt::format("hold {}; the primitive has {} vertices", index, count));
    surface.indices = triangulate(std::move(corners), mode, restart);
    cleanUp(surface, omissions_.dropped);
    return surface;
}

int GltfMeshes::mapped(const tinygltf::Primitive& primitive, const std::string& path, Surface& surface,
                       types::Mesh& mesh) {
    int index = material(primitive, path);
    const MaterialMaps* const maps = getMaps(index);
    if (!maps || (!maps->surface && !maps->normals)) return index;
    const Attributes attributes{primitive, *this, path, surface.positions.size()};
    if (maps->surface) surface.map_uvs = attributes.uvs(maps->on_surface);
    if (maps->normals) attributes.readMapped(*maps->normals, surface);
    normalise(surface);
    if (maps->normals) {
        if (surface.uvs.empty())
            index = withoutMap(index, false);
        else if (surface.normals.empty())
            makeFlatNormals(surface);
        if (!surface.uvs.empty() && surface.tangents.empty()) makeTangents(surface);
    }
    if (maps->surface && surface.map_uvs.empty())
        index = withoutMap(index, true);
    else if (maps->surface && std::ranges::find(mesh.maps, index, &types::MappedMaterial::material) == mesh.maps.end())
        mesh.maps.push_back({index, maps->surface});
    return index;
}

types::Mesh GltfMeshes::read(size_t index) {
    const tinygltf::Mesh& from = gltf_.model.meshes[index];
    types::Mesh mesh;
    mesh.name = from.name;
    for (size_t i = 0; i < from.primitives.size(); ++i)
        append(from.primitives[i], fmt::format("meshes[{}].primitives[{}]", index, i), mesh);
    fillAttributes(mesh);
    return mesh;
}

types::Mesh GltfMeshes::readDeforming(size_t index, size_t joints) {
    GltfDeformation deformation(gltf_, accessors_, index, joints);
    deformation_ = &deformation;
    numbers_.clear();
    types::Mesh mesh = read(index);
    deformation_ = nullptr;
    omissions_.unweighted_vertices += deformation.unweighted();
    if (mesh.indices.empty()) return mesh;
    buildClusters(mesh, &numbers_);
    mesh.deformation = std::make_shared<const types::Deformation>(deformation.make(mesh, numbers_));
    return mesh;
}

}  // namespace insonify::scene
