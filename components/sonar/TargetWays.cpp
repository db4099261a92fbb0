#include "components/sonar/TargetWays.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <tuple>

namespace insonify::sonar {
namespace {

/** World matrix of an object in a ping. */
const glm::dmat4& placeOf(const types::Geometry& geometry, const types::Snapshot& snapshot, size_t object) {
    const auto moved = std::ranges::find(snapshot.moved, object, &types::MovedObject::object);
    return moved == snapshot.moved.end() ? geometry.objects[object].world_from_object : moved->world_from_object;
}

}  // namespace

/** Of a point of its plane. One on the edge of two triangles is in one of them. */
bool TargetWays::Mirror::holds(const glm::dvec3& point) const {
    if (is_surface) return true;
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const bool turned = std::tie(to.x, to.y, to.z) < std::tie(from.x, from.y, from.z);
        const glm::dvec3 &low = turned ? to : from, &high = turned ? from : to;
        const double side = glm::dot(glm::cross(high - low, point - low), plane.normal);
        return turned ? side < 0 : side >= 0;
    };
    return inside(a, b) && inside(b, c) && inside(c, a);
}

TargetWays::TargetWays(const SonarConfig& config, const types::Geometry& geometry)
    : geometry_(geometry),
      bounces_(config.tracesPaths() ? config.multipath->bounces : 0),
      sightlines_(geometry),
      water_(config) {
    for (size_t object = 0; object < geometry.objects.size(); ++object)
        for (const types::Cluster& cluster :
             geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)].clusters) {
            const types::Material& material = geometry.materials[static_cast<size_t>(cluster.material)];
            for (size_t i = 0; bounces_ > 0 && material.mirror && i < cluster.index_count; i += 3)
                sources_.push_back({object, cluster.first_index + i, reflectedPower(material, bounces_)});
        }
    mirrors_.reserve(sources_.size() + 1);
    ways_.reserve(16);
    chain_.reserve(2);
}

void TargetWays::place(const types::Snapshot& snapshot, double range_max) {
    sightlines_.place(snapshot);
    sonar_ = snapshot.sonar.position;
    sonar_from_world_ = glm::conjugate(snapshot.sonar.orientation);
    longest_ = 2 * range_max;
    mirrors_.clear();
    if (bounces_ > 0) placeMirrors(snapshot, range_max);
}

void TargetWays::placeMirrors(const types::Snapshot& snapshot, double range_max) {
    water_.place(snapshot, range_max);
    if (water_.reflects()) {
        Mirror surface;
        surface.plane = {{0, 0, 1}, *snapshot.water_surface};
        surface.is_surface = true;
        mirrors_.push_back(surface);
    }
    for (const Source& source : sources_) {
        const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[source.object].mesh)];
        const glm::dmat4& place = placeOf(geometry_, snapshot, source.object);
        const auto corner = [&](size_t k) {
            return glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[source.first_index + k]], 1));
        };
        Mirror mirror;
        mirror.a = corner(0), mirror.b = corner(1), mirror.c = corner(2);
        const glm::dvec3 across = glm::cross(mirror.b - mirror.a, mirror.c - mirror.a);
        if (!(glm::length(across) > 0)) continue;
        mirror.plane.normal = glm::normalize(across);
        mirror.plane.distance = glm::dot(mirror.plane.normal, mirror.a);
        mirror.power = source.power;
        mirrors_.push_back(mirror);
    }
}

const std::vector<TargetWay>& TargetWays::waysTo(const glm::dvec3& point) {
    ways_.clear();
    chain_.clear();
    if (!water_.reflects() || point.z < mirrors_.front().plane.distance) follow(point, bounces_);
    return ways_;
}

void TargetWays::follow(const glm::dvec3& point, int bounces) {
    addWay(point);
    if (bounces == 0) return;
    for (const Mirror& mirror : mirrors_) {
        if (!chain_.empty() && chain_.back() == &mirror) continue;
        chain_.push_back(&mirror);
        follow(point, bounces - 1);
        chain_.pop_back();
    }
}

void TargetWays::addWay(const glm::dvec3& point) {
    // What is seen behind the first k mirrors of the chain: the point's image in those that follow them.
    std::array<glm::dvec3, 3> images;
    images[chain_.size()] = point;
    for (size_t k = chain_.size(); k-- > 0;) images[k] = chain_[k]->plane.image(images[k + 1]);
    TargetWay way;
    way.length = glm::distance(sonar_, images[0]);
    if (!(way.length > 0 && way.length <= longest_)) return;
    way.direction = sonar_from_world_ * ((images[0] - sonar_) / way.length);
    glm::dvec3 from = sonar_;
    for (size_t k = 0; k < chain_.size(); ++k) {
        const Mirror& mirror = *chain_[k];
        const double here = glm::dot(mirror.plane.normal, from) - mirror.plane.distance;
        const double there = glm::dot(mirror.plane.normal, images[k]) - mirror.plane.distance;
        if (!(here * there < 0)) return;
        const glm::dvec3 at = from + here / (here - there) * (images[k] - from);
        if (!mirror.holds(at) || !sightlines_.isOpen(from, at)) return;
        way.power *= mirror.power;
        way.by_surface |= mirror.is_surface;
        if (mirror.is_surface) way.sine_grazing = std::abs(here) / glm::distance(from, at);
        from = at;
    }
    if (!sightlines_.isOpen(from, point)) return;
    way.reflections = static_cast<int>(chain_.size());
    ways_.push_back(way);
}

}  // namespace insonify::sonar
