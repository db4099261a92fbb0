#include "components/sonar/surfaces/StraightEdges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::sonar {
namespace {

constexpr double same_direction = 1e-3;  ///< Lines and planes that differ by less are equal [rad].
constexpr uint32_t no_group = 0xffffffff;

double between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/** Disjoint sets that can be joined. */
class Unions {
public:
    explicit Unions(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t of(uint32_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }
    void join(uint32_t a, uint32_t b) { parent_[of(a)] = of(b); }

private:
    std::vector<uint32_t> parent_;
};

/** The side of a triangle at which its flat part ends. */
struct Side {
    Edge edge;
    glm::dvec3 inward;  ///< Unit, across the side into the triangle, in the world's axes.
    uint32_t line = no_group;
    double low = 0, high = 0;  ///< Ends along its line [m].
    bool is_smooth = false;    ///< The surface continues behind it with a small turn.
    bool echoes = false;
};

/** A stretch of a line between the same faces. */
struct Stretch {
    double low, high;
    uint32_t low_corner, high_corner;
    std::array<const Side*, 2> faces;
};

class Finder {
public:
    Finder(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double min_turn)
        : mesh_(mesh), world_from_mesh_(world_from_mesh), min_turn_(min_turn), parts_(mesh.indices.size() / 3) {
        findSides();
        groupLines();
        readMaterials();
    }

    StraightEdges find() {
        StraightEdges found;
        for (size_t first = 0; first < order_.size();) {
            size_t last = first;
            while (last < order_.size() && sides_[order_[last]].line == sides_[order_[first]].line) ++last;
            if (sides_[order_[first]].line != no_group) addLine({&order_[first], last - first});
            first = last;
        }
        omitCurves();
        for (const Stretch& stretch : stretches_) markSides(stretch);
        found.encloses = enclosed();
        for (const Stretch& stretch : stretches_) found.edges.push_back(getEdge(stretch, found.encloses));
        return found;
    }

private:
    glm::dvec3 place(uint32_t vertex) const {
        return world_from_mesh_ * (glm::dvec3(mesh_.positions[vertex]) - glm::dvec3(mesh_.positions[0]));
    }
    glm::dvec3 edgeVector(const Edge& edge) const { return place(edge.high) - place(edge.low); }
    /** Returns the unit vector across an edge into the triangle; zero where the triangle has no area. */
    glm::dvec3 computeInward(const Edge& edge) const {
        const uint32_t* index = mesh_.indices.data() + 3 * size_t{edge.triangle};
        const glm::dvec3 way = edgeVector(edge), from = place(edge.low);
        glm::dvec3 farthest(0);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 to = place(index[k]) - from;
            const glm::dvec3 across = to - glm::dot(to, way) / glm::dot(way, way) * way;
            if (glm::length(across) > glm::length(farthest)) farthest = across;
        }
        const double height = glm::length(farthest);
        return height > 1e-9 * glm::length(way) ? farthest / height : glm::dvec3(0);
    }

    /** Joins triangles of one plane, and keeps the sides at which planes end. */
    void findSides() {
        const std::vector<Edge> edges = findEdges(mesh_);
        for (size_t first = 0; first < edges.size();) {
            size_t last = first;
            std::vector<Side> sides;
            for (; last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high;
                 ++last) {
                const glm::dvec3 inward = computeInward(edges[last]);
                if (glm::dot(inward, inward) > 0) sides.push_back({edges[last], inward});
            }
            if (sides.size() == 2 && computeTurn(sides[0], sides[1]) < min_turn_)
                sides[0].is_smooth = sides[1].is_smooth = true;
            if (!isFlat(sides)) sides_.insert(sides_.end(), sides.begin(), sides.end());
            first = last;
        }
    }
    /** Returns whether faces continue behind an edge in their own planes; joins these. */
    bool isFlat(std::span<const Side> sides) {
        size_t going_on = 0;
        for (size_t i = 0; i < sides.size(); ++i) {
            const auto onward = std::ranges::find_if(
                sides, [&](const Side& other) { return between(sides[i].inward, -other.inward) < same_direction; });
            if (onward == sides.end()) continue;
            ++going_on;
            parts_.join(sides[i].edge.triangle, onward->edge.triangle);
        }
        return going_on == sides.size();
    }

