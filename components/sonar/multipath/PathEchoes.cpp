#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numbers>

#include "components/sonar/base/Counters.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/multipath/PathCells.hpp"
#include "components/sonar/multipath/PathPatterns.hpp"
#include "components/sonar/multipath/WallRay.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/rays/SurfaceMapping.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "types/Check.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

constexpr uint64_t surface_name = std::numeric_limits<uint64_t>::max();  ///< Water surface in the mirrors of a chain.

class PathEchoes final : public PingEffect {
public:
    PathEchoes(const RenderPlan& plan, const types::Geometry& geometry);

    void updateQuality() override;
    void begin(const PingStart& start) override;
    bool followsRays() const override { return true; }
    void followRays(const TracedPing& ping, std::span<const TracedTile> tiles) override;
    bool addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) override;
    void addToTruth(const TracedPing& ping, types::SonarTruth& truth) override;
    std::optional<Omitted> omissions() const override { return water_.omissions(); }

private:
    class Tracer;
    /** Removes the hits of a tile's rays beyond the water surface. */
    void endAtSurface(const TracedView& view, const TracedTile& tile) const;
    /** Returns the directly received intensities of a cell; none where fields are summed. */
    std::span<float> direct(size_t cell);

    const RenderPlan& plan_;
    std::optional<PathPatterns> patterns_;
    WaterMirror water_;
    int max_walls_;                   ///< Max thin walls of a path [1].
    std::vector<double> reflected_;   ///< Share of the power that each material reflects specularly [1].
    size_t bin_count_ = 0;            ///< Sums of a cell [1].
    std::vector<uint64_t> sums_;      ///< [cell][bin], in quanta.
    std::optional<PathTruth> truth_;  ///< Made at the first ping whose truth is recorded.
    std::vector<float> direct_;       ///< [cell][bin], in pings whose truth is recorded; empty where fields are summed.
    bool records_truth_ = false;
};

/** Follows the rays of one tile after another. */
class PathEchoes::Tracer {
public:
    Tracer(PathEchoes& paths, const TracedPing& ping)
        : paths_(paths),
          rules_(ping.rules),
          view_(ping.view),
          visibility_(ping.visibility),
          scene_(ping.scene),
          bins_(rules_, paths.sums_.data()),
          water_{ping.levels.lossOfWater(), rules_.bins.bin_width / 2},
          near_edge_(rules_.edges.front()),
          far_edge_(rules_.edges[static_cast<size_t>(rules_.bins.bin_count)]) {}

    void follow(const TracedTile& tile) {
        if (!begin(tile)) return;
        while (rays_.towards.active) {
            traceOn();
            receive(tile);
            for (int i = 0; i < tile_samples; ++i)
                if (isActive(i)) goOn(i, from(i), towards(i), hits_);
        }
    }

private:
    /** Energy that returns directly from a surface met by mirrors. */
    struct Back {
        double share = 0;   ///< One way; 0: hidden [1].
        EchoTrain train;    ///< Arrivals out by mirrors and back directly.
        double cosine = 1;  ///< Cosine of its angle at the surface [1].
    };
    using Backs = std::array<Back, tile_samples>;
    bool isActive(int i) const { return rays_.towards.active >> i & 1; }
    glm::dvec3 from(int i) const { return {rays_.from_x[i], rays_.from_y[i], rays_.from_z[i]}; }
    glm::dvec3 towards(int i) const { return {rays_.towards.x[i], rays_.towards.y[i], rays_.towards.z[i]}; }
    glm::dvec3 hitPoint(int i) const { return from(i) + double{hits_.distance[i]} * towards(i); }
    double reflected(uint32_t command) const { return paths_.reflected_[scene_.commands[command].material]; }
    void drop(int i) { rays_.towards.active &= ~(1u << i); }

