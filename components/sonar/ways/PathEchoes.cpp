#include "components/sonar/ways/PathEchoes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <numbers>

#include "components/sonar/echo/BinLevels.hpp"
#include "components/sonar/echo/TruthGrid.hpp"
#include "components/sonar/fan/BeamFan.hpp"
#include "components/sonar/field/ScattererLattice.hpp"
#include "components/sonar/rays/SurfaceMapping.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "components/sonar/ways/Mirrors.hpp"
#include "components/sonar/ways/PathCells.hpp"
#include "components/sonar/ways/SharedBins.hpp"
#include "components/sonar/ways/WayPatterns.hpp"
#include "types/Angle.hpp"
#include "types/Hash.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

constexpr int max_bounces = MultipathConfig::max_bounces;
constexpr double reaching_back = 1.1;  ///< Cells beyond the range, up to this factor of it, may extend into it [1].
constexpr double edge_on = 1e-4;       ///< Cosine below which a surface gives no echo [1].
constexpr uint64_t surface_name = std::numeric_limits<uint64_t>::max();  ///< Water surface in the mirrors of a chain.

/** The mirrors that a ray has hit, in order. */
struct Chain {
    int count = 0;
    std::array<uint64_t, max_bounces> names{};  ///< Equal for all rays that hit the same mirror.
    std::array<MirrorPlane, max_bounces> planes;
    double power = 1;           ///< Share of the power after the mirrors [1].
    double widest = 0;          ///< Max contribution of a mirror's facet to a mean square slope, over its cosine [1].
    bool begins_lobed = false;  ///< Whether the first mirror has a lobe.
    int walls = 0;              ///< Thin walls that the ray has passed [1].
    uint64_t wall_names = 0;    ///< Equal for all rays that pass the same walls.

    bool sameAs(const Chain& other) const {
        return count == other.count && wall_names == other.wall_names &&
               std::equal(names.begin(), names.begin() + count, other.names.begin());
    }
    glm::dvec3 image(glm::dvec3 place) const {
        for (int k = count; k-- > 0;) place = planes[static_cast<size_t>(k)].image(place);
        return place;
    }
    glm::dvec3 turned(glm::dvec3 way) const {
        for (int k = count; k-- > 0;) way = planes[static_cast<size_t>(k)].turned(way);
        return way;
    }
    /** Inverts turned(). */
    glm::dvec3 turnedBack(glm::dvec3 way) const {
        for (int k = 0; k < count; ++k) way = planes[static_cast<size_t>(k)].turned(way);
        return way;
    }
};

class PathEchoes final : public PingEffect {
public:
    PathEchoes(const RenderPlan& plan, const types::Geometry& geometry);

    void takeQuality() override;
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
    std::optional<WayPatterns> patterns_;
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
    bool isActive(int i) const { return rays_.towards.active >> i & 1; }
    glm::dvec3 from(int i) const { return {rays_.from_x[i], rays_.from_y[i], rays_.from_z[i]}; }
    glm::dvec3 towards(int i) const { return {rays_.towards.x[i], rays_.towards.y[i], rays_.towards.z[i]}; }
    glm::dvec3 met(int i) const { return from(i) + double{hits_.distance[i]} * towards(i); }
    double reflected(uint32_t command) const { return paths_.reflected_[scene_.commands[command].material]; }
    void drop(int i) { rays_.towards.active &= ~(1u << i); }

