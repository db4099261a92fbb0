#include "components/scene/Tangents.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace insonify::scene {
namespace {

/** Twice the signed area of a triangle in uv, negative where the map is mirrored. */
float uvArea(const Surface& surface, const uint32_t* corner) {
    const glm::vec2 a = surface.uvs[corner[1]] - surface.uvs[corner[0]];
    const glm::vec2 b = surface.uvs[corner[2]] - surface.uvs[corner[0]];
    return a.x * b.y - a.y * b.x;
}

/** dP/du of a triangle times the size of its uv area, so that large triangles weigh more. */
glm::vec3 alongU(const Surface& surface, const uint32_t* corner) {
    const glm::vec3 edge_a = surface.positions[corner[1]] - surface.positions[corner[0]];
    const glm::vec3 edge_b = surface.positions[corner[2]] - surface.positions[corner[0]];
    const float va = surface.uvs[corner[1]].y - surface.uvs[corner[0]].y;
    const float vb = surface.uvs[corner[2]].y - surface.uvs[corner[0]].y;
    const glm::vec3 along = edge_a * vb - edge_b * va;
    return uvArea(surface, corner) < 0 ? -along : along;
}

/** Doubles vertices used by mirrored and unmirrored triangles; returns which vertices are mirrored. */
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
                    mirrored.push_back(is_mirrored);
                }
                index = twin[index];
            }
        }
    }
    return mirrored;
}

/** The part of `along` at right angles to the normal, or any such direction when there is none. */
glm::vec3 tangentOf(glm::vec3 along, glm::vec3 normal) {
    const glm::vec3 flat = along - normal * glm::dot(normal, along);
    const float length = glm::length(flat);
    if (length > 1e-30f && std::isfinite(length)) return flat / length;
    const glm::vec3 other = std::abs(normal.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(other, normal));
}

}  // namespace

void makeFlatNormals(Surface& surface) {
    Surface flat;
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const uint32_t* corner = &surface.indices[i];
        const glm::dvec3 origin = surface.positions[corner[0]];
        const glm::vec3 normal = glm::normalize(glm::cross(glm::dvec3(surface.positions[corner[1]]) - origin,
                                                           glm::dvec3(surface.positions[corner[2]]) - origin));
        for (size_t k = 0; k < 3; ++k) {
            flat.positions.push_back(surface.positions[corner[k]]);
            flat.normals.push_back(normal);
            if (!surface.uvs.empty()) flat.uvs.push_back(surface.uvs[corner[k]]);
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
        surface.tangents[i] = glm::vec4(tangentOf(along[i], surface.normals[i]), mirrored[i] ? 1.0f : -1.0f);
}

}  // namespace insonify::scene
