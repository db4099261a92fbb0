#include "components/sonar/rays/WallRays.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

namespace insonify::sonar {

double Reverberation::mirrored(const MaterialLaws& laws, size_t material) {
    constexpr double steepest = 0.3;  // as for the second bounce (ACOUSTICS.md 5.25)
    const auto strength = static_cast<double>(laws.records[material].law.y),
               square_slope = static_cast<double>(laws.records[material].law.z);
    if (!(strength > 0) || !(square_slope < steepest * steepest)) return 0;
    const WallLaw& wall = laws.walls[material];
    const double first = wall.rings() ? static_cast<double>(wall.outside.front()) : 1;  // takeReturnsApart()
    return std::min(4 * std::numbers::pi * strength / first, 1.0);
}

Reverberation::Reverberation(const RenderPlan& plan, const types::Geometry& geometry,
                             std::span<const MeshFacts::Facets> facets) {
    if (!plan.has(Pass::Walls)) return;
    const auto isMirrorWall = [&](const types::Cluster& cluster) {
        const auto material = static_cast<size_t>(cluster.material);
        return plan.laws.walls[material].letsThrough() && mirrored(plan.laws, material) > 0;
    };
    for (size_t mesh = 0; mesh < facets.size() && !is_there; ++mesh)
        for (const types::Cluster& cluster : geometry.meshes[mesh].clusters)
            is_there |= facets[mesh] && isMirrorWall(cluster) &&
                        std::any_of(facets[mesh]->begin() + cluster.first_index / 3,
                                    facets[mesh]->begin() + (cluster.first_index + cluster.index_count) / 3, isFlat);
    if (!plan.has(Pass::Paths)) return;
    bounces = bouncesOf(plan.config);
    for (const types::Material& material : geometry.materials)
        in_paths.push_back(reflectedPower(material, bounces) > 0);
}

bool WallRays::begin(const TracedTile& tile, const TileRays& rays) {
    hits_ = *tile.hits;
    bool any = false;
    for (int i = 0; i < tile_samples; ++i) {
        Ray& ray = rays_[static_cast<size_t>(i)];
        ray.is_there = (rays.active >> i & 1) && hits_.command[i] != TileHits::nothing &&
                       (wallOf(i).letsThrough() || wallOf(i).rings());
        if (!ray.is_there) continue;
        any = true;
        const glm::dvec3 way(rays.x[i], rays.y[i], rays.z[i]);
        const double length = glm::length(way);
        hits_.distance[i] *= static_cast<float>(length);
        ray.from = glm::dvec3(0);
        ray.way = ray.look = way / length;
        const glm::dvec3 up = std::abs(ray.look.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        ray.across[0] = glm::normalize(glm::cross(up, ray.look));
        ray.across[1] = glm::cross(ray.look, ray.across[0]);
        for (int k = 0; k < 2; ++k) ray.per_from[k] = glm::dvec3(0), ray.per_way[k] = ray.across[k];
        ray.is_bent = false;
        ray.is_in_paths = true;
        ray.range = 0;
        ray.power = 1;
        ray.medium = {};
        ray.bodies_count = 0;
        ray.train = {};
    }
    if (!any) return false;
    tile_ = tile;
    tile_.hits = &shown_;
    tile_.passed = passed_.data();
    walls_ = reflections_ = 0;
    for (int i = 0; i < tile_samples; ++i)
        if (rays_[static_cast<size_t>(i)].is_there) meet(i);
    countEchoes();
    for (Ray& ray : rays_)
        if (ray.is_there) ray.echoes.take(1);  // deposited already
    return true;
}

const TracedTile* WallRays::next() {
    while (echo_ >= echoes_)
        if (!goOn()) return nullptr;
    return show(echo_++);
}

int WallRays::bodyOf(const Ray& ray, uint32_t object) {
    for (int k = ray.bodies_count; k-- > 0;)
        if (ray.bodies[k].object == object) return k;
    return -1;
}

/** Moves a ray to the surface that it has hit. */
void WallRays::meet(int i) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    const auto length = static_cast<double>(hits_.distance[i]);
    const glm::dvec3 normal = glm::normalize(turned(run, run.planes[hits_.triangle[i]].normal));
    ray.normal = glm::dot(normal, ray.way) > 0 ? -normal : normal;
    ray.cosine = std::clamp(-glm::dot(ray.normal, ray.way), 1e-9, 1.0);
    ray.from += length * ray.way;
    for (int k = 0; k < 2; ++k) {
        const glm::dvec3 moved = ray.per_from[k] + length * ray.per_way[k];
        ray.per_from[k] = moved + glm::dot(ray.normal, moved) / ray.cosine * ray.way;
    }
    ray.range += length / ray.medium.speed;
    ray.power *= std::exp(-2 * ray.medium.attenuation * length);
    setEchoes(i);
}

void WallRays::setEchoes(int i) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const WallLaw& wall = wallOf(i);
    ray.echoes = ray.train;
    const bool from_within = bodyOf(ray, objectOf(i)) >= 0;
    if (from_within && wall.fill) ray.echoes.scale(wall.fill->within);
    if (!wall.rings()) return;
    const Returns& returns = from_within ? wall.inside : wall.outside;
    ray.echoes = ray.echoes.then(returns, wall.spacing(sineInWater(ray)), rules_.bins.bin_width / 2);
    ray.echoes.scale(1 / static_cast<double>(wall.outside.front()));
    if (from_within) {  // the wall is inside the surface
        const double chord = 0.5 * static_cast<double>(hits_.distance[i]);
        ray.echoes.moveAway(-std::min(wall.thickness / ray.cosine, chord) / ray.medium.speed);
    }
}