    bool begin(const TracedTile& tile);
    /** Continues a ray from its hit: by a mirror, or through a wall; drops a ray that ends there. */
    void goOn(int i, const glm::dvec3& from, const glm::dvec3& direction, const TileHits& hits);
    bool hasWalls() const { return paths_.max_walls_ > 0; }
    const WallLaw& getWall(uint32_t command) const { return rules_.laws.walls[scene_.commands[command].material]; }
    WallRay::Surface getSurface(const TileHits& hits, int i) const {
        const uint32_t command = hits.command[i];
        return {scene_.ranges[command], hits.triangle[i], scene_.commands[command].object, getWall(command)};
    }
    /** Returns whether sound passes through a wall that is not a mirror. */
    bool letsThrough(uint32_t command) const {
        return hasWalls() && command != TileHits::nothing && reflected(command) == 0 && getWall(command).letsThrough();
    }
    /** Passes the wall that a ray back to the sonar has hit. Returns whether it continues, straight and in water. */
    bool passBack(Back& back, const TileHits& hits, int i, const glm::dvec3& direction) const;
    void meet(int i, const TileHits& hits) {
        walled_[static_cast<size_t>(i)].meet(getSurface(hits, i).normal(), double{hits.distance[i]});
    }
    void pass(int i, const TileHits& hits);
    void look(int i, const glm::dvec3& at, const glm::dvec3& on);
    /** Continues a ray from the mirror that it has hit; drops a ray that has hit none in reach. */
    void reflect(int i, const glm::dvec3& from, const glm::dvec3& direction, const TileHits& hits, bool tilts);
    void send(int i, const MirrorPlane& plane, const glm::dvec3& from, const glm::dvec3& direction, double distance);
    void traceOn();
    /** Finds for each ray with a hit the energy that returns directly to the sonar, on the side of the hit. */
    void findBacks();
    void goBackThrough(PathRays& back);
    void receive(const TracedTile& tile);
    int sameFrom(int i) const;
    /** `gain`: factor by surface maps [1]. */
    void deposit(const CellAngles& at, int i, const Back& back, double gain);
    LobeSlopes lobeSlopes(const CellAngles& at, int i, const MirrorPlane& plane, const glm::dvec3& direction,
                          double range) const;
    MaterialLaws::Bistatic section(const CellAngles& at, int i, const MirrorPlane& plane, const HalfPath& path) const;
    void depositOnce(const CellAngles& at, int i, const MirrorPlane& plane, const Back& back, double gain);
    /** Returns the echoes of a surface for sound out by mirrors and back directly. */
    EchoTrain echoesOnce(int i, const Back& back) const;
    Footprint footprint(const CellAngles& at, int i, const HalfPath& path, double size, double late) const;
    /** Surface in the image of the space behind the mirrors, where rays are straight. */
    struct SeenPlane {
        MirrorPlane plane;
        double cosine, focus;  ///< Cosine of incidence, and intensity relative to straight rays [1].
    };
    SeenPlane seenPlane(const CellAngles& at, int i) const;
    /** Prepares the sums for echoes of ray i's hit: received from a direction, seen at a cosine. */
    void recordPath(int i, bool twice, const glm::dvec3& received, double cosine) {
        if (!paths_.records_truth_) return;
        const MirrorChain& chain = chains_[static_cast<size_t>(i)];
        const bool by_surface = std::all_of(chain.names.begin(), chain.names.begin() + chain.count,
                                            [](uint64_t name) { return name == surface_name; });
        const PathTruth::Path path = twice ? PathTruth::SurfaceTwice : PathTruth::SurfaceOnce;
        bins_.path = by_surface ? path : PathTruth::Bounced;
        bins_.by_path = paths_.truth_->sums(by_surface ? path : PathTruth::Bounced);
        bins_.truth = &*paths_.truth_;
        bins_.object = scene_.commands[hits_.command[i]].object;
        bins_.sine_elevation = received.z;
        bins_.sine_grazing = cosine;
    }

