#include "components/study/oracles/EmbreeTracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "components/acoustics/BeamPattern.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "components/study/oracles/Workers.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

constexpr int tile = 4;  ///< Rays of a packet across, and up.
static_assert(tile * tile == RayTree::packet);
constexpr int tiles_up = static_cast<int>(RayTree::packets_at_once);  ///< Tiles that are traced together.

/** Cosine and sine of an angle, for directions. */
struct Angle {
    double cosine, sine;
    explicit Angle(double radians = 0) : cosine(std::cos(radians)), sine(std::sin(radians)) {}
};

/** A column or row of cells: its middle and its edges. */
struct Strip {
    Angle middle, low, high;
    double size;  ///< Column: width [rad]. Row: difference of the sines of its edges, times its pattern weight. The
                  ///< product is a cell's weighted solid angle.
};

Strip column(double low, double high) { return {Angle((low + high) / 2), Angle(low), Angle(high), high - low}; }
Strip row(double low, double high) {
    return {Angle((low + high) / 2), Angle(low), Angle(high), std::sin(high) - std::sin(low)};
}

/** Returns the two-way weight of an elevation, by the patterns of `config` in elevation [1]. */
double computeReceived(const sonar::SonarConfig& config, double elevation) {
    double received = 1;
    if (!config.beam_pattern) return received;
    for (const auto* law : {&config.beam_pattern->transmit.elevation, &config.beam_pattern->receive.elevation})
        if (*law) received *= acoustics::BeamPattern(**law).power(elevation);
    return received;
}

/** Distribution of the inverse range over a patch of plane that fills a cell. Inverse range is a linear function over a
 *  parallelogram, so the distribution is a trapezoid with bends at the corners. */
class Spread {
public:
    explicit Spread(std::array<double, 4> corners) : w_(corners) {
        std::ranges::sort(w_);
        height_ = 2 / (w_[3] - w_[0] + w_[2] - w_[1]);
    }
    double minimum() const { return w_[0]; }
    double maximum() const { return w_[3]; }
    /** Returns whether all inverse ranges are equal to rounding. */
    bool isPoint() const { return w_[3] - w_[0] <= 1e-12 * w_[3]; }
    /** Returns the fraction below w. */
    double below(double w) const {
        if (w <= w_[0]) return 0;
        if (w >= w_[3]) return 1;
        if (w < w_[1]) return height_ * (w - w_[0]) * (w - w_[0]) / (2 * (w_[1] - w_[0]));
        if (w > w_[2]) return 1 - height_ * (w_[3] - w) * (w_[3] - w) / (2 * (w_[3] - w_[2]));
        return height_ * ((w_[1] - w_[0]) / 2 + w - w_[1]);
    }

private:
    std::array<double, 4> w_;  ///< Ascending [1/m].
    double height_;
};

}  // namespace

struct EmbreeTracer::Fan {
    explicit Fan(const types::Snapshot& scene) : tree(scene) {}

    RayTree tree;
    Workers workers;
    std::vector<Strip> columns, rows;  ///< Strips of all beams: columns by ascending bearing, rows from below.
    int columns_per_beam = 0, beams = 0;
    int stripes = 1;  ///< Stripes of rows for separate threads: more than 1 if there are few beams.
    size_t bins = 0;
    double bin_width = 0, nearest = 0, farthest = 0;  ///< [m]; 1 / the nearest and farthest range received [1/m].
    std::vector<double> inverse_edges;                ///< 1 / far edge of each bin [1/m].
    std::vector<double> sums;                         ///< [stripe][beam][bin]
    std::vector<double> longest;                      ///< For each part: max number of bins that a cell covered.
    std::vector<size_t> hits;                         ///< For each part: rays that hit something.
    double kappa_max = 0;

    int groups() const { return (beams + tile - 1) / tile; }
    int parts() const { return groups() * stripes; }
};

