#include "components/sonar/places/MeshFacts.hpp"

#include <algorithm>
#include <limits>

#include "components/sonar/echo/FacetLobes.hpp"
#include "components/sonar/pictures/SurfaceScene.hpp"
#include "components/sonar/places/NearestPoint.hpp"

namespace insonify::sonar {
namespace {

BoxTree treeOver(const types::Mesh& mesh) {
    constexpr size_t leaf = 3 * MeshFacts::leaf_triangles;
    std::vector<Box> boxes((mesh.indices.size() + leaf - 1) / leaf);
    for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / leaf].add(mesh.positions[mesh.indices[i]]);
    for (Box& box : boxes) {  // meetTriangle accepts a little beyond the edges
        const glm::dvec3 slack = 1e-9 * (glm::max(glm::abs(box.low), glm::abs(box.high)) + box.half());
        box.low -= slack, box.high += slack;
    }
    return BoxTree(boxes);
}

}  // namespace

std::shared_ptr<MeshFacts> MeshFacts::of(const types::MeshPtr& mesh) {
    static SharedValues<const types::Mesh*, MeshFacts> all;
    return all.of(mesh.get(), [&] { return std::make_shared<MeshFacts>(mesh); });
}

std::vector<std::shared_ptr<MeshFacts>> MeshFacts::ofAll(const types::Geometry& geometry) {
    std::vector<std::shared_ptr<MeshFacts>> all;
    for (size_t i = 0; i < geometry.meshes.size(); ++i) all.push_back(of(geometry.meshes.shared(i)));
    return all;
}

const Box& MeshFacts::box() {
    return box_.get([this] {
        Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
        for (const glm::vec3& p : mesh_->positions) box.add(p);
        return box;
    });
}

double MeshFacts::longestEdge() {
    return longest_edge_.get([this] { return sonar::longestEdge(*mesh_); });
}

const BoxTree& MeshFacts::triangles() {
    return triangles_.get([this] { return treeOver(*mesh_); });
}

MeshFacts::Planes MeshFacts::planes() {
    return planes_.get([this] { return std::make_shared<const std::vector<PlaneRecord>>(planesOf(*mesh_)); });
}

MeshFacts::Facets MeshFacts::facets(const glm::dmat3& world_from_mesh, const MaterialLaws& laws) {
    if (!hasLobes(*mesh_, laws)) return nullptr;
    const double wavelength = laws.wavelength.value_or(0);
    std::array<double, 10> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    key[9] = wavelength;
    return facets_.of(key, [&] {
        return std::make_shared<const std::vector<FacetRecord>>(facetLobes(*mesh_, world_from_mesh, wavelength));
    });
}

}  // namespace insonify::sonar
