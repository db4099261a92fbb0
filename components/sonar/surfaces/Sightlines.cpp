#include "components/sonar/surfaces/Sightlines.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

#include "types/geometry/MeshRays.hpp"

namespace insonify::sonar {
namespace {

/** Directions out of an object that are not along an axis or face of a usual scene [1]. */
constexpr glm::dvec3 ways_out[] = {
    {0.61, 0.57, 0.55}, {-0.53, 0.67, -0.52}, {0.49, -0.71, -0.51}, {-0.66, -0.44, 0.61}, {0.07, 0.11, -0.99}};

constexpr size_t leaf_triangles = MeshFacts::leaf_triangles;

glm::dvec3 absoluteProduct(const glm::dmat3& matrix, const glm::dvec3& v) {
    return glm::abs(matrix[0]) * v.x + glm::abs(matrix[1]) * v.y + glm::abs(matrix[2]) * v.z;
}

/** A line in the axes of an object, for intersection with boxes. */
class LineInObject {
public:
    LineInObject(const glm::dmat3& object_from_world, const glm::dvec3& origin, const glm::dvec3& from,
                 const glm::dvec3& way)
        : from_(object_from_world * (from - origin)),
          inverse_(1.0 / (object_from_world * way)),
          rounding_(1e-12 * absoluteProduct(object_from_world, glm::abs(from) + glm::abs(origin) + glm::abs(way))) {}

    bool meets(const Box& box) const {
        const glm::dvec3 a = (box.low - rounding_ - from_) * inverse_, b = (box.high + rounding_ - from_) * inverse_;
        double enters = 0, leaves = 1;
        for (int axis = 0; axis < 3; ++axis) {  // max and min ignore NaN
            enters = std::max(enters, std::min(a[axis], b[axis]));
            leaves = std::min(leaves, std::max(a[axis], b[axis]));
        }
        return enters <= leaves;
    }

private:
    glm::dvec3 from_, inverse_, rounding_;
};

/** Returns the material of the triangle with a first index. */
int materialAt(const types::Mesh& mesh, size_t index) {
    const auto next = std::ranges::upper_bound(mesh.clusters, index, {}, &types::Cluster::first_index);
    return std::prev(next)->material;
}

bool isFinite(const glm::dmat3& matrix) {
    const glm::dvec3 sum = glm::abs(matrix[0]) + glm::abs(matrix[1]) + glm::abs(matrix[2]);
    return std::isfinite(sum.x + sum.y + sum.z);
}

}  // namespace

Sightlines::Sightlines(const types::Geometry& geometry, Lines lines)
    : geometry_(geometry), placed_(geometry.objects.size()) {
    if (lines == Lines::Many) meshes_ = MeshFacts::ofAll(geometry);
    displaced_.reserve(2 * placed_.size());
    for (size_t i = 0; i < placed_.size(); ++i) placeObject(i, geometry.objects[i].world_from_object);
}

const types::Mesh& Sightlines::getMesh(size_t object) const {
    return geometry_.meshes[static_cast<size_t>(geometry_.objects[object].mesh)];
}

void Sightlines::placeObject(size_t object, const glm::dmat4& world_from_object) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    glm::dvec3 low(infinity), high(-infinity);
    for (const types::Cluster& cluster : getMesh(object).clusters) {
        const types::WorldBox box(world_from_object, cluster.centre, cluster.half);
        low = glm::min(low, box.centre - box.half);
        high = glm::max(high, box.centre + box.half);
    }
    placed_[object] = {world_from_object, (low + high) / 2.0, (high - low) / 2.0,
                       glm::inverse(glm::dmat3(world_from_object)), false};
    placed_[object].has_inverse = isFinite(placed_[object].object_from_world);
}

void Sightlines::place(const types::Snapshot& snapshot) {
    sonar_ = snapshot.sonar.position;
    for (const uint32_t object : displaced_) placeObject(object, geometry_.objects[object].world_from_object);
    displaced_.clear();
    for (const types::MovedObject& moved : snapshot.moved) {
        placeObject(moved.object, moved.world_from_object);
        displaced_.push_back(moved.object);
    }
    for (const types::DeformedObject& deformed : snapshot.deformed) {  // their boxes are others now
        placeObject(deformed.object, glm::dmat4(placed_[deformed.object].world_from_object));
        displaced_.push_back(deformed.object);
    }
}

bool Sightlines::anyMet(size_t object, const glm::dvec3& from, const glm::dvec3& end, const auto& use) const {
    const types::Mesh& mesh = getMesh(object);
    const Placed& placed = placed_[object];
    if (mesh.clusters.empty() || !types::meetsBox(from, end, placed.centre, placed.half)) return false;
    if (meshes_.empty() || !placed.has_inverse)
        return types::anyTriangleMet(mesh, placed.world_from_object, from, end, use);
    const LineInObject line(placed.object_from_world, glm::dvec3(placed.world_from_object[3]), from, end);
    const types::TrianglesOnLine triangles{mesh, placed.world_from_object, from, end};
    return meshes_[static_cast<size_t>(geometry_.objects[object].mesh)]->triangles().any(
        [&](const Box& box) { return line.meets(box); },
        [&](size_t item) {
            const size_t first = 3 * leaf_triangles * item;
            return triangles.any(first, std::min(3 * leaf_triangles, mesh.indices.size() - first), use);
        });
}

bool Sightlines::isOpen(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 end = to - from;
    const double range = glm::length(end);
    const auto hides = [&](double share, bool, size_t) {
        return share * range > nearest && (1 - share) * range > nearest;
    };
    for (size_t i = 0; i < placed_.size(); ++i)
        if (anyMet(i, from, end, hides)) return false;
    return true;
}

bool Sightlines::findWalls(const glm::dvec3& from, const glm::dvec3& to, const std::vector<bool>& are_walls,
                           std::vector<WallHit>& walls) const {
    const glm::dvec3 end = to - from;
    const double range = glm::length(end);
    walls.clear();
    for (size_t i = 0; i < placed_.size(); ++i) {
        const auto hides = [&](double share, bool, size_t index) {
            if (!(share * range > nearest && (1 - share) * range > nearest)) return false;
            const auto material = static_cast<size_t>(materialAt(getMesh(i), index));
            if (!are_walls[material]) return true;
            walls.push_back({share * range, std::abs(glm::dot(normalAt(i, index), end)) / range, material});
            return false;
        };
        if (anyMet(i, from, end, hides)) return false;
    }
    std::ranges::sort(walls, {}, &WallHit::range);
    return true;
}

glm::dvec3 Sightlines::normalAt(size_t object, size_t index) const {
    const types::Mesh& mesh = getMesh(object);
    const auto corner = [&](size_t i) {
        return glm::dvec3(placed_[object].world_from_object * glm::dvec4(mesh.positions[mesh.indices[i]], 1));
    };
    const glm::dvec3 a = corner(index), across = glm::cross(corner(index + 1) - a, corner(index + 2) - a);
    const double area = glm::length(across);
    return area > 0 ? across / area : glm::dvec3(0);
}

std::optional<uint32_t> Sightlines::enclosing() const {
    const auto isAround = [this](size_t object) {
        const Placed& placed = placed_[object];
        if (glm::any(glm::greaterThan(glm::abs(sonar_ - placed.centre), placed.half))) return false;
        return std::ranges::all_of(ways_out, [&](const glm::dvec3& way) {
            int backs = 0;  // number in excess of fronts: inside, the line leaves once more than it enters
            anyMet(object, sonar_, way * (4 * glm::length(placed.half)), [&](double, bool is_back, size_t) {
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