    PathEchoes& paths_;
    const EchoRules& rules_;
    const TracedView& view_;
    const RayVisibility& visibility_;
    const PlacedScene& scene_;
    SharedBins bins_;
    WallRay::Water water_;
    double near_edge_, far_edge_;
    PathRays rays_{};
    TileHits hits_{};
    std::array<MirrorChain, tile_samples> chains_;
    std::array<double, tile_samples> lengths_;  ///< Slant range of each ray so far [m].
    std::array<WallRay, tile_samples> walled_;  ///< The rays, where there are walls.
    std::array<EchoTrain, tile_samples> once_;  ///< Their sound that arrives, one way.
    Backs backs_;
    uint64_t key_ = 0;  ///< Number of the tile.
};

bool PathEchoes::Tracer::begin(const TracedTile& tile) {
    rays_.towards.active = 0;
    key_ = static_cast<uint64_t>(tile.first_column) << 32 | static_cast<uint32_t>(tile.first_row);
    for (int i = 0; i < tile_samples; ++i) {
        const uint32_t command = tile.hits->command[i];
        const bool misses = command == TileHits::nothing;
        if (misses ? !paths_.water_.reflects() : reflected(command) == 0 && !letsThrough(command)) continue;
        const int column = tile.first_column + view_.shape.at[i].columns, row = tile.first_row + view_.shape.at[i].rows;
        if (column >= tile.end_column || row >= view_.cells.rows) continue;
        rays_.towards.active |= 1u << i;
        chains_[static_cast<size_t>(i)] = {};
        lengths_[static_cast<size_t>(i)] = 0;
        if (hasWalls()) {
            walled_[static_cast<size_t>(i)].begin(view_.cells.direction(column, row));
            once_[static_cast<size_t>(i)] = {};
            if (!misses) meet(i, *tile.hits);
        }
        goOn(i, glm::dvec3(0), view_.cells.direction(column, row), *tile.hits);
    }
    return rays_.towards.active;
}

void PathEchoes::Tracer::goOn(int i, const glm::dvec3& from, const glm::dvec3& direction, const TileHits& hits) {
    const MirrorChain& chain = chains_[static_cast<size_t>(i)];
    if (letsThrough(hits.command[i])) return pass(i, hits);
    if (chain.count == countBounces(paths_.plan_.config)) return drop(i);
    reflect(i, from, direction, hits, chain.count == 0);
}

void PathEchoes::Tracer::pass(int i, const TileHits& hits) {
    MirrorChain& chain = chains_[static_cast<size_t>(i)];
    WallRay& ray = walled_[static_cast<size_t>(i)];
    const WallRay::Surface surface = getSurface(hits, i);
    const double sine = ray.sineInWater();
    if (chain.walls == paths_.max_walls_ || !ray.pass(surface, water_) ||
        !(chain.power * chain.power * ray.power >= WallRay::min_passed))
        return drop(i);
    chain.passed *= once_[static_cast<size_t>(i)].passOnce(surface.wall, sine, water_.resolution);
    chain.was_in_fill |= surface.wall.fill.has_value();
    chain.wall_names = types::hashed(chain.wall_names, hits.command[i], static_cast<uint64_t>(++chain.walls));
    lengths_[static_cast<size_t>(i)] = ray.range;
    look(i, ray.from, ray.direction);
}

void PathEchoes::Tracer::reflect(int i, const glm::dvec3& from, const glm::dvec3& direction, const TileHits& hits,
                                 bool tilts) {
    MirrorChain& chain = chains_[static_cast<size_t>(i)];
    const auto k = static_cast<size_t>(chain.count);
    if (hits.command[i] == TileHits::nothing) {
        const double distance = paths_.water_.distance(from, direction);
        if (!(lengths_[static_cast<size_t>(i)] + distance < rules_.bins.range_max)) return drop(i);
        const glm::dvec3 at = from + distance * direction;
        const MirrorPlane plane = tilts ? paths_.water_.facet(at, direction, key_) : paths_.water_.plane();
        chain.names[k] = surface_name;
        if (hasWalls()) walled_[static_cast<size_t>(i)].meet(plane.normal, distance);
        return send(i, plane, from, direction, distance);
    }
    const CommandRecord& command = scene_.commands[hits.command[i]];
    const double reflected = this->reflected(hits.command[i]);
    const MirrorPlane plane = planeMet(scene_, hits, i);
    const double cosine = std::abs(glm::dot(plane.normal, direction));
    if (reflected == 0 || !(cosine > edge_on)) return drop(i);
    chain.names[k] = uint64_t{hits.command[i]} << 32 | hits.triangle[i];
    chain.power *= reflected;
    if (const FacetRecord* facets = scene_.ranges[hits.command[i]].facets) {
        const FacetRecord& facet = facets[hits.triangle[i]];
        const auto spread = [](const vec4& along) {
            return static_cast<double>(along.x) + static_cast<double>(along.y);
        };
        chain.widest = std::max(chain.widest, std::sqrt(spread(facet.first) * spread(facet.second)) / cosine);
    }
    chain.begins_lobed |= k == 0 && rules_.laws.records[command.material].law.y > 0;
    send(i, plane, from, direction, double{hits.distance[i]});
}