    bool begin(const TracedTile& tile);
    /** Continues a ray from its hit: by a mirror, or through a wall; drops a ray that ends there. */
    void goOn(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits);
    /** Returns whether sound passes straight through a wall that is not a mirror, into water. */
    bool letsThrough(uint32_t command) const {
        if (paths_.max_walls_ == 0 || command == TileHits::nothing || reflected(command) > 0) return false;
        const WallLaw& wall = rules_.laws.walls[scene_.commands[command].material];
        return wall.letsThrough() && !wall.fill;
    }
    /** Returns the one-way share of the energy that passes a wall [1]. */
    double passedOnce(const TileHits& hits, int i, const glm::dvec3& way) const {
        const double cosine = std::abs(glm::dot(planeMet(scene_, hits, i).normal, way)) / glm::length(way);
        return std::sqrt(rules_.laws.walls[scene_.commands[hits.command[i]].material].passedAt(cosine));
    }
    void pass(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits);
    void look(int i, const glm::dvec3& at, const glm::dvec3& on);
    /** Continues a ray from the mirror that it has hit; drops a ray that has hit none in reach. */
    void reflect(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits, bool tilts);
    void send(int i, const MirrorPlane& plane, const glm::dvec3& from, const glm::dvec3& way, double distance);
    void traceOn();
    using Shares = std::array<double, tile_samples>;
    /** Returns for each ray with a hit the share of the energy that returns directly to the sonar, on the side of the
     *  hit [1]. */
    Shares openBack() const;
    Shares through(PathRays& back) const;
    void receive(const TracedTile& tile);
    int sameFrom(int i) const;
    /** `gain`: factor by surface maps [1]. */
    void deposit(const CellAngles& at, int i, double open, double gain);
    LobeSlopes lobeSlopes(const CellAngles& at, int i, const MirrorPlane& plane, const glm::dvec3& direction,
                          double range) const;
    MaterialLaws::Bistatic section(const CellAngles& at, int i, const MirrorPlane& plane, const HalfWay& way) const;
    void depositOnce(const CellAngles& at, int i, const MirrorPlane& plane, double open);
    Footprint footprint(const CellAngles& at, int i, const HalfWay& way, double size) const;
    /** Prepares the sums for echoes of ray i's hit: received from a direction, seen at a cosine. */
    void recordWay(int i, bool twice, const glm::dvec3& received, double cosine) {
        if (!paths_.records_truth_) return;
        const Chain& chain = chains_[static_cast<size_t>(i)];
        const bool by_surface = std::all_of(chain.names.begin(), chain.names.begin() + chain.count,
                                            [](uint64_t name) { return name == surface_name; });
        const PathTruth::Path way = twice ? PathTruth::SurfaceTwice : PathTruth::SurfaceOnce;
        bins_.by_way = paths_.truth_->sums(by_surface ? way : PathTruth::Bounced);
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
    double near_edge_, far_edge_;
    PathRays rays_{};
    TileHits hits_{};
    std::array<Chain, tile_samples> chains_;
    std::array<double, tile_samples> lengths_;  ///< Length of each ray's path so far [m].
    uint64_t key_ = 0;                          ///< Number of the tile.
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
        goOn(i, glm::dvec3(0), view_.cells.direction(column, row), *tile.hits);
    }
    return rays_.towards.active;
}

void PathEchoes::Tracer::goOn(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits) {
    const Chain& chain = chains_[static_cast<size_t>(i)];
    if (letsThrough(hits.command[i])) return pass(i, from, way, hits);
    if (chain.count == paths_.plan_.config.multipath->bounces) return drop(i);
    reflect(i, from, way, hits, chain.count == 0);
}

void PathEchoes::Tracer::pass(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits) {
    constexpr double min_passed = 1e-3;  // one way: 60 dB two-way
    Chain& chain = chains_[static_cast<size_t>(i)];
    chain.power *= passedOnce(hits, i, way);
    if (chain.walls == paths_.max_walls_ || !(chain.power >= min_passed)) return drop(i);
    chain.wall_names = types::hashed(chain.wall_names, hits.command[i], static_cast<uint64_t>(++chain.walls));
    lengths_[static_cast<size_t>(i)] += double{hits.distance[i]};
    look(i, from + double{hits.distance[i]} * way, way);
}