void WallRays::countEchoes() {
    echo_ = echoes_ = 0;
    for (const Ray& ray : rays_)
        if (ray.is_there) echoes_ = std::max(echoes_, ray.echoes.size());
}

void WallRays::enter(Ray& ray, uint32_t object, const WallLaw& wall) const {
    const int known = bodyOf(ray, object);
    if (known >= 0) {
        std::move(ray.bodies + known + 1, ray.bodies + ray.bodies_count, ray.bodies + known);
        --ray.bodies_count;
    } else if (ray.bodies_count < max_bodies) {
        const Medium fill =
            wall.fill ? Medium{wall.fill->speed_ratio, wall.fill->attenuation - loss_of_water_ / wall.fill->speed_ratio}
                      : Medium{};
        ray.bodies[ray.bodies_count++] = {object, fill};
    }
}

/** Refracts a ray at the surface that it has hit, into another medium. Returns false if it is totally reflected. */
bool WallRays::refract(int i, double speed) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const double ratio = speed / ray.medium.speed, square = 1 - ratio * ratio * (1 - ray.cosine * ray.cosine);
    if (!(square > 1e-6)) return false;
    const double cosine = std::sqrt(square), along = ratio * ray.cosine - cosine;
    // The normal of a smooth convex body turns by S dx, S = w + b b^T (shaders/interface.glsl, CurveRecord).
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    const vec4 curve = run.curves ? run.curves[hits_.triangle[i]].bend : vec4(0, 0, 0, 0);
    const glm::dvec3 bend = turned(run, curve);
    const double outward = glm::dot(turned(run, run.planes[hits_.triangle[i]].normal), ray.normal) > 0 ? 1 : -1;
    for (int k = 0; k < 2; ++k) {
        const glm::dvec3& moved = ray.per_from[k];
        const glm::dvec3 per_normal = outward * (static_cast<double>(curve.w) * moved + glm::dot(bend, moved) * bend);
        const double per_cosine = -(glm::dot(per_normal, ray.way) + glm::dot(ray.normal, ray.per_way[k]));
        const double per_along = (ratio - ratio * ratio * ray.cosine / cosine) * per_cosine;
        ray.per_way[k] = ratio * ray.per_way[k] + per_along * ray.normal + along * per_normal;
    }
    ray.way = glm::normalize(ratio * ray.way + along * ray.normal);
    ray.is_bent = true;
    return true;
}

void WallRays::pass(int i, PathRays& on) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const WallLaw& wall = wallOf(i);
    ray.is_there = false;
    const double sine = sineInWater(ray);
    if (!wall.letsThrough() || !(sine < 1)) return;
    const double cosine = std::sqrt(1 - sine * sine);
    ray.power *= wall.passedAt(cosine);
    if (!(ray.power >= min_passed)) return;
    if (wall.rings()) {
        const double spacing = wall.spacing(sine);
        ray.train = ray.train.then(wall.behind, spacing, rules_.bins.bin_width / 2);
        // The wall delays sound like d c cos(theta_l) / c_l of water, and replaces d cos(theta) of it.
        if (spacing > 0) ray.train.moveAway(spacing - wall.thickness * cosine);
    }
    ray.is_in_paths &= !wall.fill && !reverberation_.isInPaths(scene_.ranges[hits_.command[i]].material);
    enter(ray, objectOf(i), wall);
    const Medium next = ray.bodies_count > 0 ? ray.bodies[ray.bodies_count - 1].fill : Medium{};
    if (next.speed != ray.medium.speed && !refract(i, next.speed)) return;
    ray.medium = next;
    send(i, on);
}

void WallRays::send(int i, PathRays& on) const {
    const Ray& ray = rays_[static_cast<size_t>(i)];
    const double begin = RayVisibility::nearest / 10 + 1e-5 * ray.range,
                 end = std::min((rules_.bins.range_max - ray.range) * ray.medium.speed,
                                surface_.distance(ray.from, ray.way));
    if (!(begin < end)) return;
    const glm::vec3 from(ray.from), way(ray.way);
    on.from_x[i] = from.x, on.from_y[i] = from.y, on.from_z[i] = from.z;
    on.towards.x[i] = way.x, on.towards.y[i] = way.y, on.towards.z[i] = way.z;
    on.nearest[i] = static_cast<float>(begin);
    on.farthest[i] = static_cast<float>(end);
    on.towards.active |= 1u << i;
}