void PathEchoes::Tracer::send(int i, const MirrorPlane& plane, const glm::dvec3& from, const glm::dvec3& direction,
                              double distance) {
    MirrorChain& chain = chains_[static_cast<size_t>(i)];
    const glm::dvec3 at = from + distance * direction, on = plane.turned(direction);
    double& length = lengths_[static_cast<size_t>(i)];
    length += distance;
    if (hasWalls()) {
        walled_[static_cast<size_t>(i)].reflect(plane.normal);
        length = walled_[static_cast<size_t>(i)].range;
    }
    if (!(2 * rules_.bins.range_max - length > 0)) return drop(i);
    chain.planes[static_cast<size_t>(chain.count++)] = plane;
    look(i, at, on);
}

void PathEchoes::Tracer::look(int i, const glm::dvec3& at, const glm::dvec3& on) {
    const double length = lengths_[static_cast<size_t>(i)],
                 speed = hasWalls() ? walled_[static_cast<size_t>(i)].medium.speed : 1,
                 left = (2 * rules_.bins.range_max - length) * speed;
    if (!(left > 0)) return drop(i);
    const glm::vec3 begin(at), ahead(on);
    rays_.from_x[i] = begin.x, rays_.from_y[i] = begin.y, rays_.from_z[i] = begin.z;
    rays_.towards.x[i] = ahead.x, rays_.towards.y[i] = ahead.y, rays_.towards.z[i] = ahead.z;
    rays_.nearest[i] = static_cast<float>(RayVisibility::nearest + 1e-6 * length);
    rays_.farthest[i] = static_cast<float>(std::min(left, paths_.water_.distance(at, on) + 1e-3));
}

void PathEchoes::Tracer::traceOn() {
    visibility_.trace(rays_, hits_);
    for (int i = 0; i < tile_samples && hasWalls(); ++i)
        if (isActive(i) && hits_.command[i] != TileHits::nothing) meet(i, hits_);
}

void PathEchoes::Tracer::findBacks() {
    PathRays on{};
    on.towards.active = 0;
    for (int i = 0; i < tile_samples; ++i) {
        Back& back = backs_[static_cast<size_t>(i)];
        const MirrorChain& chain = chains_[static_cast<size_t>(i)];
        back.share = 0;
        on.nearest[i] = 1, on.farthest[i] = 0;
        if (!isActive(i) || hits_.command[i] == TileHits::nothing || chain.count == 0 || chain.was_in_fill) continue;
        const glm::dvec3 at = hitPoint(i);
        const double range = glm::length(at),
                     mean = 0.5 * (range + lengths_[static_cast<size_t>(i)] + double{hits_.distance[i]});
        const MirrorPlane plane = planeMet(scene_, hits_, i);
        const bool same_side = glm::dot(plane.normal, towards(i)) * glm::dot(plane.normal, at) > 0;
        if (!same_side || !(mean < reaching_back * rules_.bins.range_max) || !(range > RayVisibility::nearest))
            continue;
        const glm::vec3 begin(at);
        on.from_x[i] = begin.x, on.from_y[i] = begin.y, on.from_z[i] = begin.z;
        on.towards.x[i] = -begin.x, on.towards.y[i] = -begin.y, on.towards.z[i] = -begin.z;
        on.nearest[i] = static_cast<float>(RayVisibility::nearest / range + 1e-6);
        on.farthest[i] = static_cast<float>(1 - RayVisibility::nearest / range);
        on.towards.active |= 1u << i;
        if (!hasWalls()) continue;
        back.share = 1;
        back.train = once_[static_cast<size_t>(i)];
        back.cosine = std::min(std::abs(glm::dot(plane.normal, at)) / range, 1.0);
    }
    if (hasWalls()) return goBackThrough(on);
    const uint32_t open = on.towards.active ? on.towards.active & ~visibility_.blocked(on) : 0;
    for (int i = 0; i < tile_samples; ++i) backs_[static_cast<size_t>(i)].share = open >> i & 1;
}