    /** Gives one number to sides that follow each other on a line. */
    void groupLines() {
        std::map<uint32_t, std::vector<uint32_t>> at;  // sides by the vertices at their ends
        Unions lines(sides_.size());
        for (uint32_t i = 0; i < sides_.size(); ++i) {
            if (sides_[i].is_smooth) continue;
            sides_[i].line = i;
            for (const uint32_t corner : {sides_[i].edge.low, sides_[i].edge.high}) {
                for (const uint32_t other : at[corner]) {
                    const double angle = between(edgeVector(sides_[i].edge), edgeVector(sides_[other].edge));
                    if (std::min(angle, std::numbers::pi - angle) < same_direction) lines.join(i, other);
                }
                at[corner].push_back(i);
            }
        }
        for (uint32_t i = 0; i < sides_.size(); ++i) {
            if (sides_[i].line != no_group) sides_[i].line = lines.of(i);
            order_.push_back(i);
        }
        std::ranges::stable_sort(order_, {}, [&](uint32_t i) { return sides_[i].line; });
    }
    /** Returns the turn of a surface from one face to the other [rad]. */
    static double computeTurn(const Side& one, const Side& other) {
        return std::numbers::pi - between(one.inward, other.inward);
    }

    /** Adds the stretches of one line, between whose ends the faces are the same. */
    void addLine(std::span<const uint32_t> items) {
        const Side& longest = sides_[*std::ranges::max_element(
            items, {}, [&](uint32_t i) { return glm::length(edgeVector(sides_[i].edge)); })];
        const glm::dvec3 origin = place(longest.edge.low), along = glm::normalize(edgeVector(longest.edge));
        std::map<double, uint32_t> stops;  // corners by their places
        for (const uint32_t i : items) {
            Side& side = sides_[i];
            side.low = glm::dot(place(side.edge.low) - origin, along);
            side.high = glm::dot(place(side.edge.high) - origin, along);
            stops.emplace(side.low, side.edge.low);
            stops.emplace(side.high, side.edge.high);
            if (side.low > side.high) std::swap(side.low, side.high);
        }
        const size_t first = stretches_.size();
        for (auto stop = stops.begin(); std::next(stop) != stops.end(); ++stop) {
            const auto next = std::next(stop);
            const auto faces = facesAt(items, (stop->first + next->first) / 2);
            if (!faces) continue;
            const bool continues = stretches_.size() > first && stretches_.back().high == stop->first &&
                                   haveSameParts(stretches_.back().faces, *faces);
            if (continues) {
                stretches_.back().high = next->first;
                stretches_.back().high_corner = next->second;
            } else {
                stretches_.push_back({stop->first, next->first, stop->second, next->second, *faces});
            }
        }
    }
    /** Returns the faces of a line at a place, in the order of their parts; none where the turn is too small or there
     *  are too many. */
    std::optional<std::array<const Side*, 2>> facesAt(std::span<const uint32_t> items, double at) {
        std::vector<const Side*> faces;
        for (const uint32_t i : items) {
            const Side& side = sides_[i];
            if (side.low < at && at < side.high && std::ranges::none_of(faces, [&](const Side* other) {
                    return between(side.inward, other->inward) < same_direction;
                }))
                faces.push_back(&side);
        }
        if (faces.empty() || faces.size() > 2) return {};
        if (faces.size() == 1) return std::array{faces[0], faces[0]};
        if (computeTurn(*faces[0], *faces[1]) < min_turn_) return {};
        if (getPart(*faces[1]) < getPart(*faces[0])) std::swap(faces[0], faces[1]);
        return std::array{faces[0], faces[1]};
    }
    uint32_t getPart(const Side& side) { return parts_.of(side.edge.triangle); }
    bool haveSameParts(const std::array<const Side*, 2>& a, const std::array<const Side*, 2>& b) {
        return getPart(*a[0]) == getPart(*b[0]) && getPart(*a[1]) == getPart(*b[1]);
    }

