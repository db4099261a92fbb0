#include "components/sonar/Sightlines.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <span>

namespace insonify::sonar {
namespace {

/** A box along an object's axes as one along the world's that holds it, rounded by the floats that tell it. */
struct Box {
    glm::dvec3 centre, half;

    Box(const glm::dmat4& world_from_object, const glm::dvec3& middle, const glm::dvec3& told)
        : centre(world_from_object * glm::dvec4(middle, 1)) {
        const glm::dmat3 linear(world_from_object);
        const glm::dvec3 reach = told + 1e-6 * (glm::abs(middle) + told);
        half = glm::abs(linear[0]) * reach.x + glm::abs(linear[1]) * reach.y + glm::abs(linear[2]) * reach.z;
    }
};

/** Whether a line from `from` to `from + way` meets a box, or nearly. */
bool meets(const glm::dvec3& from, const glm::dvec3& way, const glm::dvec3& centre, const glm::dvec3& half) {
    double enters = 0, leaves = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = half[axis] + 1e-9 * (std::abs(centre[axis]) + half[axis] + 1);
        const double low = centre[axis] - reach - from[axis], high = centre[axis] + reach - from[axis];
        if (way[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const double a = low / way[axis], b = high / way[axis];
        enters = std::max(enters, std::min(a, b));
        leaves = std::min(leaves, std::max(a, b));
    }
    return enters <= leaves;
}

/** Where on its way from the origin a line meets a triangle [1], and whether at its back; none where it passes by.
 *  Möller and Trumbore 1997, edges included. */
struct Met {
    double share;
    bool is_back;
};
std::optional<Met> meetsTriangle(const glm::dvec3& way, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    constexpr double slack = 1e-12;
    const glm::dvec3 along = b - a, across = c - a, p = glm::cross(way, across);
    const double volume = glm::dot(along, p);
    if (volume == 0) return {};
    const double u = -glm::dot(a, p) / volume;
    const glm::dvec3 q = glm::cross(-a, along);
    const double v = glm::dot(way, q) / volume;
    if (u < -slack || v < -slack || u + v > 1 + slack) return {};
    return Met{glm::dot(across, q) / volume, volume < 0};
}

/** Calls `use` for the clusters of a mesh whose boxes, and those of the patches about them, `mayMeet` lets pass; ends
 *  when it says true, which is then returned. */
template <class MayMeet, class Use>
bool anyCluster(const types::Mesh& mesh, const MayMeet& mayMeet, const Use& use) {
    const auto among = [&](std::span<const types::Cluster> clusters) {
        return std::ranges::any_of(clusters, [&](const types::Cluster& cluster) {
            return mayMeet(cluster.centre, cluster.half) && use(cluster);
        });
    };
    if (mesh.cluster_nodes.empty()) return among(mesh.clusters);
    for (size_t i = 0; i < mesh.cluster_nodes.size();) {
        const types::ClusterNode& node = mesh.cluster_nodes[i];
        if (!mayMeet(node.centre, node.half))
            i = node.next;
        else if (++i == node.next && among(std::span(mesh.clusters).subspan(node.first_cluster, node.cluster_count)))
            return true;
    }
    return false;
}

/** Ways out that no axis or face of a usual scene lies along [1]. */
constexpr glm::dvec3 ways_out[] = {
    {0.61, 0.57, 0.55}, {-0.53, 0.67, -0.52}, {0.49, -0.71, -0.51}, {-0.66, -0.44, 0.61}, {0.07, 0.11, -0.99}};

}  // namespace

Sightlines::Sightlines(const types::Geometry& geometry) : geometry_(geometry), placed_(geometry.objects.size()) {
    displaced_.reserve(placed_.size());
    for (size_t i = 0; i < placed_.size(); ++i) placeObject(i, geometry.objects[i].world_from_object);
}

const types::Mesh& Sightlines::meshOf(size_t object) const {
    return geometry_.meshes[static_cast<size_t>(geometry_.objects[object].mesh)];
}

void Sightlines::placeObject(size_t object, const glm::dmat4& world_from_object) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    glm::dvec3 low(infinity), high(-infinity);
    for (const types::Cluster& cluster : meshOf(object).clusters) {
        const Box box(world_from_object, cluster.centre, cluster.half);
        low = glm::min(low, box.centre - box.half);
        high = glm::max(high, box.centre + box.half);
    }
    placed_[object] = {world_from_object, (low + high) / 2.0, (high - low) / 2.0};
}

void Sightlines::place(const types::Snapshot& snapshot) {
    sonar_ = snapshot.sonar.position;
    for (const uint32_t object : displaced_) placeObject(object, geometry_.objects[object].world_from_object);
    displaced_.clear();
    for (const types::MovedObject& moved : snapshot.moved) {
        placeObject(moved.object, moved.world_from_object);
        displaced_.push_back(moved.object);
    }
}

template <class Use>
bool Sightlines::anyMet(size_t object, const glm::dvec3& from, const glm::dvec3& end, const Use& use) const {
    const types::Mesh& mesh = meshOf(object);
    const glm::dmat4& place = placed_[object].world_from_object;
    if (mesh.clusters.empty() || !meets(from, end, placed_[object].centre, placed_[object].half)) return false;
    const bool mirrored = glm::determinant(glm::dmat3(place)) < 0;
    const auto mayMeet = [&](const glm::dvec3& centre, const glm::dvec3& half) {
        const Box box(place, centre, half);
        return meets(from, end, box.centre, box.half);
    };
    const auto corner = [&](size_t index) {
        return glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[index]], 1)) - from;
    };
    return anyCluster(mesh, mayMeet, [&](const types::Cluster& cluster) {
        for (size_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
            const auto met = meetsTriangle(end, corner(i), corner(i + 1), corner(i + 2));
            if (met && met->share > 0 && met->share < 1 && use(met->share, met->is_back != mirrored)) return true;
        }
        return false;
    });
}

bool Sightlines::isOpen(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 end = to - from;
    const double range = glm::length(end);
    const auto hides = [&](double share, bool) { return share * range > nearest && (1 - share) * range > nearest; };
    for (size_t i = 0; i < placed_.size(); ++i)
        if (anyMet(i, from, end, hides)) return false;
    return true;
}

std::optional<uint32_t> Sightlines::enclosing() const {
    const auto isAround = [this](size_t object) {
        const Placed& placed = placed_[object];
        if (glm::any(glm::greaterThan(glm::abs(sonar_ - placed.centre), placed.half))) return false;
        return std::ranges::all_of(ways_out, [&](const glm::dvec3& way) {
            int backs = 0;  // more than fronts: as often it is left as entered, and once more
            anyMet(object, sonar_, way * (4 * glm::length(placed.half)), [&](double, bool is_back) {
                backs += is_back ? 1 : -1;
                return false;
            });
            return backs > 0;
        });
    };
    for (size_t i = 0; i < placed_.size(); ++i)
        if (isAround(i)) return static_cast<uint32_t>(i);
    return {};
}

}  // namespace insonify::sonar