/** Traces the paths back through thin walls. */
void PathEchoes::Tracer::goBackThrough(PathRays& on) {
    TileHits hits;
    for (int wall = 0; on.towards.active; ++wall) {
        visibility_.trace(on, hits);
        for (int i = 0; i < tile_samples; ++i) {
            if (!(on.towards.active >> i & 1)) continue;
            Back& back = backs_[static_cast<size_t>(i)];
            const bool ends = hits.command[i] == TileHits::nothing;
            if (!ends && (wall == paths_.max_walls_ ||
                          !passBack(back, hits, i, {on.towards.x[i], on.towards.y[i], on.towards.z[i]})))
                back.share = 0;
            if (ends || back.share == 0)
                on.towards.active &= ~(1u << i);
            else
                on.nearest[i] = hits.distance[i] * (1 + 1e-6f) + on.nearest[i];
        }
    }
}

bool PathEchoes::Tracer::passBack(Back& back, const TileHits& hits, int i, const glm::dvec3& direction) const {
    if (!letsThrough(hits.command[i]) || getWall(hits.command[i]).fill) return false;
    const double cosine = std::abs(glm::dot(planeMet(scene_, hits, i).normal, direction)) / glm::length(direction);
    back.share *=
        back.train.passOnce(getWall(hits.command[i]), std::sqrt(std::max(1 - cosine * cosine, 0.0)), water_.resolution);
    count(Counter::WallsPassed, back.share > 0);
    return back.share > 0;
}

/** Returns the number of samples from i that are a rectangle of one triangle, seen via the same mirrors. */
int PathEchoes::Tracer::sameFrom(int i) const {
    const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
    const int maximum = std::min(static_cast<int>(alignment), view_.shape.max_merged);
    int run = 1;
    while (run < maximum && isActive(i + run) && hits_.triangle[i + run] == hits_.triangle[i] &&
           hits_.command[i + run] == hits_.command[i] &&
           chains_[static_cast<size_t>(i + run)].sameAs(chains_[static_cast<size_t>(i)]) &&
           !(hasWalls() && walled_[static_cast<size_t>(i)].is_bent))
        ++run;
    return static_cast<int>(std::bit_floor(static_cast<uint32_t>(run)));
}

void PathEchoes::Tracer::receive(const TracedTile& tile) {
    findBacks();
    TileHits as_met;
    TracedTile seen = tile;
    seen.hits = &hits_;
    if (scene_.maps) {
        as_met = hits_;
        thread_local MappedTiles mapped;
        mapped.take(view_, scene_, {&seen, 1}, true);
        seen = mapped.whole().front();
        hits_ = *seen.hits;
    }
    for (int i = 0; i < tile_samples;) {
        if (!isActive(i) || hits_.command[i] == TileHits::nothing || chains_[static_cast<size_t>(i)].count == 0) {
            ++i;
            continue;
        }
        const int merged = sameFrom(i);
        double share = 0;
        const Back* open = nullptr;
        for (int k = i; k < i + merged; ++k) {
            share += backs_[static_cast<size_t>(k)].share / merged;
            if (!open && share > 0) open = &backs_[static_cast<size_t>(k)];
        }
        Back* const back = &backs_[static_cast<size_t>(i)];
        if (open && open != back) *back = *open;
        back->share = share;
        deposit(CellAngles(view_, tile, i, merged), i, *back, seen.meanGain(i, merged));
        i += merged;
    }
    if (scene_.maps) hits_ = as_met;
}