namespace {

/** One thread's work on a ping: the rows of a stripe for four beams. */
template <class Fan>
class Part {
public:
    Part(Fan& fan, const types::Pose& sonar, int number)
        : fan_(fan),
          number_(static_cast<size_t>(number)),
          world_from_sonar_(glm::mat3_cast(sonar.orientation)),
          sonar_from_world_(glm::transpose(world_from_sonar_)),
          from_(sonar.position - fan.tree.origin()),
          group_(number / fan.stripes),
          stripe_(number % fan.stripes),
          first_column_(group_ * tile * fan.columns_per_beam),
          end_column_(std::min(first_column_ + tile * fan.columns_per_beam, static_cast<int>(fan.columns.size()))) {}

    /** Calls `on_hit` with column, row and triangle for each ray that hits something. */
    void trace(const auto& on_hit) {
        const auto rows = static_cast<int>(fan_.rows.size());
        const int tiles = (rows + tile - 1) / tile;
        const int first = tile * (tiles * stripe_ / fan_.stripes), end = tile * (tiles * (stripe_ + 1) / fan_.stripes);
        for (int column = first_column_; column < end_column_; column += tile)
            for (int row = first; row < std::min(end, rows); row += tiles_up * tile)
                traceTiles(column, row, std::min(end, rows), on_hit);
    }

    void clear() {
        const size_t last = std::min<size_t>((static_cast<size_t>(group_) + 1) * tile, static_cast<size_t>(fan_.beams));
        std::fill(beam(static_cast<size_t>(group_) * tile), beam(last), 0.0);
        fan_.longest[number_] = 0;
    }

    void deposit(int column, int row, uint32_t triangle) {
        const RayTree::Triangle& plane = fan_.tree[triangle];
        const Strip &across = fan_.columns[static_cast<size_t>(column)], &up = fan_.rows[static_cast<size_t>(row)];
        const glm::dvec3 n = sonar_from_world_ * plane.normal;
        const double distance = plane.distance - glm::dot(plane.normal, from_);
        const auto inverseRange = [&](const Angle& azimuth, const Angle& elevation) {
            return ((n.x * azimuth.cosine + n.y * azimuth.sine) * elevation.cosine + n.z * elevation.sine) / distance;
        };
        const double middle = inverseRange(across.middle, up.middle);
        if (!(middle > 0) || !std::isfinite(middle))
            return;  // edge-on, or the float's triangle is not quite this plane
        const double cosine =
            plane.mapped ? mapped(triangle, across.middle, up.middle, middle) : middle * std::abs(distance);
        const Spread spread({inverseRange(across.low, up.low), inverseRange(across.low, up.high),
                             inverseRange(across.high, up.low), inverseRange(across.high, up.high)});
        const glm::dvec3 ahead(across.middle.cosine * up.middle.cosine, across.middle.sine * up.middle.cosine,
                               up.middle.sine);
        const double strength = fan_.tree.backscatter(
            triangle, cosine, fan_.tree.hasLobes() ? ahead * sonar_from_world_ : ahead, 1 / middle);
        share(spread, across.size * up.size * strength / middle,
              beam(static_cast<size_t>(column / fan_.columns_per_beam)));
    }

private:
    /** Traces tiles one above the other, up to a row. */
    void traceTiles(int column, int first_row, int end_row, const auto& on_hit) {
        std::array<RayTree::Rays, RayTree::packets_at_once> rays;
        std::array<RayTree::Found, RayTree::packets_at_once> found;
        const int across = std::min(tile, end_column_ - column), up = std::min(tiles_up * tile, end_row - first_row);
        const auto count = static_cast<size_t>((up + tile - 1) / tile);
        for (size_t k = 0; k < count; ++k)
            for (int i = 0; i < RayTree::packet; ++i) {  // beyond the edge: repeats the last direction
                const int aside = std::min(i % tile, across - 1), above = static_cast<int>(k) * tile + i / tile;
                rays[k].set(
                    i, computeDirection(fan_.columns[static_cast<size_t>(column + aside)].middle,
                                        fan_.rows[static_cast<size_t>(first_row + std::min(above, up - 1))].middle));
            }
        fan_.tree.trace(from_, {rays.data(), count}, {found.data(), count});
        for (int j = 0; j < up; ++j)
            for (int i = 0; i < across; ++i) {
                const RayTree::Found& in_tile = found[static_cast<size_t>(j / tile)];
                if (const uint32_t triangle = in_tile[static_cast<size_t>(tile * (j % tile) + i)];
                    triangle != RayTree::none)
                    on_hit(column + i, first_row + j, triangle);
            }
    }