void PathEchoes::Tracer::reflect(int i, const glm::dvec3& from, const glm::dvec3& way, const TileHits& hits,
                                 bool tilts) {
    Chain& chain = chains_[static_cast<size_t>(i)];
    const auto k = static_cast<size_t>(chain.count);
    if (hits.command[i] == TileHits::nothing) {
        const double distance = paths_.water_.distance(from, way);
        if (!(lengths_[static_cast<size_t>(i)] + distance < rules_.bins.range_max)) return drop(i);
        const glm::dvec3 at = from + distance * way;
        chain.names[k] = surface_name;
        return send(i, tilts ? paths_.water_.facet(at, way, key_) : paths_.water_.plane(), from, way, distance);
    }
    const CommandRecord& command = scene_.commands[hits.command[i]];
    const double reflected = this->reflected(hits.command[i]);
    const MirrorPlane plane = planeMet(scene_, hits, i);
    const double cosine = std::abs(glm::dot(plane.normal, way));
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
    send(i, plane, from, way, double{hits.distance[i]});
}

void PathEchoes::Tracer::send(int i, const MirrorPlane& plane, const glm::dvec3& from, const glm::dvec3& way,
                              double distance) {
    Chain& chain = chains_[static_cast<size_t>(i)];
    const glm::dvec3 at = from + distance * way, on = plane.turned(way);
    double& length = lengths_[static_cast<size_t>(i)];
    length += distance;
    if (!(2 * rules_.bins.range_max - length > 0)) return drop(i);
    chain.planes[static_cast<size_t>(chain.count++)] = plane;
    look(i, at, on);
}

void PathEchoes::Tracer::look(int i, const glm::dvec3& at, const glm::dvec3& on) {
    const double length = lengths_[static_cast<size_t>(i)], left = 2 * rules_.bins.range_max - length;
    if (!(left > 0)) return drop(i);
    const glm::vec3 begin(at), ahead(on);
    rays_.from_x[i] = begin.x, rays_.from_y[i] = begin.y, rays_.from_z[i] = begin.z;
    rays_.towards.x[i] = ahead.x, rays_.towards.y[i] = ahead.y, rays_.towards.z[i] = ahead.z;
    rays_.nearest[i] = static_cast<float>(RayVisibility::nearest + 1e-6 * length);
    rays_.farthest[i] = static_cast<float>(std::min(left, paths_.water_.distance(at, on) + 1e-3));
}

void PathEchoes::Tracer::traceOn() { visibility_.trace(rays_, hits_); }

PathEchoes::Tracer::Shares PathEchoes::Tracer::openBack() const {
    PathRays back{};
    back.towards.active = 0;
    for (int i = 0; i < tile_samples; ++i) {
        back.nearest[i] = 1, back.farthest[i] = 0;
        if (!isActive(i) || hits_.command[i] == TileHits::nothing || chains_[static_cast<size_t>(i)].count == 0)
            continue;
        const glm::dvec3 at = met(i);
        const double range = glm::length(at),
                     mean = 0.5 * (range + lengths_[static_cast<size_t>(i)] + double{hits_.distance[i]});
        const MirrorPlane plane = planeMet(scene_, hits_, i);
        const bool same_side = glm::dot(plane.normal, towards(i)) * glm::dot(plane.normal, at) > 0;
        if (!same_side || !(mean < reaching_back * rules_.bins.range_max) || !(range > RayVisibility::nearest))
            continue;
        const glm::vec3 begin(at);
        back.from_x[i] = begin.x, back.from_y[i] = begin.y, back.from_z[i] = begin.z;
        back.towards.x[i] = -begin.x, back.towards.y[i] = -begin.y, back.towards.z[i] = -begin.z;
        back.nearest[i] = static_cast<float>(RayVisibility::nearest / range + 1e-6);
        back.farthest[i] = static_cast<float>(1 - RayVisibility::nearest / range);
        back.towards.active |= 1u << i;
    }
    Shares shares{};
    if (!back.towards.active) return shares;
    if (paths_.max_walls_ > 0) return through(back);
    const uint32_t open = back.towards.active & ~visibility_.blocked(back);
    for (int i = 0; i < tile_samples; ++i) shares[static_cast<size_t>(i)] = open >> i & 1;
    return shares;
}

