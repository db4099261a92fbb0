#include "components/sonar/rays/MeshesAhead.hpp"

#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"

namespace insonify::sonar {
namespace {

/** Data of a mesh that is kept until a geometry has the mesh. */
struct MeshData {
    types::MeshPtr mesh;
    std::shared_ptr<MeshTree> tree;
    std::shared_ptr<MeshFacts> facts;
    MeshFacts::Planes planes;
    MeshFacts::Facets facets;
    MeshFacts::Curves curves;
};

std::shared_ptr<const MeshData> dataOf(const types::MeshPtr& mesh, const MaterialLaws& laws) {
    MeshData data{mesh, MeshTree::of(mesh), MeshFacts::of(mesh), {}, {}, {}};
    data.tree->tree();
    data.facts->box();
    data.facts->longestEdge();
    data.facts->triangles();
    data.planes = data.facts->planes();
    data.facets = data.facts->facets(glm::dmat3(1), laws);
    data.curves = data.facts->curves(glm::dmat3(1));
    return std::make_shared<const MeshData>(std::move(data));
}

}  // namespace

void MeshesAhead::take(const Meshes& meshes, const MaterialLaws& laws) {
    if (meshes == taken_) return;
    taken_ = meshes;
    MadeAhead::Items items;
    const auto shared_laws = std::make_shared<const MaterialLaws>(laws);
    if (meshes)
        for (const types::MeshPtr& mesh : *meshes)
            items.push_back({{static_cast<int64_t>(reinterpret_cast<intptr_t>(mesh.get()))},
                             [mesh, shared_laws](const std::atomic<bool>&) { return dataOf(mesh, *shared_laws); }});
    ahead_.take(std::move(items));
}

}  // namespace insonify::sonar
