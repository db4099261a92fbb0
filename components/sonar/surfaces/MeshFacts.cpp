#include "components/sonar/surfaces/MeshFacts.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/NearestPoint.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Returns the plane of a triangle. A triangle without area has no normal, and thus no echo. The point is that of the
 *  plane nearest to the origin within the triangle's reach. Even on a huge triangle it is close to the visible part, if
 *  that is close to the origin. */
PlaneRecord planeOf(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 across = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    if (!(glm::length(across) > 0)) return {vec4(0), vec4(0)};
    const glm::dvec3 normal = glm::normalize(across), way = normal * glm::dot(normal, middle) - middle;
    const double reach = glm::distance(middle, a), length = glm::length(way);
    const glm::vec3 point(length > reach ? middle + way * (reach / length) : middle + way);
    return {vec4(glm::vec3(normal), static_cast<float>(glm::dot(normal, a - glm::dvec3(point)))), vec4(point, 0)};
}

std::vector<Box> leaves(const types::Mesh& mesh) {
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

std::vector<PlaneRecord> planesOf(const types::Mesh& mesh) {
    std::vector<PlaneRecord> planes(mesh.indices.size() / 3);
    findPlanes(mesh, planes);
    return planes;
}

/** Some triangles at a time, in vector registers, with the same operations in the same order as planeOf(). */
INSONIFY_VECTOR_CLONES void findPlanes(const types::Mesh& mesh, std::span<PlaneRecord> planes) {
    constexpr size_t at_once = 16;
    double a[3][at_once], b[3][at_once], c[3][at_once], normal[3][at_once], point[3][at_once], squares[at_once];
    const size_t whole = planes.size() / at_once * at_once;
    for (size_t first = 0; first < whole; first += at_once) {
        const uint32_t* const corners = &mesh.indices[3 * first];
        for (size_t i = 0; i < at_once; ++i) {
            const glm::vec3 &p = mesh.positions[corners[3 * i]], &q = mesh.positions[corners[3 * i + 1]],
                            &r = mesh.positions[corners[3 * i + 2]];
            a[0][i] = p.x, a[1][i] = p.y, a[2][i] = p.z;
            b[0][i] = q.x, b[1][i] = q.y, b[2][i] = q.z;
            c[0][i] = r.x, c[1][i] = r.y, c[2][i] = r.z;
        }
        for (size_t i = 0; i < at_once; ++i) {
            const double ux = b[0][i] - a[0][i], uy = b[1][i] - a[1][i], uz = b[2][i] - a[2][i];
            const double vx = c[0][i] - a[0][i], vy = c[1][i] - a[1][i], vz = c[2][i] - a[2][i];
            const double x = uy * vz - vy * uz, y = uz * vx - vz * ux, z = ux * vy - vx * uy;
            const double square = x * x + y * y + z * z;
            squares[i] = square;
            const double per_length = 1.0 / std::sqrt(square);
            const double nx = x * per_length, ny = y * per_length, nz = z * per_length;
            const double mx = (a[0][i] + b[0][i] + c[0][i]) / 3.0, my = (a[1][i] + b[1][i] + c[1][i]) / 3.0,
                         mz = (a[2][i] + b[2][i] + c[2][i]) / 3.0;
            const double height = nx * mx + ny * my + nz * mz;
            const double wx = nx * height - mx, wy = ny * height - my, wz = nz * height - mz;
            const double rx = a[0][i] - mx, ry = a[1][i] - my, rz = a[2][i] - mz;
            const double reach = std::sqrt(rx * rx + ry * ry + rz * rz),
                         length = std::sqrt(wx * wx + wy * wy + wz * wz);
            const double share = length > reach ? reach / length : 1.0;
            normal[0][i] = nx, normal[1][i] = ny, normal[2][i] = nz;
            point[0][i] = mx + wx * share, point[1][i] = my + wy * share, point[2][i] = mz + wz * share;
        }
        for (size_t i = 0; i < at_once; ++i) {
            const glm::vec3 at(point[0][i], point[1][i], point[2][i]);
            const double ox = a[0][i] - double{at.x}, oy = a[1][i] - double{at.y}, oz = a[2][i] - double{at.z};
            const double offset = normal[0][i] * ox + normal[1][i] * oy + normal[2][i] * oz;
            planes[first + i] = {vec4(glm::vec3(normal[0][i], normal[1][i], normal[2][i]), static_cast<float>(offset)),
                                 vec4(at, 0)};
        }
        for (size_t i = 0; i < at_once; ++i)
            if (!(squares[i] > 0)) planes[first + i] = {vec4(0), vec4(0)};
    }
    for (size_t t = whole; t < planes.size(); ++t) {
        const uint32_t* const corners = &mesh.indices[3 * t];
        planes[t] = planeOf(mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]);
    }
}

std::vector<PlaneRecord> planesOf(const types::Geometry& geometry) {
    std::vector<PlaneRecord> planes;
    for (const types::Mesh& mesh : geometry.meshes) {
        const std::vector<PlaneRecord> added = planesOf(mesh);
        planes.insert(planes.end(), added.begin(), added.end());
    }
    return planes;
}

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
    triangles_.renew([this](BoxTree& tree) { tree.refit(leaves(*mesh_)); });
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
    return triangles_.get([this] { return BoxTree(leaves(*mesh_)); });
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
