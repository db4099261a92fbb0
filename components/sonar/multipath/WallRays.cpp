#include "components/sonar/multipath/WallRays.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "components/sonar/base/Counters.hpp"

namespace insonify::sonar {

namespace {

/** Returns the share of the energy that a smooth material reflects like a mirror at normal incidence, all returns of
 * its wall together [1]; 0: its lobe is wide, or it has none. */
double mirroredBy(const MaterialLaws& laws, size_t material) {
    constexpr double steepest = 0.3;  // as for the second bounce (ACOUSTICS.md 5.25)
    const auto strength = static_cast<double>(laws.records[material].law.y),
               square_slope = static_cast<double>(laws.records[material].law.z);
    if (!(strength > 0) || !(square_slope < steepest * steepest)) return 0;
    const WallLaw& wall = laws.walls[material];
    const double first = wall.rings() ? static_cast<double>(wall.outside.front()) : 1;  // separateReturns()
    return std::min(4 * std::numbers::pi * strength / first, 1.0);
}

}  // namespace

Reverberation::Reverberation(const RenderPlan& plan, const types::Geometry& geometry,
                             std::span<const MeshFacts::Facets> facets) {
    if (!plan.has(Pass::Walls)) return;
    for (size_t material = 0; material < geometry.materials.size(); ++material)
        mirrored.push_back(mirroredBy(plan.laws, material));
    const auto isSmooth = [&](int material) { return mirrored[static_cast<size_t>(material)] > 0; };
    const auto isMirrorWall = [&](const types::Mesh& mesh, const types::Cluster& cluster) {
        const auto map = std::ranges::find(mesh.maps, cluster.material, &types::MappedMaterial::material);
        return plan.laws.walls[static_cast<size_t>(cluster.material)].letsThrough() &&
               (isSmooth(cluster.material) ||
                (map != mesh.maps.end() && std::ranges::any_of(map->map->materials, isSmooth)));
    };
    for (size_t mesh = 0; mesh < facets.size() && !is_there; ++mesh)
        for (const types::Cluster& cluster : geometry.meshes[mesh].clusters)
            is_there |= facets[mesh] && isMirrorWall(geometry.meshes[mesh], cluster) &&
                        std::any_of(facets[mesh]->begin() + cluster.first_index / 3,
                                    facets[mesh]->begin() + (cluster.first_index + cluster.index_count) / 3, isFlat);
    if (!plan.has(Pass::Paths)) return;
    bounces = countBounces(plan.config);
    for (const types::Material& material : geometry.materials)
        in_paths.push_back(reflectedPower(material, bounces) > 0);
}

bool WallRays::begin(const TracedTile& tile, const TileRays& rays) {
    hits_ = *tile.hits;
    bool any = false;
    for (int i = 0; i < tile_samples; ++i) {
        Ray& ray = rays_[static_cast<size_t>(i)];
        ray.is_there = (rays.active >> i & 1) && hits_.command[i] != TileHits::nothing &&
                       (getWall(i).letsThrough() || getWall(i).rings());
        if (!ray.is_there) continue;
        any = true;
        const glm::dvec3 direction(rays.x[i], rays.y[i], rays.z[i]);
        const double length = glm::length(direction);
        hits_.distance[i] *= static_cast<float>(length);
        ray.begin(direction / length);
        ray.is_in_paths = true;
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

/** Moves a ray to the surface that it has hit. */
void WallRays::meet(int i) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const WallRay::Surface surface = getSurface(i);
    ray.meet(surface.normal(), static_cast<double>(hits_.distance[i]));
    ray.echoes = ray.getEchoes(surface, water_);
}

void WallRays::countEchoes() {
    echo_ = echoes_ = 0;
    for (const Ray& ray : rays_)
        if (ray.is_there) echoes_ = std::max(echoes_, ray.echoes.size());
}

void WallRays::pass(int i, PathRays& on) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const WallRay::Surface surface = getSurface(i);
    ray.is_there = false;
    ray.is_in_paths &= !reverberation_.isInPaths(surface.run.material);
    if (!ray.pass(surface, water_)) return;
    count(Counter::WallsPassed);
    send(i, on);
}

void WallRays::send(int i, PathRays& on) const {
    const Ray& ray = rays_[static_cast<size_t>(i)];
    const double begin = RayVisibility::nearest / 10 + 1e-5 * ray.range,
                 end = std::min((rules_.bins.range_max - ray.range) * ray.medium.speed,
                                surface_.distance(ray.from, ray.direction));
    if (!(begin < end)) return;
    const glm::vec3 from(ray.from), direction(ray.direction);
    on.from_x[i] = from.x, on.from_y[i] = from.y, on.from_z[i] = from.z;
    on.towards.x[i] = direction.x, on.towards.y[i] = direction.y, on.towards.z[i] = direction.z;
    on.nearest[i] = static_cast<float>(begin);
    on.farthest[i] = static_cast<float>(end);
    on.towards.active |= 1u << i;
}

double WallRays::mirrored(int i) {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    if (!run.facets || !Reverberation::isFlat(run.facets[hits_.triangle[i]])) return 0;
    const bool from_within = rays_[static_cast<size_t>(i)].isWithin(getObject(i));
    const double within = from_within && getWall(i).fill ? getWall(i).fill->within : 1;
    TracedTile hit_tile = tile_;
    hit_tile.hits = &hits_;
    return std::min(scene_.computeMean(reverberation_.mirrored, view_, hit_tile, i) * within, 1.0);
}

void WallRays::reflect(int i, PathRays& on) {
    Ray& ray = rays_[static_cast<size_t>(i)];
    const double share = mirrored(i);
    ray.is_there = false;
    ray.power *= share * share;
    if (!(ray.power >= min_passed)) return;
    ray.reflect(ray.normal);
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
        if (ray.is_bent) apparent_[k] = ray.apparent();
    }
    tile_.late = any_late ? late_.data() : nullptr;
    tile_.apparent = any_bent ? apparent_.data() : nullptr;
    tile_.path = walls_ == 0 ? rung_in_wall : behind_walls;
    return &tile_;
}

}  // namespace insonify::sonar