Footprint PathEchoes::Tracer::footprint(const CellAngles& at, int i, const HalfPath& path, double size,
                                        double late) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    // A path via a mirror is between the direct path and that plus the distance to the sonar's image.
    const double image = glm::length(chains_[static_cast<size_t>(i)].image(glm::dvec3(0)));
    double near_limit = run.near_limit, far_limit = 1 / (1 / run.far_limit + image + std::max(late, 0.0));
    if (late < 0) near_limit = std::max(near_limit, 1 / std::max(1 / near_limit + late, 1e-3));
    if (hasWalls() && walled_[static_cast<size_t>(i)].is_bent) near_limit = 1e3, far_limit = 0;
    return trapezoidFootprint(path.inverse, path.inverse, std::abs(path.per_azimuth) * at.width,
                              std::abs(path.per_elevation + path.per_azimuth * at.lean) * at.height, path.nearest,
                              near_limit, far_limit, near_edge_, far_edge_, size);
}

PathEchoes::Tracer::SeenPlane PathEchoes::Tracer::seenPlane(const CellAngles& at, int i) const {
    const MirrorChain& chain = chains_[static_cast<size_t>(i)];
    if (hasWalls() && walled_[static_cast<size_t>(i)].is_bent) {
        const ApparentPlane apparent = walled_[static_cast<size_t>(i)].apparent();
        const double length = glm::length(apparent.normal);
        return {{apparent.normal / length, 1 / length}, apparent.cosine, apparent.focus};
    }
    const MirrorPlane seen = planeMet(scene_, hits_, i);
    const glm::dvec3 normal = chain.turned(seen.normal);
    const MirrorPlane plane{normal, seen.distance + glm::dot(normal, chain.image(glm::dvec3(0)))};
    return {plane, std::abs(glm::dot(normal, at.middle)), 1};
}

void PathEchoes::Tracer::deposit(const CellAngles& at, int i, const Back& back, double gain) {
    const MirrorChain& chain = chains_[static_cast<size_t>(i)];
    const auto [plane, cosine, focus] = seenPlane(at, i);
    if (!(cosine > edge_on && plane.distance * glm::dot(plane.normal, at.middle) > 0)) return;
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    recordPath(i, true, at.middle, cosine);
    count(Counter::MirrorPaths);
    const HalfPath twice = computeHalfPath(plane, glm::dvec3(0), at);
    const double passed = hasWalls() ? walled_[static_cast<size_t>(i)].power : 1;
    const double strength =
        gain * rules_.strength_scale * chain.power * chain.power * passed * focus *
        rules_.laws.overCosine(run.material, cosine, lobeSlopes(at, i, plane, at.middle, 1 / twice.inverse));
    const EchoTrain echoes =
        hasWalls() ? walled_[static_cast<size_t>(i)].getEchoes(getSurface(hits_, i), water_) : EchoTrain();
    for (size_t k = 0; k < echoes.size(); ++k) {
        HalfPath path = twice;
        if (echoes[k].late != 0) path.moveAway(echoes[k].late);
        bins_.depositCell(footprint(at, i, path, at.weighted, echoes[k].late), static_cast<uint>(at.cell),
                          strength * echoes[k].weight / path.inverse);
    }
    if (back.share > 0) depositOnce(at, i, plane, back, gain);
}

EchoTrain PathEchoes::Tracer::echoesOnce(int i, const Back& back) const {
    if (!hasWalls()) return {};
    const WallRay& ray = walled_[static_cast<size_t>(i)];
    const WallRay::Surface surface = getSurface(hits_, i);
    if (!surface.wall.rings()) return back.train;
    const double there = surface.wall.spacing(ray.sineInWater()),
                 here = surface.wall.spacing(std::sqrt(std::max(1 - back.cosine * back.cosine, 0.0))),
                 inset = surface.wall.thickness * 0.5 * (1 / ray.cosine + 1 / std::max(back.cosine, edge_on));
    return WallRay::rung(back.train, surface.wall, ray.isWithin(surface.object),
                         std::min(there, here) > 0 ? 0.5 * (there + here) : 0, std::min(inset, 0.5 * ray.length_met),
                         water_.resolution);
}

