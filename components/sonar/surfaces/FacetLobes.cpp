#include "components/sonar/surfaces/FacetLobes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "components/sonar/surfaces/StraightEdges.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::sonar {
namespace {

constexpr double flat = 1e-3;  ///< Normals that differ by less are equal [rad].
constexpr double similar = 4;  ///< Facets share the turn at their edge up to this ratio of areas [1].
constexpr uint32_t nobody = 0xffffffff;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/** Two unit vectors across a unit normal, and a symmetric tensor in their plane. */
struct Plane {
    glm::dvec3 u, v;
    explicit Plane(const glm::dvec3& normal) {
        const glm::dvec3 n = glm::abs(normal);
        const glm::dvec3 minimum = n.x <= n.y && n.x <= n.z ? glm::dvec3(1, 0, 0)
                                   : n.y <= n.z             ? glm::dvec3(0, 1, 0)
                                                            : glm::dvec3(0, 0, 1);
        u = glm::normalize(glm::cross(normal, minimum));
        v = glm::cross(normal, u);
    }
    /** Returns the direction in the plane in which a tensor is largest. */
    glm::dvec3 maximum(const glm::dmat3& tensor) const {
        const glm::dvec3 tu = tensor * u;
        const double uu = glm::dot(u, tu), uv = glm::dot(v, tu), vv = glm::dot(v, tensor * v);
        const double angle = std::atan2(2 * uv, uu - vv) / 2;
        return std::cos(angle) * u + std::sin(angle) * v;
    }
};

double along(const glm::dmat3& tensor, const glm::dvec3& direction) { return glm::dot(direction, tensor * direction); }

/** The area of a set of triangles and its first two moments. */
struct Moments {
    double area = 0;
    glm::dvec3 first{0};
    glm::dmat3 second{0};

    void add(double triangle_area, const std::array<glm::dvec3, 3>& corners) {
        const glm::dvec3 sum = corners[0] + corners[1] + corners[2];
        area += triangle_area;
        first += triangle_area / 3 * sum;
        second += triangle_area / 12 * glm::outerProduct(sum, sum);
        for (const glm::dvec3& corner : corners) second += triangle_area / 12 * glm::outerProduct(corner, corner);
    }
    /** Returns the mean square distances from the middle, as a tensor [m^2]. */
    glm::dmat3 spread() const {
        const glm::dvec3 middle = first / area;
        return second / area - glm::outerProduct(middle, middle);
    }
};

/** A flat part of a mesh: facets whose normals equal that of the first facet. */
struct FlatPart {
    glm::dvec3 normal;
    Moments moments;
    glm::dmat3 steps{0};                  ///< Steps of its facets, weighted by their areas [m^2].
    glm::dmat3 curvature{0};              ///< Curvatures of its facets, likewise [m].
    glm::dvec3 lean{0};                   ///< Slopes at its edges, weighted by the squares of the turns there [rad^3].
    double turns = 0, fourths = 0;        ///< Sums of squares of these turns, and of these times squares of half turns.
    glm::dvec3 outward{0};                ///< Turns at its edges times their lengths, as vectors across the edges [m].
    glm::dmat3 bend{0};                   ///< The same as a tensor [m].
    std::array<glm::dvec3, 2> axes{};     ///< Directions of its longest and of its shortest extent.
    std::array<double, 2> low{}, high{};  ///< Its ends along `axes` [m].
    std::array<double, 2> lengths{};      ///< Coherent lengths along `axes` [m].