/** Traces the paths back through thin walls. */
PathEchoes::Tracer::Shares PathEchoes::Tracer::through(PathRays& back) const {
    Shares shares{};
    for (int i = 0; i < tile_samples; ++i) shares[static_cast<size_t>(i)] = back.towards.active >> i & 1;
    TileHits hits;
    for (int wall = 0; back.towards.active; ++wall) {
        visibility_.trace(back, hits);
        for (int i = 0; i < tile_samples; ++i) {
            if (!(back.towards.active >> i & 1)) continue;
            double& share = shares[static_cast<size_t>(i)];
            const bool ends = hits.command[i] == TileHits::nothing;
            if (!ends && (wall == paths_.max_walls_ || !letsThrough(hits.command[i])))
                share = 0;
            else if (!ends)
                share *= passedOnce(hits, i, {back.towards.x[i], back.towards.y[i], back.towards.z[i]});
            if (ends || share == 0)
                back.towards.active &= ~(1u << i);
            else
                back.nearest[i] = hits.distance[i] * (1 + 1e-6f) + back.nearest[i];
        }
    }
    return shares;
}

/** Returns the number of samples from i that are a rectangle of one triangle, seen via the same mirrors. */
int PathEchoes::Tracer::sameFrom(int i) const {
    const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
    const int maximum = std::min(static_cast<int>(alignment), view_.shape.max_merged);
    int run = 1;
    while (run < maximum && isActive(i + run) && hits_.triangle[i + run] == hits_.triangle[i] &&
           hits_.command[i + run] == hits_.command[i] &&
           chains_[static_cast<size_t>(i + run)].sameAs(chains_[static_cast<size_t>(i)]))
        ++run;
    return static_cast<int>(std::bit_floor(static_cast<uint32_t>(run)));
}

void PathEchoes::Tracer::receive(const TracedTile& tile) {
    const Shares open = openBack();
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
        double of_these = 0;
        for (int k = i; k < i + merged; ++k) of_these += open[static_cast<size_t>(k)];
        deposit(CellAngles(view_, tile, i, merged), i, of_these / merged, seen.meanGain(i, merged));
        i += merged;
    }
    if (scene_.maps) hits_ = as_met;
}

Footprint PathEchoes::Tracer::footprint(const CellAngles& at, int i, const HalfWay& way, double size) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    // A path via a mirror is between the direct path and that plus the distance to the sonar's image.
    const double image = glm::length(chains_[static_cast<size_t>(i)].image(glm::dvec3(0)));
    return trapezoidFootprint(way.inverse, way.inverse, std::abs(way.per_azimuth) * at.width,
                              std::abs(way.per_elevation + way.per_azimuth * at.lean) * at.height, way.nearest,
                              run.near_limit, 1 / (1 / run.far_limit + image), near_edge_, far_edge_, size);
}

void PathEchoes::Tracer::deposit(const CellAngles& at, int i, double open, double gain) {
    const Chain& chain = chains_[static_cast<size_t>(i)];
    const MirrorPlane seen = planeMet(scene_, hits_, i);
    const glm::dvec3 focus = chain.image(glm::dvec3(0)), normal = chain.turned(seen.normal);
    const MirrorPlane plane{normal, seen.distance + glm::dot(normal, focus)};
    const double facing = glm::dot(plane.normal, at.middle);
    if (!(std::abs(facing) > edge_on && plane.distance * facing > 0)) return;
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    recordWay(i, true, at.middle, std::abs(facing));
    const HalfWay twice = halfWay(plane, glm::dvec3(0), at);
    const double strength =
        gain * rules_.strength_scale * chain.power * chain.power *
        rules_.laws.overCosine(run.material, std::abs(facing), lobeSlopes(at, i, plane, at.middle, 1 / twice.inverse));
    bins_.depositCell(footprint(at, i, twice, at.weighted), static_cast<uint>(at.cell), strength / twice.inverse);
    if (open > 0) depositOnce(at, i, plane, gain * open);
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
                                                   const HalfWay& way) const {
    const PlacedRun& run = scene_.ranges[hits_.command[i]];
    const double direct = std::abs(glm::dot(plane.normal, way.from_focus));
    const double mirrored = std::abs(glm::dot(plane.normal, at.middle));
    if (!(direct > edge_on)) return {0, 0};
    const double widest = chains_[static_cast<size_t>(i)].widest;
    const glm::dvec3 middle = glm::normalize(at.middle + way.from_focus);
    LobeSlopes slopes = lobeSlopes(at, i, plane, middle, 1 / way.inverse);
    slopes.square_1 += std::max(widest / mirrored, slopes.wave_1 / (direct * mirrored)) - slopes.wave_1;
    slopes.square_2 += std::max(widest / mirrored, slopes.wave_2 / (direct * mirrored)) - slopes.wave_2;
    slopes.wave_1 = slopes.wave_2 = 0;  // the part of a plate that a chain of plates shows does not end at its edges
    return rules_.laws.bistatic(run.material, direct, mirrored, std::abs(glm::dot(plane.normal, middle)), slopes);
}

