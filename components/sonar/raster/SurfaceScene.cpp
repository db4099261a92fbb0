#include "components/sonar/raster/SurfaceScene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** A mesh in the form that is rasterised: triangle t ends in vertex t, and no other triangle ends there. So the last
 *  vertex of a triangle, the provoking one, identifies the triangle. gl_PrimitiveID, for which llvmpipe splits meshes,
 *  is not needed. */
class Rasterised {
public:
    explicit Rasterised(const types::Mesh& mesh) : indices(mesh.indices), place_(mesh.positions.size(), nobody) {
        sources.resize(indices.size() / 3);
        for (size_t t = 0; t < sources.size(); ++t) endInOwnVertex(t);
        for (size_t i = 0; i < indices.size(); ++i)
            indices[i] = i % 3 == 2 ? static_cast<uint32_t>(i / 3) : at(indices[i]);
    }

    std::vector<uint32_t> sources;  ///< Vertex of the mesh for each rasterised vertex.
    std::vector<uint32_t> indices;

private:
    static constexpr uint32_t nobody = 0xffffffff;

    void endInOwnVertex(size_t t) {
        uint32_t* corners = indices.data() + 3 * t;
        uint32_t* free = std::find_if(corners, corners + 3, [&](uint32_t vertex) { return place_[vertex] == nobody; });
        std::rotate(corners, free == corners + 3 ? corners : free + 1, corners + 3);
        sources[t] = corners[2];
        if (place_[corners[2]] == nobody) place_[corners[2]] = static_cast<uint32_t>(t);
    }

    uint32_t at(uint32_t vertex) {
        if (place_[vertex] == nobody) {
            place_[vertex] = static_cast<uint32_t>(sources.size());
            sources.push_back(vertex);
        }
        return place_[vertex];
    }

    std::vector<uint32_t> place_;  ///< Rasterised place of each vertex of the mesh.
};

/** Appends an attribute of the rasterised vertices of a mesh; `neutral` where the mesh has none. */
template <class T>
void append(const std::vector<T>& values, const std::vector<uint32_t>& sources, T neutral, std::vector<T>& all) {
    for (const uint32_t source : sources) all.push_back(values.empty() ? neutral : values[source]);
}

/** Returns one attribute of all rasterised vertices. */
template <class T>
std::vector<T> joined(const types::Geometry& geometry, const std::vector<Rasterised>& meshes,
                      std::vector<T> types::Mesh::*attribute, T neutral) {
    std::vector<T> all;
    for (size_t m = 0; m < meshes.size(); ++m) append(geometry.meshes[m].*attribute, meshes[m].sources, neutral, all);
    return all;
}

/** Writes an attribute of the rasterised vertices of a mesh, which start with vertex `first`. */
template <class T>
void rewrite(gpu::Buffer& buffer, const std::vector<T>& values, const std::vector<uint32_t>& sources, size_t first) {
    if (values.empty()) return;
    std::vector<T> own;
    own.reserve(sources.size());
    append(values, sources, T(0), own);
    buffer.write(own.data(), own.size() * sizeof(T), first * sizeof(T));
}

