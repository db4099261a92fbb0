#include "components/study/oracles/PathTracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
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
            const bool is_direct = rangeOf(direct[i], from_, directions[i]) < to_surface[i];
            const glm::dvec3 &origin = is_direct ? from_ : image_, &d = is_direct ? directions[i] : below[i];
            const uint32_t met = is_direct ? direct[i] : std::isfinite(to_surface[i]) ? reflected[i] : RayTree::none;
            points_[i] = {met, origin, d, rangeOf(met, origin, d), is_direct};
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
    double rangeOf(uint32_t triangle, const glm::dvec3& from, const glm::dvec3& direction) const {
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
                                                       !(rangeOf(first[i], from_, out_of_sonar[i]) < to_surface[i])
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