    /** Removes stretches that continue at both ends like the facets of a curve. */
    void omitCurves() {
        std::multimap<uint32_t, size_t> at;
        for (size_t i = 0; i < stretches_.size(); ++i) {
            at.emplace(stretches_[i].low_corner, i);
            at.emplace(stretches_[i].high_corner, i);
        }
        const auto bendsAt = [&](size_t i, uint32_t corner) {
            const Stretch& own = stretches_[i];
            const uint32_t end = corner == own.low_corner ? own.high_corner : own.low_corner;
            const auto [first, last] = at.equal_range(corner);
            return std::any_of(first, last, [&](const auto& item) {
                const Stretch& other = stretches_[item.second];
                if (item.second == i || !shareAPart(own, other)) return false;
                const uint32_t beyond = corner == other.low_corner ? other.high_corner : other.low_corner;
                return between(place(corner) - place(end), place(beyond) - place(corner)) < crease - same_direction;
            });
        };
        std::vector<Stretch> kept;
        for (size_t i = 0; i < stretches_.size(); ++i)
            if (!bendsAt(i, stretches_[i].low_corner) || !bendsAt(i, stretches_[i].high_corner))
                kept.push_back(stretches_[i]);
        stretches_ = std::move(kept);
    }
    bool shareAPart(const Stretch& one, const Stretch& other) {
        return std::ranges::any_of(one.faces, [&](const Side* a) {
            return std::ranges::any_of(other.faces, [&](const Side* b) { return getPart(*a) == getPart(*b); });
        });
    }

    /** Marks the sides whose middle is on a stretch: they echo with it. */
    void markSides(const Stretch& stretch) {
        const uint32_t line = stretch.faces[0]->line;
        const auto [first, last] =
            std::ranges::equal_range(order_, line, {}, [&](uint32_t i) { return sides_[i].line; });
        for (auto i = first; i != last; ++i) {
            Side& side = sides_[*i];
            const double middle = (side.low + side.high) / 2;
            side.echoes |= stretch.low < middle && middle < stretch.high;
        }
    }
    std::vector<uint8_t> enclosed() {
        std::vector<uint8_t> whole(mesh_.indices.size() / 3, 1);
        for (const Side& side : sides_)
            if (!side.echoes) whole[getPart(side)] = 0;
        std::vector<uint8_t> all(whole.size());
        for (uint32_t t = 0; t < all.size(); ++t) {
            all[t] = whole[parts_.of(t)];
            triangles_[parts_.of(t)].push_back(t);
        }
        return all;
    }

    void readMaterials() {
        materials_.resize(mesh_.indices.size() / 3);
        for (const types::Cluster& cluster : mesh_.clusters)
            std::fill_n(materials_.begin() + cluster.first_index / 3, cluster.index_count / 3, cluster.material);
    }
    StraightEdge getEdge(const Stretch& stretch, const std::vector<uint8_t>& encloses) {
        StraightEdge edge{mesh_.positions[stretch.low_corner],
                          mesh_.positions[stretch.high_corner],
                          {},
                          {stretch.low_corner, stretch.high_corner}};
        for (size_t k = 0; k < 2; ++k) {
            const Side& side = *stretch.faces[k];
            EdgeFace& face = edge.faces[k];
            face = {side.inward, 0, materials_[side.edge.triangle], encloses[side.edge.triangle] != 0};
            const glm::dvec3 from = place(stretch.low_corner);
            for (const uint32_t t : triangles_[getPart(side)])
                for (int i = 0; i < 3; ++i)
                    face.width =
                        std::max(face.width, glm::dot(place(mesh_.indices[3 * size_t{t} + i]) - from, side.inward));
        }
        return edge;
    }

    const types::Mesh& mesh_;
    glm::dmat3 world_from_mesh_;
    double min_turn_;
    Unions parts_;  ///< Triangles of one plane.
    std::vector<Side> sides_;
    std::vector<uint32_t> order_;  ///< Sides, sorted by line.
    std::vector<Stretch> stretches_;
    std::vector<int> materials_;                           ///< Material of each triangle.
    std::map<uint32_t, std::vector<uint32_t>> triangles_;  ///< Triangles of each flat part.
};

}  // namespace

std::vector<uint32_t> weld(const types::Mesh& mesh) { return types::weldedPlaces(mesh.positions, mesh.indices); }

std::vector<Edge> findEdges(const types::Mesh& mesh) { return findEdges(mesh, weld(mesh)); }

std::vector<Edge> findEdges(const types::Mesh& mesh, const std::vector<uint32_t>& first) {
    const auto forEachEdge = [&](const auto& add) {
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const std::array corners{first[mesh.indices[i]], first[mesh.indices[i + 1]], first[mesh.indices[i + 2]]};
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t a = corners[k], b = corners[(k + 1) % 3];
                add(std::min(a, b), Edge{std::min(a, b), std::max(a, b), static_cast<uint32_t>(i / 3)});
            }
        }
    };
    return types::sortByVertex<Edge>(first.size(), forEachEdge, [](const auto&) {});
}

StraightEdges straightEdges(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, double min_turn) {
    return Finder(mesh, world_from_mesh, min_turn).find();
}

}  // namespace insonify::sonar
