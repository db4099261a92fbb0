#include "components/scene/Surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace insonify::scene {
namespace {

/** Coordinates beyond are taken for damage: their squares leave the range of float [m]. */
constexpr float max_coordinate = 1e15f;

bool isUsable(glm::vec3 p) {
    return std::abs(p.x) < max_coordinate && std::abs(p.y) < max_coordinate && std::abs(p.z) < max_coordinate;
}

/** `to` grows to `size` with `filler`, then takes `from`; nothing happens while both are empty. */
template <class T>
void appendFilled(std::vector<T>& to, const std::vector<T>& from, size_t size, T filler) {
    if (to.empty() && from.empty()) return;
    to.resize(size, filler);
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void addCount(size_t number, const char* what, std::vector<std::string>& notices) {
    if (number > 0) notices.push_back(fmt::format("{}: {}", what, number));
}

void DroppedTriangles::addTo(std::vector<std::string>& notices) const {
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
        if (normal == glm::dvec3(0)) {
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
    mesh.positions.insert(mesh.positions.end(), surface.positions.begin(), surface.positions.end());
    for (const uint32_t index : surface.indices) mesh.indices.push_back(static_cast<uint32_t>(base) + index);
}

void fillAttributes(types::Mesh& mesh) {
    const size_t count = mesh.positions.size();
    appendFilled(mesh.normals, {}, count, glm::vec3(0, 1, 0));
    appendFilled(mesh.tangents, {}, count, glm::vec4(1, 0, 0, 1));
    appendFilled(mesh.uvs, {}, count, glm::vec2(0));
}

}  // namespace insonify::scene
