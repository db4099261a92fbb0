#pragma once
// Small scenes with closed-form truth, built in code.
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "types/Snapshot.hpp"

namespace insonify::test {

/** A mesh of triangles as one cluster; positions are used as they are. */
inline types::Mesh meshOf(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
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

/** A parallelogram: corner, and two edges [m]. */
inline types::Mesh quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
    return meshOf({corner, corner + a, corner + a + b, corner + b}, {0, 1, 2, 0, 2, 3});
}

/** Level ground at height z, `size` wide, centred on the origin [m]. */
inline types::Mesh ground(float z, float size = 1000) {
    return quad({-size / 2, -size / 2, z}, {size, 0, 0}, {0, size, 0});
}

/** A sphere about the origin of `rings` x 2 `rings` quads. */
inline types::Mesh sphere(float radius, int rings = 128) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const int around = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= around; ++j) {
            const double polar = std::numbers::pi * i / rings, azimuth = 2 * std::numbers::pi * j / around;
            positions.push_back(radius * glm::vec3(std::sin(polar) * std::cos(azimuth),
                                                   std::sin(polar) * std::sin(azimuth), std::cos(polar)));
        }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (around + 1) + j); };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            if (i > 0) indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < rings) indices.insert(indices.end(), {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return meshOf(std::move(positions), std::move(indices));
}

/** A disc of radius `radius` square to the x axis at x = distance. */
inline types::Mesh disc(double distance, double radius) {
    std::vector<glm::vec3> positions = {{distance, 0, 0}};
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 256; ++i) {
        const double angle = 2 * std::numbers::pi * i / 256;
        positions.push_back({distance, radius * std::cos(angle), radius * std::sin(angle)});
        indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % 256});
    }
    return meshOf(positions, indices);
}

/** A wall of 200 x 200 m square to the x axis at x = distance. */
inline types::Mesh wall(float distance) { return quad({distance, -100, -100}, {0, 200, 0}, {0, 0, 200}); }

/** One object for each mesh, at `positions` (or the origin), all of one material of lambert_db `mu_db`. */
inline types::GeometryPtr sceneOf(std::vector<types::Mesh> meshes, float mu_db = 0,
                                  std::vector<glm::dvec3> positions = {}) {
    auto geometry = std::make_shared<types::Geometry>();
    types::Material material;
    material.lambert_db = mu_db;
    geometry->materials = {material};
    positions.resize(meshes.size(), glm::dvec3(0));
    for (size_t i = 0; i < meshes.size(); ++i) {
        glm::dmat4 place(1);
        place[3] = glm::dvec4(positions[i], 1);
        geometry->objects.push_back({"object_" + std::to_string(i), static_cast<int>(i), place});
    }
    geometry->meshes = std::move(meshes);
    return geometry;
}

/** A sonar at `position`, turned by yaw, pitch, roll [rad] (R = Rz Ry Rx). */
inline types::Snapshot snapshotOf(types::GeometryPtr geometry, glm::dvec3 position = {}, double yaw = 0,
                                  double pitch = 0, double roll = 0) {
    types::Snapshot snapshot;
    snapshot.time = {1'000'000};
    snapshot.sonar.position = position;
    snapshot.sonar.orientation = glm::angleAxis(yaw, glm::dvec3(0, 0, 1)) * glm::angleAxis(pitch, glm::dvec3(0, 1, 0)) *
                                 glm::angleAxis(roll, glm::dvec3(1, 0, 0));
    snapshot.geometry = std::move(geometry);
    return snapshot;
}

}  // namespace insonify::test