double WallRays::mirrored(int i) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    if (!run.facets || !Reverberation::isFlat(run.facets[hits_.triangle[i]])) return 0;
    const bool from_within = bodyOf(rays_[static_cast<size_t>(i)], objectOf(i)) >= 0;
    const double within = from_within && wallOf(i).fill ? wallOf(i).fill->within : 1;
    return std::min(Reverberation::mirrored(rules_.laws, run.material) * within, 1.0);
}

void WallRays::reflect(int i, PathRays& on) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const double share = mirrored(i);
    ray.is_there = false;
    ray.power *= share * share;
    if (!(ray.power >= min_passed)) return;
    ray.way -= 2 * glm::dot(ray.normal, ray.way) * ray.normal;
    for (glm::dvec3& per_way : ray.per_way) per_way -= 2 * glm::dot(ray.normal, per_way) * ray.normal;
    ray.is_bent = true;
    ray.is_in_paths &= reverberation_.isInPaths(scene_.ranges[hits_.command[i]].material);
    send(i, on);
}

bool WallRays::advance(void (WallRays::*step)(int, PathRays&)) {
    PathRays on{};
    on.towards.active = 0;
    for (int i = 0; i < tile_samples; ++i) {
        on.nearest[i] = 1;  // ray that ends
        if (rays_[static_cast<size_t>(i)].is_there) (this->*step)(i, on);
    }
    if (!on.towards.active) return false;
    visibility_.trace(on, hits_);
    for (int i = 0; i < tile_samples; ++i) {
        Ray& ray = rays_[static_cast<size_t>(i)];
        ray.is_there = (on.towards.active >> i & 1) && hits_.command[i] != TileHits::nothing;
        if (ray.is_there) meet(i);
    }
    return true;
}

bool WallRays::goOn() {
    if (!goBackAndForth()) {
        if (walls_ == max_walls_ || !advance(&WallRays::pass)) return false;
        ++walls_;
    }
    countEchoes();
    return true;
}

bool WallRays::goBackAndForth() {
    if (!reverberation_.is_there || walls_ == 0) return false;
    const auto isMirror = [&](int i) { return rays_[static_cast<size_t>(i)].is_there && mirrored(i) > 0; };
    bool any = false;
    for (int i = 0; i < tile_samples; ++i) any |= isMirror(i);
    if (any && reflections_ == 0) {
        rays_at_wall_ = rays_;
        hits_at_wall_ = hits_;
    }
    if (any && reflections_ < max_reflections && advance(&WallRays::reflect)) {
        ++reflections_;
        for (int i = 0; i < tile_samples; ++i) rays_[static_cast<size_t>(i)].is_there = isMirror(i);
        return true;
    }
    if (any || reflections_ > 0) {
        rays_ = rays_at_wall_;
        hits_ = hits_at_wall_;
    }
    reflections_ = 0;
    return false;
}

ApparentPlane WallRays::apparent(const Ray& ray) const {
    ApparentPlane plane;
    plane.normal = ray.look / ray.range;
    for (int k = 0; k < 2; ++k)
        plane.normal -= glm::dot(ray.way, ray.per_from[k]) / (ray.medium.speed * ray.range * ray.range) * ray.across[k];
    plane.cosine = ray.cosine;
    const double area = std::abs(glm::dot(glm::cross(ray.per_from[0], ray.per_from[1]), ray.way));  // per steradian
    // On return from a fluid of another speed, the rays of a steradian spread differently: reciprocity.
    const double fluid = ray.medium.speed * ray.medium.speed;
    plane.focus = fluid * std::min(ray.range * ray.range / std::max(area, 1e-30), max_focus);
    return plane;
}

const TracedTile* WallRays::show(size_t echo) {
    bool any_late = false, any_bent = false;
    shown_ = hits_;
    for (int i = 0; i < tile_samples; ++i) {
        const auto k = static_cast<size_t>(i);
        const Ray& ray = rays_[k];
        passed_[k] = late_[k] = 0;
        apparent_[k] = {};
        const bool is_known = ray.is_in_paths && reflections_ > 0 && reflections_ <= reverberation_.bounces;
        if (!ray.is_there || is_known || echo >= ray.echoes.size() || !(ray.echoes[echo].weight > min_passed)) {
            shown_.command[i] = TileHits::nothing;
            continue;
        }
        passed_[k] = static_cast<float>(ray.power * ray.echoes[echo].weight);
        late_[k] = static_cast<float>(ray.echoes[echo].late);
        any_late |= late_[k] != 0;
        any_bent |= ray.is_bent;
        if (ray.is_bent) apparent_[k] = apparent(ray);
    }
    tile_.late = any_late ? late_.data() : nullptr;
    tile_.apparent = any_bent ? apparent_.data() : nullptr;
    tile_.path = walls_ == 0 ? rung_in_wall : behind_walls;
    return &tile_;
}

}  // namespace insonify::sonar
