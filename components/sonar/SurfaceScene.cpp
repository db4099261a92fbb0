#include "components/sonar/SurfaceScene.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace insonify::sonar {
namespace {

/** One attribute of all meshes behind one another; `neutral` where a mesh has none. */
template <class T> std::vector<T> joined(const types::Geometry& geometry, std::vector<T> types::Mesh::* attribute, T neutral) {
    std::vector<T> all;
    for (const types::Mesh& mesh : geometry.meshes) {
        const std::vector<T>& values = mesh.*attribute;
        all.insert(all.end(), values.begin(), values.end());
        all.resize(all.size() + mesh.positions.size() - values.size(), neutral);
    }
    return all;
}

template <class T> gpu::Buffer uploaded(const std::vector<T>& items) { return gpu::Buffer::of(std::span(items)); }

/** A triangle's plane in object axes: xyz its unit normal n, w = n.p for its points p [m]. */
vec4 planeOf(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    if (!(length > 0)) return vec4(0);
    const glm::dvec3 normal = across / length;
    return vec4(glm::vec3(normal), static_cast<float>(glm::dot(normal, a)));
}

gpu::Texture uploadedMap(int width, int height, const uint8_t* rgb, bool repeat_u, bool repeat_v) {
    gpu::Texture texture(GL_RGB8, width, height, true);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb);
    glGenerateTextureMipmap(texture.id());
    glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, repeat_u ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, repeat_v ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    return texture;
}

}  // namespace

SurfaceScene::SurfaceScene(const types::Geometry& geometry, bool with_normal_maps) {
    uploadVertices(geometry, with_normal_maps);
    uploadPlanes(geometry);
    uploadMaterials(geometry);
    if (with_normal_maps) uploadNormalMaps(geometry);
}

void SurfaceScene::uploadVertices(const types::Geometry& geometry, bool with_normal_maps) {
    std::vector<uint32_t> indices;
    uint32_t vertex = 0;
    for (const types::Mesh& mesh : geometry.meshes) {
        const auto first_index = static_cast<uint32_t>(indices.size());
        places_.push_back({vertex, first_index, first_index / 3});
        vertex += static_cast<uint32_t>(mesh.positions.size());
        indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    }
    indices_ = uploaded(indices);
    vertices_.indices(indices_);
    vertices_.attribute(0, positions_ = uploaded(joined(geometry, &types::Mesh::positions, glm::vec3(0))), 3);
    if (!with_normal_maps) return;
    vertices_.attribute(1, normals_ = uploaded(joined(geometry, &types::Mesh::normals, glm::vec3(0, 0, 1))), 3);
    vertices_.attribute(2, tangents_ = uploaded(joined(geometry, &types::Mesh::tangents, glm::vec4(1, 0, 0, 1))), 4);
    vertices_.attribute(3, uvs_ = uploaded(joined(geometry, &types::Mesh::uvs, glm::vec2(0))), 2);
}

void SurfaceScene::uploadPlanes(const types::Geometry& geometry) {
    for (const types::Mesh& mesh : geometry.meshes)
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            plane_list_.push_back(planeOf(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]]));
    planes_ = uploaded(plane_list_);
}

void SurfaceScene::uploadMaterials(const types::Geometry& geometry) {
    for (const types::Material& material : geometry.materials)
        material_list_.push_back({vec4(std::pow(10.0f, material.lambert_db / 10), material.reflectivity, material.normal_scale, 0)});
    materials_ = uploaded(material_list_);
}

void SurfaceScene::uploadNormalMaps(const types::Geometry& geometry) {
    for (const types::NormalMap& map : geometry.normal_maps)
        normal_maps_.push_back(uploadedMap(map.width, map.height, map.rgb.data(), map.repeat_u, map.repeat_v));
    // No map is one texel that bends nothing: (0.5, 0.5, 1) up to the quantisation of 8 bits.
    gpu::Texture flat(GL_RGB32F, 1, 1);
    const float up[] = {0.5f, 0.5f, 1.0f};
    glTextureSubImage2D(flat.id(), 0, 0, 0, 1, 1, GL_RGB, GL_FLOAT, up);
    normal_maps_.push_back(std::move(flat));
}

void SurfaceScene::bind() const {
    vertices_.bind();
    planes_.bindBase(GL_SHADER_STORAGE_BUFFER, PLANES_BINDING);
    materials_.bindBase(GL_SHADER_STORAGE_BUFFER, MATERIALS_BINDING);
}

void SurfaceScene::bindNormalMap(int map) const {
    if (normal_maps_.empty()) return;
    (map < 0 ? normal_maps_.back() : normal_maps_[static_cast<size_t>(map)]).bind(0);
}

}  // namespace insonify::sonar