    glm::dvec3 computeDirection(const Angle& azimuth, const Angle& elevation) const {
        return elevation.cosine * (azimuth.cosine * world_from_sonar_[0] + azimuth.sine * world_from_sonar_[1]) +
               elevation.sine * world_from_sonar_[2];
    }

    double mapped(uint32_t triangle, const Angle& azimuth, const Angle& elevation, double inverse_range) const {
        const glm::dvec3 direction = computeDirection(azimuth, elevation);
        return fan_.tree.mappedCosine(triangle, from_ + direction / inverse_range, direction);
    }

    double* beam(size_t beam) {
        return fan_.sums.data() + (static_cast<size_t>(stripe_) * static_cast<size_t>(fan_.beams) + beam) * fan_.bins;
    }

    /** Adds a cell's energy to the bins. Energy is proportional to the cube of inverse range; `amount` is energy over
     *  that. */
    void share(const Spread& spread, double amount, double* bins) {
        const double near = std::min(spread.maximum(), fan_.nearest), far = std::max(spread.minimum(), fan_.farthest);
        if (near < far || !(near > 0)) return;
        auto bin = static_cast<size_t>(1 / (near * fan_.bin_width));
        if (bin >= fan_.bins) return;
        if (spread.isPoint()) {
            bins[bin] += amount * near * near * near;
            return;
        }
        fan_.longest[number_] = std::max(fan_.longest[number_], (1 / far - 1 / near) / fan_.bin_width);
        double above = near, share_above = spread.below(near);
        for (; above > far && bin < fan_.bins; ++bin) {
            const double edge = std::max(fan_.inverse_edges[bin], far);
            if (!(edge < above)) continue;
            const double share_edge = spread.below(edge), middle = (above + edge) / 2;
            bins[bin] += amount * (share_above - share_edge) * middle * middle * middle;
            above = edge, share_above = share_edge;
        }
    }

    Fan& fan_;
    size_t number_;
    glm::dmat3 world_from_sonar_, sonar_from_world_;
    glm::dvec3 from_;
    int group_, stripe_, first_column_, end_column_;
};

}  // namespace

EmbreeTracer::EmbreeTracer(const types::Snapshot& scene) : fan_(std::make_unique<Fan>(scene)) {}

EmbreeTracer::~EmbreeTracer() = default;

void EmbreeTracer::prepare(const sonar::SonarConfig& config) {
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    Fan& fan = *fan_;
    fan.tree.updateLaws(config);
    fan.columns.clear();
    fan.rows.clear();
    fan.columns_per_beam = config.columnsPerBeam();
    for (const sonar::Beam& beam : sonar::makeBeams(config))
        for (int i = 0; i < fan.columns_per_beam; ++i) {
            const double width = (beam.high - beam.low) / fan.columns_per_beam;
            fan.columns.push_back(column(beam.low + i * width, beam.low + (i + 1) * width));
        }
    const double half = types::radians(config.beam_height_deg) / 2, height = 2 * half / config.rows();
    for (int i = 0; i < config.rows(); ++i) {
        Strip& added = fan.rows.emplace_back(row(i * height - half, (i + 1) * height - half));
        added.size *= computeReceived(config, (i + 0.5) * height - half);
    }
    fan.beams = config.beams();
    fan.stripes = fan.groups() >= 4 * fan.workers.size() ? 1 : 4 * fan.workers.size();
    fan.bins = static_cast<size_t>(grid.bin_count);
    fan.bin_width = grid.bin_width;
    fan.nearest = grid.range_min > 0 ? 1 / grid.range_min : 1e12;
    fan.farthest = 1 / grid.range_max;
    fan.inverse_edges.clear();
    for (int k = 0; k < grid.bin_count; ++k) fan.inverse_edges.push_back(1 / grid.edge(k + 1));
    fan.sums.assign(static_cast<size_t>(fan.stripes) * static_cast<size_t>(fan.beams) * fan.bins, 0);
    fan.longest.assign(static_cast<size_t>(fan.parts()), 0);
    fan.hits.assign(static_cast<size_t>(fan.parts()), 0);
}

