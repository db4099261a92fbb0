#pragma once
// A scene with everything that is hard to render: grazing ground, silhouettes, thin plates, clusters and a normal map.
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>

#include "tests/support/Scenes.hpp"

namespace insonify::test {

/** A block from -1 to 1, with flat faces. */
inline types::Mesh block() {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    return getMesh(corners, {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
}

/** A square wall across the view at x = 0, 2 m wide, with the attributes for a normal map. */
inline types::Mesh mappedWall() {
    types::Mesh mesh = quad({0, -1, -1}, {0, 2, 0}, {0, 0, 2});
    mesh.normals.assign(4, {-1, 0, 0});
    mesh.tangents.assign(4, {0, 1, 0, -1});
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

/** Normals that lean at random, by up to 45 deg. */
inline types::NormalMap bumpyMap(int size = 16) {
    types::NormalMap map{size, size, {}, true, true};
    std::minstd_rand random(5);
    for (int i = 0; i < size * size; ++i)
        for (int channel : {90, 90, 128}) map.rgb.push_back(static_cast<uint8_t>(channel + random() % 75));
    return map;
}

/** A map without effect: normals straight out, (128, 128, 255), as straight as eight bits allow. */
inline types::NormalMap flatMap() { return {1, 1, {128, 128, 255}, true, true}; }

/** Ground at z = -4, a sphere, a turned block, a plate seen nearly edge-on, and a wall with a normal map; two
 *  materials, the second of which has the map. */
inline std::shared_ptr<types::Geometry> surfaces() {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.resize(2);
    geometry->materials[0].lambert_db = -12;
    geometry->materials[1].reflectivity = 0.8f;
    geometry->materials[1].normal_map = 0;
    geometry->normal_maps = {bumpyMap()};
    geometry->meshes = {ground(-4, 200), sphere(1.5f, 40), block(), mappedWall()};
    geometry->meshes[3].clusters[0].material = 1;
    const auto at = [](double x, double y, double z) { return glm::translate(glm::dmat4(1), {x, y, z}); };
    geometry->objects = {
        {"ground", 0, glm::dmat4(1)},
        {"ball", 1, at(9, 3, -1)},
        {"block", 2, glm::rotate(at(12, -5, -2), 0.7, glm::dvec3(1, 2, 3))},
        {"plate", 2, glm::scale(glm::rotate(at(7, -1.5, 0), -0.21, glm::dvec3(0, 0, 1)), {3.0, 0.01, 1.0})},
        {"wall", 3, glm::scale(at(20, 0, -2), {1.0, 8.0, 2.0})},
        {"mirrored ball", 1, glm::scale(at(-10, 12, 0), {1.0, -2.0, 1.0})},
    };
    return geometry;
}

}  // namespace insonify::test
