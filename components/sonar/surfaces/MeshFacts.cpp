#include "components/sonar/surfaces/MeshFacts.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/NearestPoint.hpp"
#include "components/sonar/surfaces/Planes.hpp"

namespace insonify::sonar {
namespace {

std::vector<Box> leavesOf(const types::Mesh& mesh) {
    constexpr size_t leaf = 3 * MeshFacts::leaf_triangles;
    std::vector<Box> boxes((mesh.indices.size() + leaf - 1) / leaf);
    for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / leaf].add(mesh.positions[mesh.indices[i]]);
    for (Box& box : boxes) {  // meetTriangle accepts hits slightly beyond the edges
        const glm::dvec3 slack = 1e-9 * (glm::max(glm::abs(box.low), glm::abs(box.high)) + box.half());
        box.low -= slack, box.high += slack;
    }
    return boxes;
}

Box boxOf(const types::Mesh& mesh) {
    Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
    for (const glm::vec3& p : mesh.positions) box.add(p);
    return box;
}

std::vector<float> mapDensityOf(const types::Mesh& mesh) {
    std::vector<float> all;
    all.reserve(mesh.indices.size() / 3);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* const corners = &mesh.indices[i];
        const glm::dvec3 a = mesh.positions[corners[0]];
        const glm::dvec2 uv = mesh.uvs[corners[0]];
        const glm::dvec2 to_b = glm::dvec2(mesh.uvs[corners[1]]) - uv, to_c = glm::dvec2(mesh.uvs[corners[2]]) - uv;
        const double area = glm::length(
            glm::cross(glm::dvec3(mesh.positions[corners[1]]) - a, glm::dvec3(mesh.positions[corners[2]]) - a));
        const double covered = std::abs(to_b.x * to_c.y - to_b.y * to_c.x);
        all.push_back(area > 0 ? static_cast<float>(std::sqrt(covered / area)) : 0.0f);
    }
    return all;
}

}  // namespace

std::shared_ptr<MeshFacts> MeshFacts::of(const types::MeshPtr& mesh) {
    static auto& all = *new SharedValues<const types::Mesh*, MeshFacts>;  // threads may use it until the process ends
    return all.of(mesh.get(), [&] { return std::make_shared<MeshFacts>(mesh); });
}

std::vector<std::shared_ptr<MeshFacts>> MeshFacts::ofAll(const types::Geometry& geometry) {
    std::vector<std::shared_ptr<MeshFacts>> all;
    for (size_t i = 0; i < geometry.meshes.size(); ++i) all.push_back(of(geometry.meshes.shared(i)));
    return all;
}

void MeshFacts::renew() {
    box_.renew([this](Box& box) { box = boxOf(*mesh_); });
    longest_edge_.renew([this](double& longest) { longest = sonar::longestEdge(*mesh_); });
    triangles_.renew([this](BoxTree& tree) { tree.refit(leavesOf(*mesh_)); });
    planes_.renew([this](const std::shared_ptr<std::vector<PlaneRecord>>& planes) { findPlanes(*mesh_, *planes); });
    map_density_.renew([this](std::vector<float>& density) { density = mapDensityOf(*mesh_); });
}

const Box& MeshFacts::box() {
    return box_.get([this] { return boxOf(*mesh_); });
}

double MeshFacts::longestEdge() {
    return longest_edge_.get([this] { return sonar::longestEdge(*mesh_); });
}

const BoxTree& MeshFacts::triangles() {
    return triangles_.get([this] { return BoxTree(leavesOf(*mesh_)); });
}

MeshFacts::Planes MeshFacts::planes() {
    return planes_.get([this] { return std::make_shared<std::vector<PlaneRecord>>(planesOf(*mesh_)); });
}

const std::vector<float>& MeshFacts::mapDensity() {
    return map_density_.get([this] { return mapDensityOf(*mesh_); });
}

MeshFacts::Facets MeshFacts::facets(const glm::dmat3& world_from_mesh, const MaterialLaws& laws) {
    if (!hasLobes(*mesh_, laws)) return nullptr;
    const double wavelength = laws.wavelength.value_or(0);
    std::array<double, 11> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    key[9] = wavelength;
    key[10] = laws.sharp_turn.value_or(0);
    const Edges edges = laws.sharp_turn ? this->edges(world_from_mesh, laws, *laws.sharp_turn) : nullptr;
    return facets_.of(key, [&] {
        return std::make_shared<const std::vector<FacetRecord>>(
            facetLobes(*mesh_, world_from_mesh, wavelength, edges.get()));
    });
}

MeshFacts::Facets MeshFacts::facetsNow(const types::Mesh& mesh, const glm::dmat3& world_from_mesh,
                                       const MaterialLaws& laws) {
    if (!hasLobes(mesh, laws)) return nullptr;
    std::optional<StraightEdges> edges;
    if (laws.sharp_turn) edges = straightEdges(mesh, world_from_mesh, *laws.sharp_turn);
    return std::make_shared<const std::vector<FacetRecord>>(
        facetLobes(mesh, world_from_mesh, laws.wavelength.value_or(0), edges ? &*edges : nullptr));
}

MeshFacts::Curves MeshFacts::curves(const glm::dmat3& world_from_mesh) {
    std::array<double, 9> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    return curves_.of(
        key, [&] { return std::make_shared<const std::vector<CurveRecord>>(facetCurves(*mesh_, world_from_mesh)); });
}

MeshFacts::Edges MeshFacts::edges(const glm::dmat3& world_from_mesh, const MaterialLaws& laws, double min_turn) {
    if (!hasLobes(*mesh_, laws)) return nullptr;
    std::array<double, 10> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    key[9] = min_turn;
    return edges_.of(
        key, [&] { return std::make_shared<const StraightEdges>(straightEdges(*mesh_, world_from_mesh, min_turn)); });
}

}  // namespace insonify::sonar
