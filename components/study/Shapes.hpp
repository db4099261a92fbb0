#pragma once
// Meshes made in code, for scenes with known echoes; each is one cluster.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "components/scene/Clusters.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::study {

/** Returns a mesh of triangles as one cluster; positions are used unchanged. */
inline types::Mesh getMesh(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
    types::Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.indices = std::move(indices);
    glm::vec3 low = mesh.positions.front(), high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 centre = (low + high) * 0.5f;
    mesh.clusters = {{0, static_cast<uint32_t>(mesh.indices.size()), 0, centre, high - centre}};
    return mesh;
}

/** Returns a parallelogram from a corner and two edges [m]. */
inline types::Mesh quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
    return getMesh({corner, corner + a, corner + a + b, corner + b}, {0, 1, 2, 0, 2, 3});
}

/** Returns a closed sphere about the origin, of `rings` times 2 `rings` quads with their corners on it [m]. */
inline types::Mesh sphere(double radius, int rings = 128) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const int around = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double polar = std::numbers::pi * i / rings, azimuth = 2 * std::numbers::pi * j / around;
            const double aside = i == 0 || i == rings ? 0 : std::sin(polar);
            positions.push_back(radius *
                                glm::dvec3(aside * std::cos(azimuth), aside * std::sin(azimuth), std::cos(polar)));
        }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * around + j % around); };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            if (i > 0) indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < rings) indices.insert(indices.end(), {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return getMesh(std::move(positions), std::move(indices));
}

/** Returns a disc perpendicular to the x axis about (distance, 0, 0), of `segments` triangles [m]. */
inline types::Mesh disc(double distance, double radius, uint32_t segments = 256) {
    std::vector<glm::vec3> positions = {{distance, 0, 0}};
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        positions.push_back({distance, radius * std::cos(angle), radius * std::sin(angle)});
        indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % segments});
    }
    return getMesh(positions, indices);
}

/** Returns a scene of one object per mesh, at `positions` or else the origin, of one material with 10^(lambert_db/10) =
 *  1. Large meshes are split into clusters. */
inline types::GeometryPtr makeScene(std::vector<types::Mesh> meshes, std::vector<glm::dvec3> positions = {}) {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.emplace_back().lambert_db = 0;
    positions.resize(meshes.size(), glm::dvec3(0));
    for (size_t i = 0; i < meshes.size(); ++i) {
        types::Object& object = geometry->objects.emplace_back();
        object.name = "object_" + std::to_string(i);
        object.mesh = static_cast<int>(i);
        object.world_from_object[3] = glm::dvec4(positions[i], 1);
    }
    for (types::Mesh& mesh : meshes)
        if (mesh.indices.size() / 3 > scene::clustered_from) scene::buildClusters(mesh);
    geometry->meshes = std::move(meshes);
    return geometry;
}

}  // namespace insonify::study
