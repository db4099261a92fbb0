#include "components/scene/Surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace insonify::scene {
namespace {

/** Max coordinate: larger values are treated as damage, because their squares exceed the range of float [m]. */
constexpr float max_coordinate = 1e15f;

bool isUsable(glm::vec3 p) {
    return std::abs(p.x) < max_coordinate && std::abs(p.y) < max_coordinate && std::abs(p.z) < max_coordinate;
}

/** Extends `to` to `size` with `filler`, then appends `from`. Does nothing while both are empty. */
template <class T>
void appendFilled(std::vector<T>& to, const std::vector<T>& from, size_t size, T filler) {
    if (to.empty() && from.empty()) return;
    to.resize(size, filler);
    to.insert(to.end(), from.begin(), from.end());
}

/** Returns twice the signed area of a triangle in uv, negative if the map is mirrored. */
float uvArea(const Surface& surface, const uint32_t* corner) {
    const glm::vec2 a = surface.uvs[corner[1]] - surface.uvs[corner[0]];
    const glm::vec2 b = surface.uvs[corner[2]] - surface.uvs[corner[0]];
    return a.x * b.y - a.y * b.x;
}

/** Returns dP/du of a triangle times the size of its uv area, so that large triangles have more weight. */
glm::vec3 alongU(const Surface& surface, const uint32_t* corner) {
    const glm::vec3 edge_a = surface.positions[corner[1]] - surface.positions[corner[0]];
    const glm::vec3 edge_b = surface.positions[corner[2]] - surface.positions[corner[0]];
    const float va = surface.uvs[corner[1]].y - surface.uvs[corner[0]].y;
    const float vb = surface.uvs[corner[2]].y - surface.uvs[corner[0]].y;
    const glm::vec3 along = edge_a * vb - edge_b * va;
    return uvArea(surface, corner) < 0 ? -along : along;
}

/** Duplicates vertices used by both mirrored and unmirrored triangles. Returns which vertices are mirrored. */
std::vector<bool> separateMirrored(Surface& surface) {
    const size_t count = surface.positions.size();
    constexpr uint32_t none = ~0u;
    std::vector<bool> used(count), mirrored(count);
    std::vector<uint32_t> twin(count, none);
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const bool is_mirrored = uvArea(surface, &surface.indices[i]) < 0;
        for (size_t k = i; k < i + 3; ++k) {
            uint32_t& index = surface.indices[k];
            if (!used[index]) {
                used[index] = true;
                mirrored[index] = is_mirrored;
            } else if (mirrored[index] != is_mirrored) {
                if (twin[index] == none) {
                    twin[index] = static_cast<uint32_t>(surface.positions.size());
                    surface.positions.push_back(surface.positions[index]);
                    surface.normals.push_back(surface.normals[index]);
                    surface.uvs.push_back(surface.uvs[index]);
                    if (!surface.map_uvs.empty()) surface.map_uvs.push_back(surface.map_uvs[index]);
                    if (!surface.numbers.empty()) surface.numbers.push_back(surface.numbers[index]);
                    mirrored.push_back(is_mirrored);
                }
                index = twin[index];
            }
        }
    }
    return mirrored;
}

/** Returns the part of `along` that is perpendicular to the normal, or any perpendicular direction if that part is
 *  zero. */
glm::vec3 tangent(glm::vec3 along, glm::vec3 normal) {
    const glm::vec3 flat = along - normal * glm::dot(normal, along);
    const float length = glm::length(flat);
    if (length > 1e-30f && std::isfinite(length)) return flat / length;
    const glm::vec3 other = std::abs(normal.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(other, normal));
}

}  // namespace

void addCount(size_t number, const char* what, types::Notices& notices) {
    if (number > 0) notices.push_back(fmt::format("{}: {}", what, number));
}

void DroppedTriangles::addTo(types::Notices& notices) const {
    addCount(bad, "triangles dropped for a vertex that is not a finite number", notices);
    addCount(empty, "triangles dropped for having no area", notices);
}

void cleanUp(Surface& surface, DroppedTriangles& dropped) {
    size_t kept = 0;
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
        const uint32_t* corner = &surface.indices[i];
        const glm::vec3 a = surface.positions[corner[0]], b = surface.positions[corner[1]],
                        c = surface.positions[corner[2]];
        if (!isUsable(a) || !isUsable(b) || !isUsable(c)) {
            ++dropped.bad;
            continue;
        }
        const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
        if (normal == glm::dvec3(0) && surface.numbers.empty()) {
            ++dropped.empty;
            continue;
        }
        std::copy_n(corner, 3, &surface.indices[kept]);
        kept += 3;
    }
    surface.indices.resize(kept);
    for (glm::vec3& position : surface.positions)
        if (!isUsable(position)) position = glm::vec3(0);
}

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
    appendFilled(mesh.map_uvs, surface.map_uvs, base, glm::vec2(0));
    mesh.positions.insert(mesh.positions.end(), surface.positions.begin(), surface.positions.end());
    const size_t first = mesh.indices.size();
    mesh.indices.resize(first + surface.indices.size());
    for (size_t i = 0; i < surface.indices.size(); ++i)
        mesh.indices[first + i] = static_cast<uint32_t>(base) + surface.indices[i];
}

void fillAttributes(types::Mesh& mesh) {
    const size_t count = mesh.positions.size();
    appendFilled(mesh.normals, {}, count, glm::vec3(0, 1, 0));
    appendFilled(mesh.tangents, {}, count, glm::vec4(1, 0, 0, 1));
    appendFilled(mesh.uvs, {}, count, glm::vec2(0));
    appendFilled(mesh.map_uvs, {}, count, glm::vec2(0));
}

void makeFlatNormals(Surface& surface) {
    Surface flat;
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const uint32_t* corner = &surface.indices[i];
        const glm::dvec3 origin = surface.positions[corner[0]];
        const glm::dvec3 across = glm::cross(glm::dvec3(surface.positions[corner[1]]) - origin,
                                             glm::dvec3(surface.positions[corner[2]]) - origin);
        const glm::vec3 normal = glm::length(across) > 0 ? glm::normalize(across) : glm::dvec3(0, 1, 0);
        for (size_t k = 0; k < 3; ++k) {
            flat.positions.push_back(surface.positions[corner[k]]);
            flat.normals.push_back(normal);
            if (!surface.uvs.empty()) flat.uvs.push_back(surface.uvs[corner[k]]);
            if (!surface.map_uvs.empty()) flat.map_uvs.push_back(surface.map_uvs[corner[k]]);
            if (!surface.numbers.empty()) flat.numbers.push_back(surface.numbers[corner[k]]);
            flat.indices.push_back(static_cast<uint32_t>(i + k));
        }
    }
    surface = std::move(flat);
}

void makeTangents(Surface& surface) {
    const std::vector<bool> mirrored = separateMirrored(surface);
    std::vector<glm::vec3> along(surface.positions.size(), glm::vec3(0));
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const uint32_t* corner = &surface.indices[i];
        const glm::vec3 direction = alongU(surface, corner);
        for (size_t k = 0; k < 3; ++k) along[corner[k]] += direction;
    }
    surface.tangents.resize(along.size());
    for (size_t i = 0; i < along.size(); ++i)
        surface.tangents[i] = glm::vec4(tangent(along[i], surface.normals[i]), mirrored[i] ? 1.0f : -1.0f);
}

}  // namespace insonify::scene