/** Deposits the echoes of the path out directly and back via the mirrors, and of its reverse. They differ only in the
 *  directions of transmission and reception. */
void PathEchoes::Tracer::depositOnce(const CellAngles& at, int i, const MirrorPlane& plane, double open) {
    const Chain& chain = chains_[static_cast<size_t>(i)];
    const HalfWay way = halfWay(plane, chain.image(glm::dvec3(0)), at);
    const MaterialLaws::Bistatic given = section(at, i, plane, way);
    const double scale =
        rules_.strength_scale * chain.power * open / (way.back * way.back * way.inverse * way.inverse * way.inverse);
    recordWay(i, false, at.middle, std::abs(glm::dot(plane.normal, at.middle)));
    const WayPatterns& patterns = *paths_.patterns_;
    const WayPatterns::Way by_mirror = patterns.wayOf(at.middle);
    const WayPatterns::Way by_itself = patterns.wayOf(chain.turnedBack(way.from_focus));
    const double back = patterns.power(by_itself, by_mirror), there = patterns.power(by_mirror, by_itself);
    if (back > 0)
        bins_.depositCell(footprint(at, i, way, at.size * back), static_cast<uint>(at.cell),
                          scale * (given.diffuse + given.lobe));
    if (!(there > 0)) return;
    bins_.sine_elevation = chain.turnedBack(way.from_focus).z;
    // Echoes that this surface and the first mirror both reflect and scatter have their own rays from the other end.
    const bool is_direct =
        chain.begins_lobed && reflected(hits_.command[i]) > 0 && !patterns.inOneBeam(by_mirror, by_itself);
    const double strength = scale * (given.diffuse + (is_direct ? 0 : given.lobe));
    const Footprint cell = footprint(at, i, way, at.size * there);
    patterns.eachCell(by_itself,
                      [&](size_t received) { bins_.depositCell(cell, static_cast<uint>(received), strength); });
}

PathEchoes::PathEchoes(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), water_(plan.config), max_walls_(plan.has(Pass::Walls) ? plan.config.max_walls : 0) {
    for (const types::Material& material : geometry.materials)
        reflected_.push_back(reflectedPower(material, plan.config.multipath->bounces));
    takeQuality();
}

void PathEchoes::takeQuality() {
    patterns_.emplace(plan_);
    truth_.reset();
    bin_count_ = static_cast<size_t>(summedGrid(plan_).bin_count);
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
        const glm::dvec3 way =
            view.cells.direction(tile.first_column + view.shape.at[i].columns, tile.first_row + view.shape.at[i].rows);
        if (double{hits.distance[i]} > water_.distance(glm::dvec3(0), way)) hits.command[i] = TileHits::nothing;
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
    if (records_truth_ && !direct_.empty()) std::ranges::copy(bins, direct(cell).begin());
    const double quantum = quantumOf(ping);
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
        truth_->take(cell, direct(cell), ping.levels, quantumOf(ping));
    truth_->report(truth, ping.water, quantumOf(ping));
}

}  // namespace

std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan& plan, const types::Geometry& geometry) {
    return std::make_unique<PathEchoes>(plan, geometry);
}

}  // namespace insonify::sonar
