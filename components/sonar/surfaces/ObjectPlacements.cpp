#include "components/sonar/surfaces/ObjectPlacements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "components/sonar/surfaces/MeshFacts.hpp"
#include "components/sonar/surfaces/ObjectPlacements.hpp"
#include "types/Check.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

vec4 row(const glm::dmat4& m, int i) { return vec4(glm::dvec4(m[0][i], m[1][i], m[2][i], m[3][i])); }

/** Returns the inverse of the sonar's rotation and place, in double, so that world coordinates may be large. */
glm::dmat4 sonarFromWorld(const types::Pose& sonar) {
    glm::dmat4 inverse = glm::transpose(glm::mat4_cast(sonar.orientation));
    inverse[3] = glm::dvec4(-(glm::dmat3(inverse) * sonar.position), 1);
    return inverse;
}

/** `sonar_from_world` * `world_from_object`, subtracting the two origins before anything is rotated. */
glm::dmat4 relative(const glm::dmat3& rotation, const glm::dvec3& sonar, const glm::dmat4& world_from_object) {
    glm::dmat4 result(rotation * glm::dmat3(world_from_object));
    result[3] = glm::dvec4(rotation * (glm::dvec3(world_from_object[3]) - sonar), 1);
    return result;
}

double dot2(const glm::dvec3& v) { return glm::dot(v, v); }

constexpr double same_place = 1e-4;  ///< Corners closer than this coincide [m].

/** Returns the box along the world's axes around a placed box; an empty box for a mesh without corners [m]. */
Box placedBox(const Box& box, const glm::dmat4& place) {
    if (!(box.low.x <= box.high.x)) return {};
    const glm::dvec3 centre(place * glm::dvec4((box.low + box.high) / 2.0, 1)), half = (box.high - box.low) / 2.0;
    const glm::dvec3 reach = glm::abs(glm::dvec3(place[0])) * half.x + glm::abs(glm::dvec3(place[1])) * half.y +
                             glm::abs(glm::dvec3(place[2])) * half.z;
    return {centre - reach - same_place, centre + reach + same_place};
}

/** A place in whole numbers of `same_place`. */
std::array<int64_t, 3> findCell(const glm::dvec3& p) {
    return {std::llround(p.x / same_place), std::llround(p.y / same_place), std::llround(p.z / same_place)};
}

