#include "components/scene/GltfMesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/scene/Tangents.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** A small file may refer to the same data any number of times; this many vertices and indices end it. */
constexpr size_t kMaxElements = 200'000'000;
/** Coordinates beyond are taken for damage: their squares leave the range of float [m]. */
constexpr float kMaxCoordinate = 1e15f;

bool isUsable(glm::vec3 p) {
    return std::abs(p.x) < kMaxCoordinate && std::abs(p.y) < kMaxCoordinate && std::abs(p.z) < kMaxCoordinate;
}

/** Corners of triangles from corners of a list, strip or fan; `restart` ends a strip or fan. */
std::vector<uint32_t> triangulate(const std::vector<uint32_t>& corners, int mode, uint32_t restart) {
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

/** Drops triangles that cannot be drawn, and counts them. */
void dropUseless(Surface& surface, Omissions& omissions) {
    size_t kept = 0;
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
        const uint32_t* corner = &surface.indices[i];
        const glm::vec3 a = surface.positions[corner[0]], b = surface.positions[corner[1]],
                        c = surface.positions[corner[2]];
        if (!isUsable(a) || !isUsable(b) || !isUsable(c)) {
            ++omissions.bad_triangles;
            continue;
        }
        const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
        if (normal == glm::dvec3(0)) {
            ++omissions.empty_triangles;
            continue;
        }
        std::copy_n(corner, 3, &surface.indices[kept]);
        kept += 3;
    }
    surface.indices.resize(kept);
}

/** Puts a harmless point where a vertex is damaged: no triangle uses it any more. */
void mendUnused(Surface& surface) {
    for (glm::vec3& position : surface.positions)
        if (!isUsable(position)) position = glm::vec3(0);
}

glm::vec3 unitOr(glm::vec3 vector, glm::vec3 otherwise) {
    const float length = glm::length(vector);
    return std::isfinite(length) && length > 1e-12f ? vector / length : otherwise;
}

void normalise(Surface& surface) {
    for (glm::vec3& normal : surface.normals) normal = unitOr(normal, {0, 1, 0});
    for (glm::vec4& tangent : surface.tangents)
        tangent = glm::vec4(unitOr(glm::vec3(tangent), {1, 0, 0}), tangent.w < 0 ? -1.0f : 1.0f);
    for (glm::vec2& uv : surface.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = glm::vec2(0);
}

/** `to` grows to `size` with `filler`, then takes `from`; nothing happens while both are empty. */
template <class T>
void appendFilled(std::vector<T>& to, const std::vector<T>& from, size_t size, T filler) {
    if (to.empty() && from.empty()) return;
    to.resize(size, filler);
    to.insert(to.end(), from.begin(), from.end());
}

/** Adds a surface to a mesh as one more cluster. */
void appendSurface(const Surface& surface, int material, types::Mesh& mesh) {
    const size_t base = mesh.positions.size();
    types::Cluster cluster;
    cluster.first_index = static_cast<uint32_t>(mesh.indices.size());
    cluster.index_count = static_cast<uint32_t>(surface.indices.size());
    cluster.material = material;
    mesh.clusters.push_back(cluster);
    appendFilled(mesh.normals, surface.normals, base, glm::vec3(0, 1, 0));
    appendFilled(mesh.tangents, surface.tangents, base, glm::vec4(1, 0, 0, 1));
    appendFilled(mesh.uvs, surface.uvs, base, glm::vec2(0));
    mesh.positions.insert(mesh.positions.end(), surface.positions.begin(), surface.positions.end());
    for (const uint32_t index : surface.indices) mesh.indices.push_back(static_cast<uint32_t>(base) + index);
}

}  // namespace

void GltfMeshes::fail(const std::string& path, const std::string& message) const {
    throw types::ConfigError(gltf_.name, path, message);
}

void GltfMeshes::charge(size_t elements, const std::string& path) {
    elements_ += elements;
    if (elements_ > kMaxElements)
        fail(path, fmt::format("brings the file over {} vertices and indices; split it", kMaxElements));
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

int GltfMeshes::withoutMap(int material) {
    ++omissions_.unmapped_primitives;
    const auto [known, is_new] = unmapped_.try_emplace(material, static_cast<int>(geometry_.materials.size()));
    if (is_new) {
        types::Material plain = geometry_.materials[static_cast<size_t>(material)];
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

    /** Empty when the primitive has no such attribute. */
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
    /** What a normal map needs. */
    void readMapped(const NormalMapping& mapping, Surface& surface) const {
        surface.uvs = read<glm::vec2>(fmt::format("TEXCOORD_{}", mapping.uv_set));
        if (surface.uvs.empty()) return;
        for (glm::vec2& uv : surface.uvs) uv = mapping.transform * glm::vec3(uv, 1);
        surface.normals = read<glm::vec3>("NORMAL");
        if (!surface.normals.empty()) surface.tangents = read<glm::vec4>("TANGENT");
    }
};

void GltfMeshes::append(const tinygltf::Primitive& primitive, const std::string& path, types::Mesh& mesh) {
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end()) return;
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) fail(path + ".mode", fmt::format("is {}; may be 0 to 6", mode));
    if (mode < TINYGLTF_MODE_TRIANGLES) return void(++omissions_.other_primitives);

    Surface surface;
    surface.positions = accessors_.vectors<glm::vec3>(positions->second);
    const size_t count = surface.positions.size();
    charge(count, path);
    constexpr uint32_t no_restart = ~0u;
    std::vector<uint32_t> corners;
    uint32_t restart = no_restart;
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
    surface.indices = triangulate(corners, mode, restart);
    dropUseless(surface, omissions_);
    mendUnused(surface);
    if (surface.indices.empty()) return;

    int index = material(primitive, path);
    const auto& mapping =
        static_cast<size_t>(index) < mappings_.size() ? mappings_[static_cast<size_t>(index)] : std::nullopt;
    if (mapping) {
        Attributes{primitive, *this, path, count}.readMapped(*mapping, surface);
        normalise(surface);
        if (surface.uvs.empty())
            index = withoutMap(index);
        else if (surface.normals.empty())
            makeFlatNormals(surface);
        if (!surface.uvs.empty() && surface.tangents.empty()) makeTangents(surface);
    }
    appendSurface(surface, index, mesh);
}

types::Mesh GltfMeshes::read(size_t index) {
    const tinygltf::Mesh& from = gltf_.model.meshes[index];
    types::Mesh mesh;
    mesh.name = from.name;
    for (size_t i = 0; i < from.primitives.size(); ++i)
        append(from.primitives[i], fmt::format("meshes[{}].primitives[{}]", index, i), mesh);
    const bool morphed =
        std::ranges::any_of(from.primitives, [](const auto& primitive) { return !primitive.targets.empty(); });
    if (morphed) ++omissions_.morphed_meshes;
    const size_t count = mesh.positions.size();
    appendFilled(mesh.normals, {}, count, glm::vec3(0, 1, 0));
    appendFilled(mesh.tangents, {}, count, glm::vec4(1, 0, 0, 1));
    appendFilled(mesh.uvs, {}, count, glm::vec2(0));
    return mesh;
}

}  // namespace insonify::scene
