#pragma once
// Small scenes with closed-form truth, built in code.
#include <memory>
#include <vector>

#include "components/study/Shapes.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::test {

using study::disc;
using study::getMesh;
using study::quad;
using study::sphere;

/** Level ground at height z, `size` wide, centred on the origin [m]. */
inline types::Mesh ground(float z, float size = 1000) {
    return quad({-size / 2, -size / 2, z}, {size, 0, 0}, {0, size, 0});
}

/** A wall of 200 x 200 m square to the x axis at x = distance. */
inline types::Mesh wall(float distance) { return quad({distance, -100, -100}, {0, 200, 0}, {0, 0, 200}); }

/** One object for each mesh, at `positions` (or the origin), all of one material of lambert_db `mu_db`. */
inline types::GeometryPtr makeScene(std::vector<types::Mesh> meshes, float mu_db = 0,
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

/** A scene without an echo for a sonar near the origin. */
inline types::GeometryPtr openWater() { return makeScene({disc(1, 0.1f)}, 0, {{-500, 0, 0}}); }

/** A sonar at `position`, turned by yaw, pitch, roll [rad] (R = Rz Ry Rx). */
inline types::Snapshot makeSnapshot(types::GeometryPtr geometry, glm::dvec3 position = {}, double yaw = 0,
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
