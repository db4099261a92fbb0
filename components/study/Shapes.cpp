#include "components/study/Shapes.hpp"

#include "components/scene/Clusters.hpp"

namespace insonify::study {

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
    for (types::Mesh& mesh : meshes)
        if (mesh.indices.size() / 3 > scene::clustered_from) scene::buildClusters(mesh);
    geometry->meshes = std::move(meshes);
    return geometry;
}

}  // namespace insonify::study