    void turnAxes() {
        axes[0] = Plane(normal).maximum(moments.spread());
        axes[1] = glm::cross(normal, axes[0]);
        low.fill(INFINITY);
        high.fill(-INFINITY);
    }
    /** Returns whether it is part of a curve in a direction: both sides turn away equally. A part that turns on one
     *  side only ends there. */
    bool bendsAlong(const glm::dvec3& axis) const {
        constexpr double one_sided = 0.7;
        return std::abs(glm::dot(outward, axis)) < one_sided * along(bend, axis);
    }
    void reachTo(const glm::dvec3& corner) {
        for (size_t k = 0; k < 2; ++k) {
            const double at = glm::dot(axes[k], corner);
            low[k] = std::min(low[k], at);
            high[k] = std::max(high[k], at);
        }
    }
    /** Sets the lengths to the mean of the extent and that of a rectangle with the same second moment. This is exact
     *  for rectangles, and 2 % too long for slivers that end in a point, whose coherent length is 8/9 of the extent. */
    void measure() {
        const glm::dmat3 spread = moments.spread();
        for (size_t k = 0; k < 2; ++k)
            lengths[k] = (high[k] - low[k] + std::sqrt(12 * std::max(along(spread, axes[k]), 0.0))) / 2;
    }
    /** Returns the inverse squares of the lengths [1/m^2]. */
    glm::dmat3 perSquare() const {
        glm::dmat3 sum(0);
        for (size_t k = 0; k < 2; ++k)
            sum += glm::outerProduct(axes[k], axes[k]) / std::max(lengths[k] * lengths[k], 1e-12);
        return sum;
    }
};

/** Finds the records of a mesh's facets. */
class FacetLobes {
public:
    FacetLobes(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double wavelength)
        : mesh_(mesh), world_from_mesh_(world_from_mesh), wavelength_(wavelength) {
        facets_.resize(mesh.indices.size() / 3);
        edges_ = findEdges(mesh);
        std::vector<bool> has_area(facets_.size());
        for (const Edge& edge : edges_) has_area[edge.triangle] = true;
        for (uint32_t t = 0; t < facets_.size(); ++t)
            if (has_area[t]) measure(t);
        joinNeighbours();
        findSmoothParts();
        findFlatParts();
    }

    std::vector<FacetRecord> records() const {
        std::vector<FacetRecord> all;
        all.reserve(facets_.size());
        for (uint32_t t = 0; t < facets_.size(); ++t) all.push_back(makeRecord(t));
        return all;
    }

private:
    struct Facet {
        glm::dvec3 normal{0};                                        ///< Unit; 0 where it has no area.
        double area = 0;                                             ///< [m^2]
        std::array<uint32_t, 3> neighbours{nobody, nobody, nobody};  ///< Across edges that are not creases.
        uint32_t smooth = nobody, part = nobody;                     ///< Its smooth part and its flat part.
        glm::mat3 steps{0};                                          ///< Mean square slopes [1].
        glm::mat3 curvature{0};                                      ///< [1/m]
    };

    glm::dvec3 place(uint32_t vertex) const {
        return world_from_mesh_ * (glm::dvec3(mesh_.positions[vertex]) - glm::dvec3(mesh_.positions[0]));
    }
    std::array<glm::dvec3, 3> getCorners(uint32_t t) const {
        const uint32_t* index = mesh_.indices.data() + 3 * size_t{t};
        return {place(index[0]), place(index[1]), place(index[2])};
    }
    void measure(uint32_t t) {
        const std::array<glm::dvec3, 3> p = getCorners(t);
        const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(across);
        if (length > 0) facets_[t].normal = across / length, facets_[t].area = length / 2;
    }

    /** Calls act(one facet, the other, angle between their normals, edge) for edges that are not creases. */
    void eachBend(const auto& act) {
        for (size_t k = 1; k < edges_.size(); ++k) {
            const Edge &one = edges_[k - 1], &other = edges_[k];
            if (one.low != other.low || one.high != other.high) continue;
            const Facet &a = facets_[one.triangle], &b = facets_[other.triangle];
            if (!(a.area > 0 && b.area > 0)) continue;
            const double turn = angleBetween(a.normal, b.normal);
            if (turn < crease) act(one.triangle, other.triangle, turn, place(one.high) - place(one.low));
        }
    }
    void joinNeighbours() {
        eachBend([&](uint32_t one, uint32_t other, double turn, const glm::dvec3& edge) {
            turnAt(one, other, turn, edge);
            turnAt(other, one, turn, edge);
        });
    }
    /** Returns a facet's share of the turn at an edge. It is half, but almost none next to a much smaller facet, which
     *  is the curve where a flat part ends. `ratio`: its area relative to the other's. */
    static double computeShare(double ratio) {
        if (ratio < 1) return 1 - computeShare(1 / ratio);
        return ratio > similar ? similar * similar / (2 * ratio * ratio) : 0.5;
    }
    void turnAt(uint32_t t, uint32_t neighbour, double turn, const glm::dvec3& edge) {
        Facet& facet = facets_[t];
        const auto free = std::ranges::find(facet.neighbours, nobody);
        if (free != facet.neighbours.end()) *free = neighbour;
        const double own = turn * computeShare(facet.area / facets_[neighbour].area);
        const double length = glm::length(edge);
        const glm::dvec3 across = glm::cross(edge, facet.normal) / length;
        const glm::dmat3 square = glm::outerProduct(across, across);
        facet.steps += glm::mat3(2 * own * own * square);
        facet.curvature += glm::mat3(own * length / facet.area * square);
    }
    /** Adds the slope at an edge: on a smooth surface, halfway to the neighbour's normal. */
    void leanAt(uint32_t t, uint32_t neighbour, double turn, const glm::dvec3& edge) {
        FlatPart& part = parts_[facets_[t].part];
        const glm::dvec3 way = facets_[neighbour].normal - facets_[t].normal;
        const double share = computeShare(facets_[t].area / facets_[neighbour].area), length = glm::length(edge);
        const glm::dvec3 across = glm::cross(edge, facets_[t].normal) / length;
        part.outward += share * length * way;
        part.bend += share * length * turn * glm::outerProduct(across, across);
        if (std::abs(glm::dot(across, part.axes[0])) > 0.5) return;  // at an end
        part.lean += turn * turn / (1 + std::cos(turn)) * way;
        part.turns += turn * turn;
        part.fourths += std::pow(turn * std::tan(turn / 2), 2);
    }

