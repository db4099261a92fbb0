#include "components/study/Shapes.hpp"

#include <cmath>
#include <numbers>

#include "components/scene/Clusters.hpp"

namespace insonify::study {
namespace {

types::Mesh meshOf(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
    types::Mesh mesh;
    mesh.positions = std::move(positions);
    mesh.indices = std::move(indices);
    mesh.clusters = {{.first_index = 0, .index_count = static_cast<uint32_t>(mesh.indices.size())}};
    scene::buildClusters(mesh);
    return mesh;
}

}  // namespace

types::Mesh quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
    return meshOf({corner, corner + a, corner + a + b, corner + b}, {0, 1, 2, 0, 2, 3});
}

types::Mesh disc(double distance, double radius, int segments) {
    std::vector<glm::vec3> positions = {{distance, 0, 0}};
    std::vector<uint32_t> indices;
    const auto count = static_cast<uint32_t>(segments);
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        positions.push_back({distance, radius * std::cos(angle), radius * std::sin(angle)});
        indices.insert(indices.end(), {0, 1 + i, 1 + (i + 1) % count});
    }
    return meshOf(std::move(positions), std::move(indices));
}

types::Mesh sphere(double radius, int rings) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const int around = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= around; ++j) {
            const double polar = std::numbers::pi * i / rings, azimuth = 2 * std::numbers::pi * j / around;
            positions.push_back(radius * glm::dvec3(std::sin(polar) * std::cos(azimuth),
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

types::GeometryPtr sceneOf(std::vector<types::Mesh> meshes, std::vector<glm::dvec3> positions) {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.emplace_back().lambert_db = 0;
    positions.resize(meshes.size(), glm::dvec3(0));
    for (size_t i = 0; i < meshes.size(); ++i) {
        types::Object& object = geometry->objects.emplace_back();
        object.name = "object_" + std::to_string(i);
        object.mesh = static_cast<int>(i);
        object.world_from_object[3] = glm::dvec4(positions[i], 1);
    }
    geometry->meshes = std::move(meshes);
    return geometry;
}

}  // namespace insonify::study