void EmbreeTracer::render(const types::Pose& sonar, std::vector<float>& energies) {
    Fan& fan = *fan_;
    const auto work = [&](int number) {
        Part<Fan> part(fan, sonar, number);
        part.clear();
        part.trace([&](int column, int row, uint32_t triangle) { part.deposit(column, row, triangle); });
    };
    fan.workers.forEach(fan.parts(), work);
    const size_t all = fan.bins * static_cast<size_t>(fan.beams);
    energies.resize(all);
    for (size_t i = 0; i < all; ++i) {
        double sum = 0;
        for (size_t at = i; at < fan.sums.size(); at += all) sum += fan.sums[at];
        energies[i] = static_cast<float>(sum);
    }
    fan.kappa_max = fan.longest.empty() ? 0 : *std::ranges::max_element(fan.longest);
}

size_t EmbreeTracer::traceOnly(const types::Pose& sonar) {
    Fan& fan = *fan_;
    fan.workers.forEach(fan.parts(), [&](int number) {
        size_t hits = 0;
        Part<Fan>(fan, sonar, number).trace([&](int, int, uint32_t) { ++hits; });
        fan.hits[static_cast<size_t>(number)] = hits;
    });
    size_t sum = 0;
    for (const size_t hits : fan.hits) sum += hits;
    return sum;
}

double EmbreeTracer::kappaMax() const { return fan_->kappa_max; }

namespace {

constexpr int split = 4;  ///< Divisions of a tile along each side.
static_assert(split * split == RayTree::packet);
constexpr double infinite = std::numeric_limits<double>::infinity();
using Directions = std::array<glm::dvec3, RayTree::packet>;
using Distances = std::array<double, RayTree::packet>;

/** Returns the direction after reflection by the surface. */
glm::dvec3 mirrored(const glm::dvec3& direction) { return {direction.x, direction.y, -direction.z}; }

/** The rays of one beam. Directions are unit, in the axes of the world. */
class BeamRays {
public:
    BeamRays(const RayTree& tree, const types::Pose& sonar, const sonar::BinGrid& grid, double surface,
             const sonar::Beam& fan, double highest, double* bins)
        : tree_(tree),
          grid_(grid),
          world_from_sonar_(glm::mat3_cast(sonar.orientation)),
          from_(sonar.position - tree.origin()),
          image_{from_.x, from_.y, 2 * surface - from_.z},
          surface_(surface),
          fan_(fan),
          highest_(highest),
          bins_(bins) {}

    double rays() const { return rays_; }