template <class T>
gpu::Buffer uploaded(const std::vector<T>& items) {
    return gpu::Buffer::of(std::span(items));
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

SurfaceScene::SurfaceScene(const types::Geometry& geometry, const MaterialLaws& laws, bool with_normal_maps)
    : with_normal_maps_(with_normal_maps),
      laws_{laws.records, laws.wavelength, laws.sharp_turn},
      plane_list_(extractPlanes(geometry)),
      facet_list_(facetLobes(geometry, laws)),
      materials_(uploaded(laws.records)) {
    uploadVertices(geometry);
    if (with_normal_maps) uploadNormalMaps(geometry);
}

void SurfaceScene::uploadVertices(const types::Geometry& geometry) {
    std::vector<Rasterised> meshes;
    std::vector<uint32_t> indices;
    uint32_t vertex = 0;
    for (const types::Mesh& mesh : geometry.meshes) {
        const Rasterised& added = meshes.emplace_back(mesh);
        const auto first_index = static_cast<uint32_t>(indices.size());
        places_.push_back({vertex, first_index, first_index / 3});
        vertex += static_cast<uint32_t>(added.sources.size());
        indices.insert(indices.end(), added.indices.begin(), added.indices.end());
        sources_.push_back(mesh.deformation ? added.sources : std::vector<uint32_t>());
    }
    indices_ = uploaded(indices);
    positions_ = uploaded(joined(geometry, meshes, &types::Mesh::positions, glm::vec3(0)));
    if (!with_normal_maps_) return;
    normals_ = uploaded(joined(geometry, meshes, &types::Mesh::normals, glm::vec3(0, 0, 1)));
    tangents_ = uploaded(joined(geometry, meshes, &types::Mesh::tangents, glm::vec4(1, 0, 0, 1)));
    uvs_ = uploaded(joined(geometry, meshes, &types::Mesh::uvs, glm::vec2(0)));
}

void SurfaceScene::uploadNormalMaps(const types::Geometry& geometry) {
    for (const types::NormalMap& map : geometry.normal_maps)
        normal_maps_.push_back(uploadedMap(map.width, map.height, map.rgb.data(), map.repeat_u, map.repeat_v));
    // The flat map is one neutral texel: (0.5, 0.5, 1) up to the quantisation of 8 bits.
    gpu::Texture flat(GL_RGB32F, 1, 1);
    const float up[] = {0.5f, 0.5f, 1.0f};
    glTextureSubImage2D(flat.id(), 0, 0, 0, 1, 1, GL_RGB, GL_FLOAT, up);
    normal_maps_.push_back(std::move(flat));
}

void SurfaceScene::updateLaws(const types::Geometry& geometry, const MaterialLaws& laws) {
    UsedLaws used{laws.records, laws.wavelength, laws.sharp_turn};
    if (used == laws_) return;
    laws_ = std::move(used);
    facet_list_ = facetLobes(geometry, laws);
    materials_ = uploaded(laws.records);
    triangles_ = {};
}

size_t SurfaceScene::findEnd(size_t mesh) const {
    return mesh + 1 < places_.size() ? places_[mesh + 1].first_triangle : plane_list_.size();
}

void SurfaceScene::updateShape(const types::Geometry& geometry, const MaterialLaws& laws, size_t mesh) {
    const size_t first = places_[mesh].first_triangle;
    findPlanes(geometry.meshes[mesh], std::span(plane_list_).subspan(first, findEnd(mesh) - first));
    if (facet_list_.empty()) return;
    const auto facets = MeshFacts::facetsNow(geometry.meshes[mesh], worldFromMesh(geometry, mesh), laws);
    if (facets) std::ranges::copy(*facets, facet_list_.begin() + static_cast<std::ptrdiff_t>(first));
}

void SurfaceScene::uploadShape(const types::Mesh& mesh, size_t number) {
    const size_t vertex = places_[number].first_vertex, first = places_[number].first_triangle;
    const size_t count = findEnd(number) - first;
    rewrite(positions_, mesh.positions, sources_[number], vertex);
    if (with_normal_maps_) {
        rewrite(normals_, mesh.normals, sources_[number], vertex);
        rewrite(tangents_, mesh.tangents, sources_[number], vertex);
    }
    if (triangles_.bytes() == 0) return;
    triangles_.write(&plane_list_[first], count * sizeof(PlaneRecord), first * sizeof(PlaneRecord));
    if (!facet_list_.empty())
        triangles_.write(&facet_list_[first], count * sizeof(FacetRecord),
                         plane_list_.size() * sizeof(PlaneRecord) + first * sizeof(FacetRecord));
}

void SurfaceScene::describe(const gpu::VertexArray& vertices) const {
    vertices.indices(indices_);
    vertices.attribute(0, positions_, 3);
    if (!with_normal_maps_) return;
    vertices.attribute(4, normals_, 3);
    vertices.attribute(5, tangents_, 4);
    vertices.attribute(6, uvs_, 2);
}

void SurfaceScene::bindRecords() const {
    if (triangles_.bytes() == 0) {
        const std::span planes(plane_list_);
        const std::span facets(facet_list_);
        triangles_ = gpu::Buffer(planes.size_bytes() + facets.size_bytes());
        triangles_.write(planes.data(), planes.size_bytes());
        if (!facets.empty()) triangles_.write(facets.data(), facets.size_bytes(), planes.size_bytes());
    }
    triangles_.bindBase(GL_SHADER_STORAGE_BUFFER, PLANES_BINDING);
    materials_.bindBase(GL_SHADER_STORAGE_BUFFER, MATERIALS_BINDING);
}

void SurfaceScene::bindNormalMap(int map) const {
    if (normal_maps_.empty()) return;
    (map < 0 ? normal_maps_.back() : normal_maps_[static_cast<size_t>(map)]).bind(0);
}

}  // namespace insonify::sonar