    /** Numbers all facets that are connected, where `joined` allows the step. */
    void flood(uint32_t Facet::*number, const auto& begin, const auto& joined) {
        std::vector<uint32_t> open;
        uint32_t count = 0;
        for (uint32_t seed = 0; seed < facets_.size(); ++seed) {
            if (facets_[seed].*number != nobody || !(facets_[seed].area > 0)) continue;
            begin(facets_[seed]);
            facets_[seed].*number = count;
            open.push_back(seed);
            while (!open.empty()) {
                const Facet& at = facets_[open.back()];
                open.pop_back();
                for (const uint32_t next : at.neighbours)
                    if (next != nobody && facets_[next].*number == nobody && joined(facets_[seed], facets_[next])) {
                        facets_[next].*number = count;
                        open.push_back(next);
                    }
            }
            ++count;
        }
    }
    void findSmoothParts() {
        flood(
            &Facet::smooth, [&](const Facet&) { smooth_.emplace_back(); },
            [](const Facet&, const Facet&) { return true; });
        std::vector<Moments> moments(smooth_.size());
        for (uint32_t t = 0; t < facets_.size(); ++t)
            if (facets_[t].area > 0) moments[facets_[t].smooth].add(facets_[t].area, getCorners(t));
        std::ranges::transform(moments, smooth_.begin(), &Moments::spread);
    }
    void findFlatParts() {
        flood(
            &Facet::part,
            [&](const Facet& seed) {
                parts_.push_back({seed.normal, {}});
            },
            [](const Facet& seed, const Facet& next) { return angleBetween(seed.normal, next.normal) < flat; });
        const auto each = [&](const auto& act) {
            for (uint32_t t = 0; t < facets_.size(); ++t)
                if (facets_[t].area > 0) act(t, parts_[facets_[t].part]);
        };
        each([&](uint32_t t, FlatPart& part) {
            part.moments.add(facets_[t].area, getCorners(t));
            part.steps += facets_[t].area * glm::dmat3(facets_[t].steps);
            part.curvature += facets_[t].area * glm::dmat3(facets_[t].curvature);
        });
        for (FlatPart& part : parts_) part.turnAxes();
        eachBend([&](uint32_t one, uint32_t other, double turn, const glm::dvec3& edge) {
            leanAt(one, other, turn, edge);
            leanAt(other, one, turn, edge);
        });
        each([&](uint32_t t, FlatPart& part) {
            for (const glm::dvec3& corner : getCorners(t)) part.reachTo(corner);
        });
        for (FlatPart& part : parts_) part.measure();
    }