/** Returns the distinct places of a mesh's corners within a box of the world, ascending. */
std::vector<std::array<int64_t, 3>> cornersWithin(const types::Mesh& mesh, const glm::dmat4& place, const Box& box) {
    std::vector<std::array<int64_t, 3>> all;
    for (const glm::vec3& corner : mesh.positions) {
        const glm::dvec3 p(place * glm::dvec4(corner, 1));
        if (glm::all(glm::greaterThanEqual(p, box.low)) && glm::all(glm::lessThanEqual(p, box.high)))
            all.push_back(findCell(p));
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

}  // namespace

ObjectPlacements::ObjectPlacements(const types::Geometry& geometry, const Reach& reach, bool all)
    : geometry_(geometry), reach_(reach), all_(all), meshes_(MeshFacts::ofAll(geometry)) {
    records_.resize(geometry.objects.size());
    scratch_.reserve(4096);
    far_.resize(geometry.objects.size());
    in_view_.resize(geometry.objects.size());
    world_from_object_.resize(geometry.objects.size());
    findSurfaces();
}

void ObjectPlacements::findSurfaces() {
    const std::vector<types::Object>& objects = geometry_.objects;
    std::vector<Box> boxes;
    for (size_t i = 0; i < objects.size(); ++i) boxes.push_back(placedBox(box(i), objects[i].world_from_object));
    const auto longestEdge = [&](size_t i) {
        const glm::dmat3 m(objects[i].world_from_object);
        return meshes_[getMesh(i)]->longestEdge() * std::sqrt(dot2(m[0]) + dot2(m[1]) + dot2(m[2]));
    };
    const auto share = [&](size_t a, size_t b) {
        const Box both{glm::max(boxes[a].low, boxes[b].low), glm::min(boxes[a].high, boxes[b].high)};
        const glm::dvec3 size = both.high - both.low;
        const double thinnest = std::min({size.x, size.y, size.z});
        if (thinnest < 0 || thinnest > std::min(longestEdge(a), longestEdge(b))) return false;  // apart, or inside
        const auto getCorners = [&](size_t i) {
            return cornersWithin(geometry_.meshes[getMesh(i)], objects[i].world_from_object, both);
        };
        const auto of_a = getCorners(a);
        if (of_a.size() < 2) return false;
        const auto of_b = getCorners(b);
        return std::ranges::count_if(of_a, [&](const auto& at) { return std::ranges::binary_search(of_b, at); }) >= 2;
    };
    std::vector<size_t> surface(objects.size()), order(objects.size());
    std::iota(surface.begin(), surface.end(), size_t{0});
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::sort(order, {}, [&](size_t i) { return boxes[i].low.x; });
    for (size_t k = 0; k < order.size(); ++k)
        for (size_t l = k + 1; l < order.size() && boxes[order[l]].low.x <= boxes[order[k]].high.x; ++l)
            if (const size_t a = surface[order[k]], b = surface[order[l]]; a != b && share(order[k], order[l]))
                std::ranges::replace(surface, b, a);
    std::vector<std::vector<size_t>> members(objects.size());
    for (size_t i = 0; i < objects.size(); ++i) members[surface[i]].push_back(i);
    for (std::vector<size_t>& each : members)
        if (each.size() > 1) surfaces_.push_back(std::move(each));
}

void ObjectPlacements::joinExtents() {
    for (const std::vector<size_t>& members : surfaces_) {
        float near = 0, far = std::numeric_limits<float>::max();
        for (const size_t i : members) {
            far = std::min(far, far_[i] ? 0.0f : records_[i].extent.y);
            if (!far_[i] && in_view_[i]) near = std::max(near, records_[i].extent.x);
        }
        for (const size_t i : members)
            if (!far_[i] && in_view_[i])
                records_[i].extent.x = near, records_[i].extent.y = far;
            else if (!far_[i])
                records_[i].extent.x = std::max(records_[i].extent.x, near);
    }
}

void ObjectPlacements::place(const types::Snapshot& snapshot) {
    for (size_t i = 0; i < geometry_.objects.size(); ++i)
        world_from_object_[i] = geometry_.objects[i].world_from_object;
    for (const types::MovedObject& moved : snapshot.moved)
        INSONIFY_CHECK(moved.object < world_from_object_.size(), moved.object, world_from_object_.size());
    for (const types::MovedObject& moved : snapshot.moved) world_from_object_[moved.object] = moved.world_from_object;
    const glm::dmat3 rotation(sonarFromWorld(snapshot.sonar));
    for (size_t i = 0; i < world_from_object_.size(); ++i)
        placeObject(i, relative(rotation, snapshot.sonar.position, world_from_object_[i]));
    joinExtents();
}

bool ObjectPlacements::reaches(const glm::dvec3& centre, double radius) const {
    const double distance = glm::length(centre);
    if (!(distance > radius)) return true;
    if (distance - radius > reach_.range_max) return false;
    if (std::abs(std::asin(centre.z / distance)) > reach_.half_elevation + std::asin(radius / distance)) return false;
    if (reach_.half_azimuth >= std::numbers::pi / 2) return true;
    const double outward =
        std::abs(centre.y) * std::cos(reach_.half_azimuth) - centre.x * std::sin(reach_.half_azimuth);
    return outward <= radius;
}

vec4 ObjectPlacements::extent(size_t index, const glm::dmat4& m, double nearest_of_sphere) {
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p(corner & 1 ? box(index).high.x : box(index).low.x,
                           corner & 2 ? box(index).high.y : box(index).low.y,
                           corner & 4 ? box(index).high.z : box(index).low.z, 1);
        farthest = std::max(farthest, glm::length(glm::dvec3(m * p)));
    }
    const size_t mesh = getMesh(index);
    const double rounding = 1e-6 * farthest;  // upper bound for the floats of the search
    double nearest = nearest_of_sphere - rounding;
    if (in_view_[index]) {
        const MeshDistances found = distancesTo(geometry_.meshes[mesh], meshes_[mesh]->longestEdge(), m, scratch_);
        nearest = found.nearest - rounding;
        if (found.farthest > 0) farthest = std::min(farthest, found.farthest + rounding);
    }
    const double slack = 1e-5;  // rounding of the float that stores it
    return vec4(nearest > 1e-6 ? (1 + slack) / nearest : 1e6, farthest > 0 ? (1 - slack) / farthest : 0, 0, 0);
}

void ObjectPlacements::placeObject(size_t index, const glm::dmat4& sonar_from_object) {
    const glm::dmat3 linear(sonar_from_object);
    const double scale = std::sqrt(dot2(linear[0]) + dot2(linear[1]) + dot2(linear[2]));  // upper bound
    const Box& box = this->box(index);
    const glm::dvec3 centre(sonar_from_object * glm::dvec4((box.low + box.high) / 2.0, 1));
    const double radius = scale * glm::length(box.high - box.low) / 2;
    far_[index] = !all_ && glm::length(centre) - radius > 1.001 * reach_.range_max;
    if (far_[index]) return;
    in_view_[index] = reaches(centre, radius);
    const glm::dmat3 inverse = glm::inverse(linear);
    const glm::dmat4 normals(glm::transpose(inverse));
    const glm::dvec4 eye(-(inverse * glm::dvec3(sonar_from_object[3])), 0);
    ObjectRecord& record = records_[index];
    record = {row(sonar_from_object, 0),
              row(sonar_from_object, 1),
              row(sonar_from_object, 2),
              row(normals, 0),
              row(normals, 1),
              row(normals, 2),
              extent(index, sonar_from_object, glm::length(centre) - radius),
              vec4(eye),
              vec4(eye - glm::dvec4(vec4(eye)))};
}

}  // namespace insonify::sonar
