#include "components/sonar/multipath/WallRay.hpp"

#include <algorithm>

namespace insonify::sonar {

void WallRay::begin(const glm::dvec3& initial) {
    from = glm::dvec3(0);
    direction = look = initial;
    const glm::dvec3 up = std::abs(look.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    across[0] = glm::normalize(glm::cross(up, look));
    across[1] = glm::cross(look, across[0]);
    for (int k = 0; k < 2; ++k) per_from[k] = glm::dvec3(0), per_direction[k] = across[k];
    is_bent = false;
    range = 0;
    power = 1;
    medium = {};
    bodies_count = 0;
    train = {};
}

int WallRay::getBody(uint32_t object) const {
    for (int k = bodies_count; k-- > 0;)
        if (bodies[k].object == object) return k;
    return -1;
}

void WallRay::meet(const glm::dvec3& unit_normal, double length) {
    normal = glm::dot(unit_normal, direction) > 0 ? -unit_normal : unit_normal;
    cosine = std::clamp(-glm::dot(normal, direction), 1e-9, 1.0);
    length_met = length;
    from += length * direction;
    for (int k = 0; k < 2; ++k) {
        const glm::dvec3 moved = per_from[k] + length * per_direction[k];
        per_from[k] = moved + glm::dot(normal, moved) / cosine * direction;
    }
    range += length / medium.speed;
    power *= std::exp(-2 * medium.attenuation * length);
}

EchoTrain WallRay::rung(const EchoTrain& train, const WallLaw& wall, bool from_within, double spacing, double inset,
                        double resolution) {
    EchoTrain echoes = train.then(from_within ? wall.inside : wall.outside, spacing, resolution);
    echoes.scale(1 / static_cast<double>(wall.outside.front()));
    if (from_within) echoes.moveAway(-inset);  // the wall is inside the surface
    return echoes;
}

EchoTrain WallRay::getEchoes(const Surface& surface, const Water& water) const {
    const WallLaw& wall = surface.wall;
    const bool from_within = isWithin(surface.object);
    EchoTrain echoes = train;
    if (wall.rings())
        echoes = rung(train, wall, from_within, wall.spacing(sineInWater()),
                      std::min(wall.thickness / cosine, 0.5 * length_met) / medium.speed, water.resolution);
    if (from_within && wall.fill) echoes.scale(wall.fill->within);
    return echoes;
}

void WallRay::enter(const Surface& surface, const Water& water) {
    const int known = getBody(surface.object);
    const std::optional<WallFill>& fill = surface.wall.fill;
    if (known >= 0) {
        std::move(bodies + known + 1, bodies + bodies_count, bodies + known);
        --bodies_count;
    } else if (bodies_count < max_bodies) {
        bodies[bodies_count++] = {
            surface.object,
            fill ? Medium{fill->speed_ratio, fill->attenuation - water.loss / fill->speed_ratio} : Medium{}};
    }
}

bool WallRay::refract(const Surface& surface, double speed) {
    const double ratio = speed / medium.speed, square = 1 - ratio * ratio * (1 - cosine * cosine);
    if (!(square > 1e-6)) return false;
    const double behind = std::sqrt(square), along = ratio * cosine - behind;
    // The normal of a smooth convex body turns by S dx, S = w + b b^T (shaders/interface.glsl, CurveRecord).
    const PlacedRun& run = surface.run;
    const vec4 curve = run.curves ? run.curves[surface.triangle].bend : vec4(0, 0, 0, 0);
    const glm::dvec3 bend = turned(run, curve);
    const double outward = glm::dot(turned(run, run.planes[surface.triangle].normal), normal) > 0 ? 1 : -1;
    for (int k = 0; k < 2; ++k) {
        const glm::dvec3& moved = per_from[k];
        const glm::dvec3 per_normal = outward * (static_cast<double>(curve.w) * moved + glm::dot(bend, moved) * bend);
        const double per_cosine = -(glm::dot(per_normal, direction) + glm::dot(normal, per_direction[k]));
        const double per_along = (ratio - ratio * ratio * cosine / behind) * per_cosine;
        per_direction[k] = ratio * per_direction[k] + per_along * normal + along * per_normal;
    }
    direction = glm::normalize(ratio * direction + along * normal);
    is_bent = true;
    return true;
}

bool WallRay::pass(const Surface& surface, const Water& water) {
    const WallLaw& wall = surface.wall;
    const double sine = sineInWater();
    if (!wall.letsThrough() || !(sine < 1)) return false;
    const double in_water = std::sqrt(1 - sine * sine);
    power *= wall.passedAt(in_water);
    if (!(power >= min_passed)) return false;
    if (wall.rings()) {
        train = train.then(wall.behind, wall.spacing(sine), water.resolution);
        train.moveAway(wall.delay(sine));
    }
    enter(surface, water);
    const Medium next = bodies_count > 0 ? bodies[bodies_count - 1].fill : Medium{};
    if (next.speed != medium.speed && !refract(surface, next.speed)) return false;
    medium = next;
    return true;
}

void WallRay::reflect(const glm::dvec3& unit_normal) {
    direction -= 2 * glm::dot(unit_normal, direction) * unit_normal;
    for (glm::dvec3& turn : per_direction) turn -= 2 * glm::dot(unit_normal, turn) * unit_normal;
}

ApparentPlane WallRay::apparent() const {
    ApparentPlane plane;
    plane.normal = look / range;
    for (int k = 0; k < 2; ++k)
        plane.normal -= glm::dot(direction, per_from[k]) / (medium.speed * range * range) * across[k];
    plane.cosine = cosine;
    const double area = std::abs(glm::dot(glm::cross(per_from[0], per_from[1]), direction));  // per steradian
    // On return from a fluid of another speed, the rays of a steradian spread differently: reciprocity.
    const double fluid = medium.speed * medium.speed;
    plane.focus = fluid * std::min(range * range / std::max(area, 1e-30), max_focus);
    return plane;
}

}  // namespace insonify::sonar