    FacetRecord makeRecord(uint32_t t) const {
        const Facet& facet = facets_[t];
        if (!(facet.area > 0)) return {vec4(0), vec4(0), vec4(0)};
        const FlatPart& part = parts_[facet.part];
        const double scale = std::pow(wavelength_, 2) / (4 * std::numbers::pi);
        const glm::dmat3 per_square = part.perSquare();
        std::array<glm::dvec3, 2> axes;
        axes[0] = Plane(facet.normal).maximum(part.steps / part.moments.area + std::max(scale, 1e-12) * per_square);
        axes[1] = glm::cross(facet.normal, axes[0]);
        std::array<double, 2> waves{}, steps{}, curvatures{};
        std::array<bool, 2> curved{};
        for (size_t k = 0; k < 2; ++k) {
            if (part.bendsAlong(axes[k])) {
                steps[k] = along(glm::dmat3(facet.steps), axes[k]);
                curvatures[k] = along(part.curvature / part.moments.area, axes[k]);
            }
            const double inverse = along(per_square, axes[k]);
            curved[k] = curvatures[k] > flat / 2 * std::sqrt(inverse);
            waves[k] = scale * (curved[k] ? 1 / std::max(12 * along(smooth_[facet.smooth], axes[k]), 1e-12) : inverse);
        }
        if (!curved[0] && curved[1]) {
            axes = {axes[1], -axes[0]};
            for (std::array<double, 2>* pair : {&waves, &steps, &curvatures}) std::swap((*pair)[0], (*pair)[1]);
            std::swap(curved[0], curved[1]);
        }
        if (!curved[0] && !curved[1])  // a plate of any shape returns A^2 / lambda^2
            for (double& wave : waves) wave *= part.lengths[0] * part.lengths[1] / part.moments.area;
        const auto direction = [&](size_t k, double shape) { return vec4(steps[k], waves[k], curvatures[k], shape); };
        // The normals of a cone are on a circle, a facet's inside it: along the facet they lean by (1 + x^2) / 2 of
        // their lean at its edges. The slope across, x in units of half the turn there, is 1 at the edges.
        const bool leans = curved[0] && !curved[1] && part.turns > 0;
        const double lean = leans ? glm::dot(part.lean, axes[1]) / part.turns / 2 : 0;
        return {vec4(glm::vec3(glm::transpose(world_from_mesh_) * axes[0]), 0), direction(0, lean),
                direction(1, leans ? lean * part.turns / part.fourths : 0)};
    }

    const types::Mesh& mesh_;
    glm::dmat3 world_from_mesh_;
    double wavelength_;
    std::vector<Edge> edges_;
    std::vector<Facet> facets_;
    std::vector<glm::dmat3> smooth_;  ///< Mean square extents of the smooth parts [m^2].
    std::vector<FlatPart> parts_;
};

constexpr double straight = 1e-3;  ///< Edges with a smaller turn are neither concave nor bent [rad].
constexpr double coarse = 0.3;     ///< Turn between facets of a body with 20 around it [rad].

/** Finds the facets that represent a smooth convex surface. */
class SmoothFacets {
public:
    SmoothFacets(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, std::vector<Edge> edges)
        : mesh_(mesh), world_from_mesh_(world_from_mesh), edges_(std::move(edges)) {
        for (const glm::vec3& at : mesh.positions) {
            const glm::dvec3 size = glm::abs(glm::dvec3(at));
            rounding_ = std::max({rounding_, size.x, size.y, size.z});
        }
        const auto scale = [&](int i) { return glm::length(world_from_mesh[i]); };
        rounding_ *= 0x1p-24 * std::max({scale(0), scale(1), scale(2)});
        body_.resize(mesh.indices.size() / 3);
        std::iota(body_.begin(), body_.end(), 0u);
        joinBodies();
        if (std::ranges::all_of(body_, [&](uint32_t t) { return open_[getBody(t)]; })) return;
        findVolumes();
        rough_.resize(mesh.positions.size());
        eachPair([&](const Edge& one, const Edge& other) { markRough(one, other); });
        smooth_.resize(body_.size());
        for (uint32_t t = 0; t < body_.size(); ++t) smooth_[t] = !open_[getBody(t)];
        for (const Edge& edge : edges_)
            if (rough_[edge.low] || rough_[edge.high]) smooth_[edge.triangle] = false;
    }

