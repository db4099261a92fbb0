#include "components/sonar/surfaces/FacetCurves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/MeshEdges.hpp"

namespace insonify::sonar {
namespace {

constexpr double straight = 1e-3;  ///< Edges with a smaller turn are neither concave nor bent [rad].
constexpr double coarse = 0.3;     ///< Turn between facets of a body with 20 around it [rad].

/** Finds the facets that represent a smooth convex surface. */
class SmoothFacets {
public:
    SmoothFacets(const types::Mesh& mesh, const glm::dmat3& world_from_mesh)
        : mesh_(mesh), world_from_mesh_(world_from_mesh), edges_(edgesOf(mesh)) {
        for (const glm::vec3& at : mesh.positions) {
            const glm::dvec3 size = glm::abs(glm::dvec3(at));
            rounding_ = std::max({rounding_, size.x, size.y, size.z});
        }
        const auto scale = [&](int i) { return glm::length(world_from_mesh[i]); };
        rounding_ *= 0x1p-24 * std::max({scale(0), scale(1), scale(2)});
        body_.resize(mesh.indices.size() / 3);
        std::iota(body_.begin(), body_.end(), 0u);
        joinBodies();
        if (std::ranges::all_of(body_, [&](uint32_t t) { return open_[bodyOf(t)]; })) return;
        findVolumes();
        rough_.resize(mesh.positions.size());
        eachPair([&](const Edge& one, const Edge& other) { markRough(one, other); });
        smooth_.resize(body_.size());
        for (uint32_t t = 0; t < body_.size(); ++t) smooth_[t] = !open_[bodyOf(t)];
        for (const Edge& edge : edges_)
            if (rough_[edge.low] || rough_[edge.high]) smooth_[edge.triangle] = false;
    }

    /** Returns whether each facet is smooth; empty: none is. */
    const std::vector<bool>& smooth() const { return smooth_; }

private:
    glm::dvec3 place(uint32_t vertex) const {
        return world_from_mesh_ * (glm::dvec3(mesh_.positions[vertex]) - glm::dvec3(mesh_.positions[0]));
    }
    std::array<glm::dvec3, 3> cornersOf(uint32_t t) const {
        const uint32_t* index = mesh_.indices.data() + 3 * size_t{t};
        return {place(index[0]), place(index[1]), place(index[2])};
    }
    uint32_t bodyOf(uint32_t t) {
        while (body_[t] != t) t = body_[t] = body_[body_[t]];
        return t;
    }
    /** Calls act(one, other) for each edge of two triangles. */
    void eachPair(const auto& act) {
        for (size_t k = 1; k < edges_.size(); ++k)
            if (edges_[k - 1].low == edges_[k].low && edges_[k - 1].high == edges_[k].high)
                act(edges_[k - 1], edges_[k]);
    }

    /** Joins connected triangles into bodies, and marks bodies with an edge of one triangle, or of more than two. */
    void joinBodies() {
        open_.assign(body_.size(), true);  // triangles without area have no edges
        for (const Edge& edge : edges_) open_[edge.triangle] = false;
        eachPair([&](const Edge& one, const Edge& other) {
            const uint32_t a = bodyOf(one.triangle), b = bodyOf(other.triangle);
            body_[std::max(a, b)] = std::min(a, b);
        });
        for (size_t k = 0, end = 0; k < edges_.size(); k = end) {
            while (end < edges_.size() && edges_[end].low == edges_[k].low && edges_[end].high == edges_[k].high) ++end;
            if (end - k != 2) open_[bodyOf(edges_[k].triangle)] = true;
        }
    }

    /** Computes the volumes of bodies, whose sign shows on which side of its facets the body is. */
    void findVolumes() {
        volumes_.resize(body_.size());
        for (uint32_t t = 0; t < body_.size(); ++t) {
            const auto p = cornersOf(t);
            volumes_[bodyOf(t)] += glm::dot(p[0], glm::cross(p[1], p[2]));
        }
    }

    /** Returns the angle by which the rounding of coordinates may have turned a facet: of its corners, over its least
     *  height. A facet of 2 mm that a file has 1 km from its origin is turned by up to 0.06 rad [rad]. */
    double roundingOf(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& across) const {
        const glm::dvec3 sides(glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                               glm::distance(corners[2], corners[0]));
        return 2 * rounding_ * std::max({sides.x, sides.y, sides.z}) / std::max(glm::length(across), 1e-30);
    }