/** Returns the slopes of the lobe of a cell along a direction, in the image of space behind the mirrors. */
LobeSlopes PathEchoes::Tracer::lobeSlopes(const CellAngles& at, int i, const MirrorPlane& plane,
                                          const glm::dvec3& direction, double range) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    if (!run.facets || !rules_.laws.hasLobe(run.material)) return {};
    LobeSample sample{};
    sample.facet = run.facets[hits_.triangle[i]];
    sample.normal = plane.normal;
    sample.axis = chains_[static_cast<size_t>(i)].turned(turned(run, sample.facet.axis));
    sample.range = range;
    sample.lookAlong(direction);
    sample.width = at.width;
    sample.height = at.height;
    return rules_.laws.lobeSlopes(run.material, sample);
}

/** Returns the scattering of a cell for sound that arrives directly and returns via the mirrors, or the other way
 *  round. */
MaterialLaws::Bistatic PathEchoes::Tracer::section(const CellAngles& at, int i, const MirrorPlane& plane,
                                                   const HalfPath& path) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    const double direct = std::abs(glm::dot(plane.normal, path.from_focus));
    const double mirrored = std::abs(glm::dot(plane.normal, at.middle));
    if (!(direct > edge_on)) return {0, 0};
    const double widest = chains_[static_cast<size_t>(i)].widest;
    const glm::dvec3 middle = glm::normalize(at.middle + path.from_focus);
    LobeSlopes slopes = lobeSlopes(at, i, plane, middle, 1 / path.inverse);
    slopes.square_1 += std::max(widest / mirrored, slopes.wave_1 / (direct * mirrored)) - slopes.wave_1;
    slopes.square_2 += std::max(widest / mirrored, slopes.wave_2 / (direct * mirrored)) - slopes.wave_2;
    slopes.wave_1 = slopes.wave_2 = 0;  // the part of a plate that a chain of plates shows does not end at its edges
    return rules_.laws.bistatic(run.material, direct, mirrored, std::abs(glm::dot(plane.normal, middle)), slopes);
}

/** Deposits the echoes of the path out directly and back via the mirrors, and of its reverse. They differ only in the
 *  directions of transmission and reception. */
void PathEchoes::Tracer::depositOnce(const CellAngles& at, int i, const MirrorPlane& plane, const Back& back,
                                     double gain) {
    const MirrorChain& chain = chains_[static_cast<size_t>(i)];
    const HalfPath straight = computeHalfPath(plane, chain.image(glm::dvec3(0)), at);
    const MaterialLaws::Bistatic given = section(at, i, plane, straight);
    const PathPatterns& patterns = *paths_.patterns_;
    const glm::dvec3 itself = chain.turnedBack(straight.from_focus);
    const PathPatterns::Direction by_mirror = patterns.toDirection(at.middle), by_itself = patterns.toDirection(itself);
    const double returned = patterns.power(by_itself, by_mirror), sent = patterns.power(by_mirror, by_itself);
    // Echoes that this surface and the first mirror both reflect and scatter have their own rays from the other end.
    const bool is_direct =
        chain.begins_lobed && reflected(hits_.command[i]) > 0 && !patterns.inOneBeam(by_mirror, by_itself);
    recordPath(i, false, at.middle, std::abs(glm::dot(plane.normal, at.middle)));
    count(Counter::MirrorPaths, static_cast<uint64_t>(returned > 0) + static_cast<uint64_t>(sent > 0));
    const EchoTrain echoes = echoesOnce(i, back);
    for (size_t k = 0; k < echoes.size(); ++k) {
        const double late = echoes[k].late;
        HalfPath path = straight;
        if (late != 0) path.moveAway(late);
        const double scale = gain * rules_.strength_scale * chain.power * chain.passed * back.share * echoes[k].weight /
                             (path.back * path.back * path.inverse * path.inverse * path.inverse);
        bins_.sine_elevation = at.middle.z;
        if (returned > 0)
            bins_.depositCell(footprint(at, i, path, at.size * returned, late), static_cast<uint>(at.cell),
                              scale * (given.diffuse + given.lobe));
        if (!(sent > 0)) continue;
        bins_.sine_elevation = itself.z;
        const double strength = scale * (given.diffuse + (is_direct ? 0 : given.lobe));
        const Footprint cell = footprint(at, i, path, at.size * sent, late);
        patterns.eachCell(by_itself,
                          [&](size_t received) { bins_.depositCell(cell, static_cast<uint>(received), strength); });
    }
}