    /** Returns whether each facet is smooth; empty: none is. */
    const std::vector<bool>& smooth() const { return smooth_; }

private:
    glm::dvec3 place(uint32_t vertex) const {
        return world_from_mesh_ * (glm::dvec3(mesh_.positions[vertex]) - glm::dvec3(mesh_.positions[0]));
    }
    std::array<glm::dvec3, 3> getCorners(uint32_t t) const {
        const uint32_t* index = mesh_.indices.data() + 3 * size_t{t};
        return {place(index[0]), place(index[1]), place(index[2])};
    }
    uint32_t getBody(uint32_t t) {
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
            const uint32_t a = getBody(one.triangle), b = getBody(other.triangle);
            body_[std::max(a, b)] = std::min(a, b);
        });
        for (size_t k = 0, end = 0; k < edges_.size(); k = end) {
            while (end < edges_.size() && edges_[end].low == edges_[k].low && edges_[end].high == edges_[k].high) ++end;
            if (end - k != 2) open_[getBody(edges_[k].triangle)] = true;
        }
    }

    /** Computes the volumes of bodies, whose sign shows on which side of its facets the body is. */
    void findVolumes() {
        volumes_.resize(body_.size());
        for (uint32_t t = 0; t < body_.size(); ++t) {
            const auto p = getCorners(t);
            volumes_[getBody(t)] += glm::dot(p[0], glm::cross(p[1], p[2]));
        }
    }

    /** Returns the angle by which the rounding of coordinates may have turned a facet: of its corners, over its least
     *  height. A facet of 2 mm that a file has 1 km from its origin is turned by up to 0.06 rad [rad]. */
    double findRounding(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& across) const {
        const glm::dvec3 sides(glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]),
                               glm::distance(corners[2], corners[0]));
        return 2 * rounding_ * std::max({sides.x, sides.y, sides.z}) / std::max(glm::length(across), 1e-30);
    }

    /** Marks the ends of an edge that is not possible on a smooth convex surface. */
    void markRough(const Edge& one, const Edge& other) {
        const auto a = getCorners(one.triangle), b = getCorners(other.triangle);
        const glm::dvec3 n = glm::cross(a[1] - a[0], a[2] - a[0]), m = glm::cross(b[1] - b[0], b[2] - b[0]);
        const double turn = std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m));
        const glm::dvec3 onward = b[0] + b[1] + b[2] - a[0] - a[1] - a[2];
        const bool hollow = turn > std::max(straight, findRounding(a, n) + findRounding(b, m)) &&
                            glm::dot(n, onward) * volumes_[getBody(one.triangle)] > 0;
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
CurveRecord curve(const FacetRecord& facet, const glm::dvec3& normal, const glm::dmat3& world_from_mesh) {
    const glm::dmat3 mesh_from_world = glm::transpose(world_from_mesh);
    glm::dvec3 axis = glm::inverse(mesh_from_world) * glm::dvec3(facet.axis);
    double more = static_cast<double>(facet.first.z), less = static_cast<double>(facet.second.z);
    if (more < less) {
        axis = glm::cross(normal, axis);
        std::swap(more, less);
    }
    return {vec4(mesh_from_world * axis * std::sqrt(more - less), less)};
}

/** Returns for each facet the first facet with the same corners in any order; empty: all differ. `first`: of weld(). */
std::vector<uint32_t> findFirsts(const types::Mesh& mesh, const std::vector<uint32_t>& first) {
    using Facet = std::array<uint32_t, 3>;  // the two higher corners, and its number
    std::vector<uint32_t> firsts(mesh.indices.size() / 3);
    const auto forEachFacet = [&](const auto& add) {
        for (uint32_t t = 0; t < firsts.size(); ++t) {
            const uint32_t* const index = &mesh.indices[3 * size_t{t}];
            std::array corners{first[index[0]], first[index[1]], first[index[2]]};
            std::ranges::sort(corners);
            add(corners[0], Facet{corners[1], corners[2], t});
        }
    };
    bool all_differ = true;
    types::sortByVertex<Facet>(first.size(), forEachFacet, [&](std::span<const Facet> own) {
        for (size_t k = 0; k < own.size(); ++k) {
            const bool same = k > 0 && own[k][0] == own[k - 1][0] && own[k][1] == own[k - 1][1];
            firsts[own[k][2]] = same ? firsts[own[k - 1][2]] : own[k][2];
            all_differ = all_differ && !same;
        }
    });
    if (all_differ) firsts.clear();
    return firsts;
}

}  // namespace

