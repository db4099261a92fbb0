#include "components/sonar/RayPaths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "components/sonar/Volume.hpp"

namespace insonify::sonar {
namespace {

/** A third of the unit vectors at right angles, of which one is level in sonar axes. */
glm::dvec3 besideOf(const glm::dvec3& direction) {
    const glm::dvec3 up = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(up, direction));
}

}  // namespace

RayPaths::RayPaths(const RenderPlan& plan)
    : table_(*plan.profile, plan.grid), stretch_(plan.profile->fastest() / plan.grid.speed_of_sound) {}

void RayPaths::place(const types::Snapshot& snapshot) {
    world_from_sonar_ = glm::mat3_cast(glm::normalize(snapshot.sonar.orientation));
    table_.place(-waterViewOf(snapshot).height);
}

glm::dvec3 RayPaths::at(const glm::dvec3& direction, double range) const {
    const glm::dvec3 ray = world_from_sonar_ * direction;
    const RayTable::Place place = table_.at(std::asin(std::clamp(ray.z, -1.0, 1.0)), range);
    return glm::dvec3(place.spread * ray.x, place.spread * ray.y, place.rise) * world_from_sonar_;
}

double RayPaths::rangeOf(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near) const {
    constexpr int steps = 3;
    double range = near;
    for (int i = 0; i < steps; ++i) {
        const double here = glm::dot(normal, at(direction, range)) - distance;
        const double apart = 1e-3 * near;
        const double there = glm::dot(normal, at(direction, range + apart)) - distance;
        const double step = apart * here / (there - here);
        if (!(std::abs(step) < 0.1 * near)) break;  // along the plane
        range -= step;
    }
    return range;
}

ApparentPlane RayPaths::apparent(const glm::dvec3& normal, double distance, const glm::dvec3& direction,
                                 double near) const {
    const double range = rangeOf(normal, distance, direction, near);
    const glm::dvec3 beside = besideOf(direction), upward = glm::cross(direction, beside);
    const double angle = table_.elevationStep(), length = 1e-3 * range;
    const auto turned = [&](const glm::dvec3& aside) {
        const auto to = [&](double by) { return at(glm::normalize(direction + by * aside), range); };
        return (to(angle) - to(-angle)) / (2 * angle);
    };
    const glm::dvec3 by_beside = turned(beside), by_upward = turned(upward);
    const glm::dvec3 onward = (at(direction, range + length) - at(direction, range - length)) / (2 * length);
    const double facing = glm::dot(normal, onward), pace = glm::length(onward);
    // On the plane normal . at(direction, range) = distance, range changes with the direction by these [m].
    const double slope_beside = -glm::dot(normal, by_beside) / facing;
    const double slope_upward = -glm::dot(normal, by_upward) / facing;
    const double area = std::abs(glm::dot(glm::cross(by_beside, by_upward), onward)) / pace;  // of a steradian [m^2]
    ApparentPlane plane;
    plane.normal = direction / range - (slope_beside * beside + slope_upward * upward) / (range * range);
    plane.cosine = std::abs(facing) / (glm::length(normal) * pace);
    plane.focus = std::min(range * range / area, most_focus);
    return plane;
}

}  // namespace insonify::sonar