PathEchoes::PathEchoes(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), water_(plan.config), max_walls_(plan.has(Pass::Walls) ? plan.config.max_walls : 0) {
    for (const types::Material& material : geometry.materials)
        reflected_.push_back(reflectedPower(material, countBounces(plan.config)));
    updateQuality();
}

void PathEchoes::updateQuality() {
    patterns_.emplace(plan_);
    truth_.reset();
    bin_count_ = static_cast<size_t>(plan_.summed.bin_count);
    sums_.assign(plan_.cells.size() * bin_count_, 0);
}

void PathEchoes::begin(const PingStart& start) {
    records_truth_ = start.truth;
    if (records_truth_ && !truth_) {
        truth_.emplace(plan_, bin_count_);
        direct_.assign(plan_.features.has(Feature::Speckle) ? 0 : sums_.size(), 0);
    }
    if (records_truth_) truth_->begin();
    water_.place(start.snapshot, plan_.grid.range_max);
    std::ranges::fill(sums_, 0);
}

void PathEchoes::endAtSurface(const TracedView& view, const TracedTile& tile) const {
    TileHits& hits = *tile.hits;
    for (int i = 0; i < tile_samples; ++i) {
        if (hits.command[i] == TileHits::nothing) continue;
        const glm::dvec3 direction =
            view.cells.direction(tile.first_column + view.shape.at[i].columns, tile.first_row + view.shape.at[i].rows);
        if (double{hits.distance[i]} > water_.distance(glm::dvec3(0), direction)) hits.command[i] = TileHits::nothing;
    }
}

void PathEchoes::followRays(const TracedPing& ping, std::span<const TracedTile> tiles) {
    if (water_.reflects())
        for (const TracedTile& tile : tiles) endAtSurface(ping.view, tile);
    Tracer tracer(*this, ping);
    for (const TracedTile& tile : tiles) tracer.follow(tile);
}

std::span<float> PathEchoes::direct(size_t cell) {
    return direct_.empty() ? std::span<float>() : std::span(direct_).subspan(cell * bin_count_, bin_count_);
}

bool PathEchoes::addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) {
    INSONIFY_CHECK(bins.size() == bin_count_ && cell < plan_.cells.size(), bins.size(), bin_count_, cell);
    if (records_truth_ && !direct_.empty()) std::ranges::copy(bins, direct(cell).begin());
    const double quantum = computeQuantum(ping);
    const uint64_t* sums = sums_.data() + cell * bins.size();
    uint64_t any = 0;
    for (size_t j = 0; j < bins.size(); ++j) {
        if (sums[j] == 0) continue;
        any |= sums[j];
        const double sum = double{bins[j]} + double{ping.levels.intensity(j, static_cast<double>(sums[j]) * quantum)};
        bins[j] = static_cast<float>(std::min(sum, double{std::numeric_limits<float>::max()}));
    }
    return any != 0;
}

void PathEchoes::addToTruth(const TracedPing& ping, types::SonarTruth& truth) {
    for (size_t cell = 0; cell < plan_.cells.size(); ++cell)
        truth_->take(cell, direct(cell), ping.levels, computeQuantum(ping));
    truth_->report(truth, ping.water, computeQuantum(ping));
}

}  // namespace

std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan& plan, const types::Geometry& geometry) {
    return std::make_unique<PathEchoes>(plan, geometry);
}

}  // namespace insonify::sonar