std::vector<FacetRecord> facetLobes(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double wavelength,
                                    const StraightEdges* edges) {
    std::vector<FacetRecord> records = FacetLobes(mesh, world_from_mesh, wavelength).records();
    for (size_t t = 0; edges && t < records.size(); ++t) records[t].axis.w = edges->encloses[t] ? 1.0f : 0.0f;
    return records;
}

bool hasLobes(const types::Mesh& mesh, const MaterialLaws& laws) {
    const auto hasLobe = [&](int material) { return laws.hasLobe(static_cast<size_t>(material)); };
    return std::ranges::any_of(mesh.clusters, hasLobe, &types::Cluster::material) ||
           std::ranges::any_of(mesh.maps, [&](const types::MappedMaterial& mapped) {
               return std::ranges::any_of(mapped.map->materials, hasLobe);
           });
}

glm::dmat3 worldFromMesh(const types::Geometry& geometry, size_t mesh) {
    const auto placed = std::ranges::find(geometry.objects, static_cast<int>(mesh), &types::Object::mesh);
    return placed == geometry.objects.end() ? glm::dmat3(1) : glm::dmat3(placed->world_from_object);
}

std::vector<FacetRecord> facetLobes(const types::Geometry& geometry, const MaterialLaws& laws) {
    std::vector<FacetRecord> all;
    if (!laws.hasLobes()) return all;
    for (size_t i = 0; i < geometry.meshes.size(); ++i) {
        const types::Mesh& mesh = geometry.meshes[i];
        std::vector<FacetRecord> records(mesh.indices.size() / 3, FacetRecord{vec4(0), vec4(0), vec4(0)});
        if (hasLobes(mesh, laws)) {
            const glm::dmat3 world_from_mesh = worldFromMesh(geometry, i);
            std::optional<StraightEdges> edges;
            if (laws.sharp_turn) edges = straightEdges(mesh, world_from_mesh, *laws.sharp_turn);
            records = facetLobes(mesh, world_from_mesh, laws.wavelength.value_or(0), edges ? &*edges : nullptr);
        }
        all.insert(all.end(), records.begin(), records.end());
    }
    return all;
}

namespace {

/** Returns the curvatures of the facets of a mesh that has none twice. */
std::vector<CurveRecord> computeCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh,
                                       std::vector<Edge> edges) {
    const std::vector<bool> smooth = SmoothFacets(mesh, world_from_mesh, std::move(edges)).smooth();
    if (std::ranges::none_of(smooth, [](bool is) { return is; })) return {};
    const std::vector<FacetRecord> facets = facetLobes(mesh, world_from_mesh, 0);
    std::vector<CurveRecord> curves(facets.size(), CurveRecord{vec4(0)});
    for (size_t t = 0; t < facets.size(); ++t) {
        if (!smooth[t]) continue;
        const auto place = [&](size_t k) {
            return world_from_mesh * glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]);
        };
        const glm::dvec3 across = glm::cross(place(1) - place(0), place(2) - place(0));
        if (glm::length(across) > 0) curves[t] = curve(facets[t], glm::normalize(across), world_from_mesh);
    }
    return curves;
}

}  // namespace

std::vector<CurveRecord> facetCurves(const types::Mesh& mesh, const glm::dmat3& world_from_mesh) {
    const std::vector<uint32_t> welded = weld(mesh);
    const std::vector<uint32_t> firsts = findFirsts(mesh, welded);
    if (firsts.empty()) return computeCurves(mesh, world_from_mesh, findEdges(mesh, welded));
    types::Mesh once;
    once.positions = mesh.positions;
    std::vector<uint32_t> number(firsts.size());  // index of each facet in `once`
    for (size_t i = 0; i < firsts.size(); ++i) {
        number[i] = firsts[i] == i ? static_cast<uint32_t>(once.indices.size() / 3) : number[firsts[i]];
        if (firsts[i] == i)
            once.indices.insert(once.indices.end(), mesh.indices.data() + 3 * i, mesh.indices.data() + 3 * i + 3);
    }
    const std::vector<CurveRecord> of_once = computeCurves(once, world_from_mesh, findEdges(once));
    if (of_once.empty()) return {};
    std::vector<CurveRecord> curves(firsts.size());
    for (size_t i = 0; i < firsts.size(); ++i) curves[i] = of_once[number[i]];
    return curves;
}

}  // namespace insonify::sonar
