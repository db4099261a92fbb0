#pragma once
// A scene of large meshes, and a sonar that moves through it.
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <vector>

#include "components/scene/Clusters.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

inline glm::dvec3 uniformVector(Random& random, double size) {
    return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

/** A rough sheet of 2 n n triangles between -1 and 1, split into clusters. */
inline types::Mesh clusteredSheet(Random& random, int n) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) positions.push_back({2.0 * i / n - 1, 2.0 * j / n - 1, uniform(random, 0, 0.1)});
    for (uint32_t i = 0, side = static_cast<uint32_t>(n) + 1; i + 1 < side; ++i)
        for (uint32_t j = 0; j + 1 < side; ++j) {
            const uint32_t a = i * side + j;
            indices.insert(indices.end(), {a, a + side, a + 1, a + 1, a + side, a + side + 1});
        }
    types::Mesh mesh = test::getMesh(positions, indices);
    scene::buildClusters(mesh);
    return mesh;
}

inline SonarConfig fan(double field_of_view_deg) {
    SonarConfig config =
        test::getSonar({.beams = 32, .width_deg = field_of_view_deg, .height_deg = 50, .bins = 300, .rows = 96});
    config.device = "software";
    return config;
}

/** The bins of three pings from different poses, one after the other. */
inline std::vector<float> pings(const SonarConfig& config, const types::GeometryPtr& geometry) {
    SonarRenderer renderer(config, geometry);
    std::vector<float> bins;
    for (int i = 0; i < 3; ++i) {
        types::Sonar ping;
        renderer.render(test::makeSnapshot(geometry, {i - 1.0, 0.5 * i, 0.0}, 0.4 * i, 0.15, 0.1 * i), ping);
        bins.insert(bins.end(), ping.bins.begin(), ping.bins.end());
    }
    return bins;
}

/** A floor of clusters and, in the middle, a ball of clusters. */
inline std::shared_ptr<types::Geometry> clusteredHarbour() {
    Random random(3);
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.resize(1);
    geometry->meshes = {clusteredSheet(random, 120), test::sphere(1, 80)};
    scene::buildClusters(geometry->meshes[1]);
    geometry->objects = {{"floor", 0, glm::scale(glm::translate(glm::dmat4(1), {0.0, 0.0, -4.0}), {50.0, 50.0, 6.0})},
                         {"ball", 1, glm::translate(glm::dmat4(1), {9.0, 4.0, -3.0})},
                         {"egg", 1, glm::scale(glm::translate(glm::dmat4(1), {-12.0, 5.0, -2.0}), {1.0, 3.0, -1.0})}};
    return geometry;
}

}  // namespace insonify::sonar