    /** Traces rays in the sonar's axes that represent a solid angle each [sr]. */
    void trace(Directions directions, double solid_angle) {
        for (glm::dvec3& d : directions) d = world_from_sonar_ * d;
        solid_angle_ = solid_angle;
        Distances to_surface, none{};
        Directions below;
        for (size_t i = 0; i < directions.size(); ++i) {
            to_surface[i] = toSurface(directions[i]);
            below[i] = mirrored(directions[i]);
        }
        const auto direct = meet(from_, directions, none), reflected = meet(image_, below, to_surface);
        for (size_t i = 0; i < directions.size(); ++i) {
            const bool is_direct = computeRange(direct[i], from_, directions[i]) < to_surface[i];
            const glm::dvec3 &origin = is_direct ? from_ : image_, &d = is_direct ? directions[i] : below[i];
            const uint32_t hit = is_direct ? direct[i] : std::isfinite(to_surface[i]) ? reflected[i] : RayTree::none;
            points_[i] = {hit, origin, d, computeRange(hit, origin, d), is_direct};
        }
        receiveBothWays();
        receiveOtherWays();
    }

private:
    /** The first hit of a ray. */
    struct Point {
        uint32_t triangle;
        glm::dvec3 origin, direction;
        double range;
        bool is_direct;
        glm::dvec3 place() const { return origin + range * direction; }
        bool isMet() const { return triangle != RayTree::none && std::isfinite(range); }
    };

    double toSurface(const glm::dvec3& direction) const {
        return direction.z > 0 ? (surface_ - from_.z) / direction.z : infinite;
    }

    RayTree::Found meet(const glm::dvec3& from, const Directions& directions, const Distances& nearest) {
        RayTree::Rays rays;
        for (int i = 0; i < RayTree::packet; ++i) {
            const auto at = static_cast<size_t>(i);
            rays.set(i, directions[at], std::isfinite(nearest[at]) ? nearest[at] : 0);
        }
        RayTree::Found found;
        tree_.trace(from, {&rays, 1}, {&found, 1});
        rays_ += RayTree::packet;
        return found;
    }

    /** Returns the range of the triangle's plane; infinite for none [m]. */
    double computeRange(uint32_t triangle, const glm::dvec3& from, const glm::dvec3& direction) const {
        if (triangle == RayTree::none) return infinite;
        const RayTree::Triangle& plane = tree_[triangle];
        const double range = (plane.distance - glm::dot(plane.normal, from)) / glm::dot(plane.normal, direction);
        return range > 0 ? range : infinite;
    }

    void receiveBothWays() {
        for (const Point& point : points_) {
            if (!point.isMet()) continue;
            const RayTree::Triangle& plane = tree_[point.triangle];
            double cosine = std::abs(glm::dot(plane.normal, point.direction));
            if (point.is_direct && plane.mapped)
                cosine = tree_.mappedCosine(point.triangle, point.place(), point.direction);
            add(point.range,
                tree_.backscatter(point.triangle, cosine, point.direction, point.range) / (point.range * point.range));
        }
    }

    /** Adds sound whose way out differs from its way back. */
    void receiveOtherWays() {
        Directions out, out_of_sonar;
        Distances reach{}, none{}, to_surface{};
        for (size_t i = 0; i < points_.size(); ++i) {
            const Point& point = points_[i];
            const glm::dvec3 away = point.isMet() ? point.place() - other(point) : glm::dvec3(1, 0, 0);
            reach[i] = glm::length(away);
            out[i] = away / reach[i];
            out_of_sonar[i] = point.is_direct ? mirrored(out[i]) : out[i];
            to_surface[i] = point.is_direct ? toSurface(out_of_sonar[i]) : 0;
        }
        const auto first = meet(from_, out_of_sonar, none);
        RayTree::Found second{};
        Directions below;  // from the image of the sonar: for points that were hit directly
        for (size_t i = 0; i < points_.size(); ++i) below[i] = points_[i].is_direct ? out[i] : glm::dvec3(1, 0, 0);
        second = meet(image_, below, to_surface);
        for (size_t i = 0; i < points_.size(); ++i) {
            const Point& point = points_[i];
            if (!point.isMet() || !isSent(out_of_sonar[i])) continue;
            const bool is_free = point.is_direct ? std::isfinite(to_surface[i]) && second[i] == point.triangle &&
                                                       !(computeRange(first[i], from_, out_of_sonar[i]) < to_surface[i])
                                                 : first[i] == point.triangle;
            if (!is_free) continue;
            const glm::dvec3& normal = tree_[point.triangle].normal;
            const double back = glm::dot(normal, point.direction), there = glm::dot(normal, out[i]);
            if (!(back * there > 0)) continue;  // lit from behind
            const double range = (point.range + reach[i]) / 2;
            add(range, tree_.bistatic(point.triangle, std::abs(back), std::abs(there),
                                      glm::normalize(point.direction + out[i]), range) /
                           (reach[i] * reach[i]));
        }
    }