    /** Marks the ends of an edge that is not possible on a smooth convex surface. */
    void markRough(const Edge& one, const Edge& other) {
        const auto a = cornersOf(one.triangle), b = cornersOf(other.triangle);
        const glm::dvec3 n = glm::cross(a[1] - a[0], a[2] - a[0]), m = glm::cross(b[1] - b[0], b[2] - b[0]);
        const double turn = std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m));
        const glm::dvec3 onward = b[0] + b[1] + b[2] - a[0] - a[1] - a[2];
        const bool hollow = turn > std::max(straight, roundingOf(a, n) + roundingOf(b, m)) &&
                            glm::dot(n, onward) * volumes_[bodyOf(one.triangle)] > 0;
        if (hollow || (turn > coarse && turn < crease)) rough_[one.low] = rough_[one.high] = true;
    }

    const types::Mesh& mesh_;
    glm::dmat3 world_from_mesh_;
    double rounding_ = 0;  ///< Of the coordinates of vertices, in the world's metres [m].
    std::vector<Edge> edges_;
    std::vector<uint32_t> body_;   ///< For each triangle another triangle of its body, or itself.
    std::vector<bool> open_;       ///< For each body.
    std::vector<double> volumes_;  ///< For each body, six times the volume, with the sign of its winding [m^3].
    std::vector<bool> rough_;      ///< For each vertex.
    std::vector<bool> smooth_;
};

/** Returns the curvature of a facet: its lobe's record has the curvatures along its axis and across it. */
CurveRecord curveOf(const FacetRecord& facet, const glm::dvec3& normal, const glm::dmat3& world_from_mesh) {
    const glm::dmat3 mesh_from_world = glm::transpose(world_from_mesh);
    glm::dvec3 axis = glm::inverse(mesh_from_world) * glm::dvec3(facet.axis);
    double more = static_cast<double>(facet.first.z), less = static_cast<double>(facet.second.z);
    if (more < less) {
        axis = glm::cross(normal, axis);
        std::swap(more, less);
    }
    return {vec4(mesh_from_world * axis * std::sqrt(more - less), less)};
}

/** Returns for each facet the first facet with the same corners in any order. */
std::vector<size_t> firstsOf(const types::Mesh& mesh) {
    const std::vector<uint32_t> first = weld(mesh);
    std::vector<std::pair<std::array<uint32_t, 3>, size_t>> facets;
    facets.reserve(mesh.indices.size() / 3);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array corners{first[mesh.indices[i]], first[mesh.indices[i + 1]], first[mesh.indices[i + 2]]};
        std::ranges::sort(corners);
        facets.emplace_back(corners, i / 3);
    }
    std::ranges::sort(facets);
    std::vector<size_t> firsts(facets.size());
    for (size_t k = 0; k < facets.size(); ++k) {
        const bool same = k > 0 && facets[k].first == facets[k - 1].first;
        firsts[facets[k].second] = same ? firsts[facets[k - 1].second] : facets[k].second;
    }
    return firsts;
}

}  // namespace

std::vector<CurveRecord> facetCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh) {
    const std::vector<size_t> firsts = firstsOf(mesh);
    types::Mesh once;
    once.positions = mesh.positions;
    std::vector<size_t> number(firsts.size());  // index of each facet in `once`
    for (size_t i = 0; i < firsts.size(); ++i) {
        number[i] = firsts[i] == i ? once.indices.size() / 3 : number[firsts[i]];
        if (firsts[i] == i)
            once.indices.insert(once.indices.end(), mesh.indices.data() + 3 * i, mesh.indices.data() + 3 * i + 3);
    }
    const std::vector<bool> smooth = SmoothFacets(once, world_from_mesh).smooth();
    if (std::ranges::none_of(smooth, [](bool is) { return is; })) return {};
    const std::vector<FacetRecord> facets = facetLobes(once, world_from_mesh, 0);
    std::vector<CurveRecord> curves(firsts.size(), CurveRecord{vec4(0)});
    for (size_t i = 0; i < firsts.size(); ++i) {
        const size_t t = number[i];
        if (!smooth[t]) continue;
        const auto place = [&](size_t k) {
            return world_from_mesh * glm::dvec3(once.positions[once.indices[3 * t + k]]);
        };
        const glm::dvec3 across = glm::cross(place(1) - place(0), place(2) - place(0));
        if (glm::length(across) > 0) curves[i] = curveOf(facets[t], glm::normalize(across), world_from_mesh);
    }
    return curves;
}

}  // namespace insonify::sonar