    const glm::dvec3& other(const Point& point) const { return point.is_direct ? image_ : from_; }

    bool isSent(const glm::dvec3& direction) const {
        const glm::dvec3 d = glm::transpose(world_from_sonar_) * direction;
        const double azimuth = std::atan2(d.y, d.x);
        return std::abs(d.z) <= highest_ && azimuth >= fan_.low && azimuth <= fan_.high;
    }

    void add(double range, double energy) {
        if (!(range >= grid_.range_min && range < grid_.range_max)) return;
        bins_[std::min(static_cast<int>(range / grid_.bin_width), grid_.bin_count - 1)] += solid_angle_ * energy;
    }

    const RayTree& tree_;
    const sonar::BinGrid& grid_;
    glm::dmat3 world_from_sonar_;
    glm::dvec3 from_, image_;
    double surface_;
    sonar::Beam fan_;  ///< From the first beam to the last.
    double highest_;   ///< Sine of elevation [1].
    double* bins_;
    double solid_angle_ = 0, rays_ = 0;
    std::array<Point, RayTree::packet> points_{};
};

/** Returns one ray in each of a tile's 16 parts, in the sonar's axes. */
Directions rasterisedIn(double azimuth, double width, double up, double height, uint64_t seed) {
    Directions directions;
    for (uint64_t i = 0; i < directions.size(); ++i) {
        const auto draw = [&](uint64_t which) { return types::unit(types::mixedBits(seed + 2 * i + which) >> 32); };
        const double a = azimuth + (static_cast<double>(i % split) + draw(0)) * width / split,
                     sine = up + (static_cast<double>(i / split) + draw(1)) * height / split;
        const double level = std::sqrt(1 - sine * sine);
        directions[i] = {level * std::cos(a), level * std::sin(a), sine};
    }
    return directions;
}

}  // namespace

PathTracer::PathTracer(const types::Snapshot& scene)
    : tree_(scene), surface_(scene.water_surface.value() - tree_.origin().z) {}

std::vector<double> PathTracer::render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                                       uint64_t seed) {
    tree_.updateLaws(config);
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const sonar::Fan beams = sonar::makeBeams(config);
    const double half = std::sin(types::radians(config.beam_height_deg) / 2);
    sonar::Beam fan = beams[0];
    for (const sonar::Beam& beam : beams)
        fan.low = std::min(fan.low, beam.low), fan.high = std::max(fan.high, beam.high);
    std::vector<double> energies(beams.size() * static_cast<size_t>(grid.bin_count)), rays(beams.size());
    workers_.forEach(static_cast<int>(beams.size()), [&](int number) {
        const auto which = static_cast<size_t>(number);
        BeamRays part(tree_, sonar, grid, surface_, fan, half,
                      energies.data() + which * static_cast<size_t>(grid.bin_count));
        const double width = (beams[which].high - beams[which].low) / across, height = 2 * half / up;
        for (int row = 0; row < up; ++row)
            for (int column = 0; column < across; ++column)
                part.trace(
                    rasterisedIn(
                        beams[which].low + column * width, width, row * height - half, height,
                        types::hashed(seed, which, static_cast<uint64_t>(row) << 32 | static_cast<uint32_t>(column))),
                    width * height / RayTree::packet);
        rays[which] = part.rays();
    });
    rays_ = 0;
    for (const double traced : rays) rays_ += traced;
    return energies;
}

}  // namespace insonify::study
