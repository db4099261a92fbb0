#include "components/study/PointCaster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "types/Angle.hpp"
#include "types/Hash.hpp"

namespace insonify::study {
namespace {

constexpr int split = 4;       ///< Of a tile, along each side: 16 rays.
constexpr int partings = 2;    ///< Of a tile that shows more than one triangle.
constexpr int min_parts = 64;  ///< Of a ping, for threads to share.
/** Points along each side of a tile that shows one triangle: after all partings, after one, after none. */
constexpr int fill[partings + 1] = {8, 32, 128};
constexpr int mapped_fill[partings + 1] = {8, 16, 64};  ///< Where each has to look up a normal map.
static_assert(split * split == RayTree::packet);

/** Unit, in the sonar's axes. */
glm::dvec3 directionOf(double azimuth, double up) {
    const double level = std::sqrt(1 - up * up);
    return {level * std::cos(azimuth), level * std::sin(azimuth), up};
}
using Directions = std::array<glm::dvec3, RayTree::packet>;

/** A stretch of azimuth and of the sine of elevation: its solid angle is their product. */
struct Tile {
    double azimuth, width, up, height;
    double solidAngle() const { return width * height; }
    Tile part(int column, int row) const {
        return {azimuth + column * width / split, width / split, up + row * height / split, height / split};
    }
    /** In shares of the width and the height. */
    glm::dvec3 at(double across, double along) const {
        return directionOf(azimuth + across * width, up + along * height);
    }
};

/** Where a whole is parted into n, a little at random, so that no two seeds have the same tiles. */
double boundary(int k, int n, uint64_t seed) {
    const double moved =
        k == 0 || k == n ? 0 : (types::unit(types::mixedBits(seed + static_cast<uint64_t>(k)) >> 32) - 0.5) / 2;
    return (k + moved) / n;
}

/** The points of some tiles of one beam. */
class Part {
public:
    Part(const RayTree& tree, const types::Pose& sonar, const sonar::BinGrid& grid, double* bins)
        : tree_(tree),
          grid_(grid),
          world_from_sonar_(glm::mat3_cast(sonar.orientation)),
          from_(sonar.position - tree.origin()),
          bins_(bins) {}

    double rays() const { return rays_; }

    /** `seed` is the tile's own. */
    void cast(const Tile& tile, uint64_t seed) {
        seed_ = seed, drawn_ = 0;
        cast(tile, partings);
    }

private:
    double draw() { return types::unit(types::mixedBits(seed_ + ++drawn_) >> 32); }

    void cast(const Tile& tile, int partings_left) {
        Directions directions;
        for (int i = 0; i < RayTree::packet; ++i)  // an edge that cuts a corner off parts the corners
            directions[static_cast<size_t>(i)] = tile.at(i % split / (split - 1.0), i / split / (split - 1.0));
        const RayTree::Found seen = castRays(directions);
        if (std::ranges::count(seen, seen[0]) == RayTree::packet) {
            if (seen[0] != RayTree::none)
                fillWith(seen[0], tile, tree_[seen[0]].mapped ? mapped_fill[partings_left] : fill[partings_left]);
        } else if (partings_left > 0) {
            for (int i = 0; i < RayTree::packet; ++i) cast(tile.part(i % split, i / split), partings_left - 1);
        } else {
            hearRays(tile);
        }
    }

    /** One drawn in each part of the tile. */
    void hearRays(const Tile& tile) {
        Directions directions;
        for (int i = 0; i < RayTree::packet; ++i)
            directions[static_cast<size_t>(i)] = tile.part(i % split, i / split).at(draw(), draw());
        const RayTree::Found found = castRays(directions);
        for (size_t i = 0; i < found.size(); ++i)
            if (found[i] != RayTree::none) hear(found[i], directions[i], tile.solidAngle() / RayTree::packet);
    }

    RayTree::Found castRays(const Directions& directions) {
        RayTree::Rays rays;
        for (int i = 0; i < RayTree::packet; ++i) rays.set(i, world_from_sonar_ * directions[static_cast<size_t>(i)]);
        RayTree::Found found;
        tree_.cast(from_, {&rays, 1}, {&found, 1});
        rays_ += RayTree::packet;
        return found;
    }

    /** Points in columns, each moved up against the one before by the golden section, so that no two lie level. */
    void fillWith(uint32_t triangle, const Tile& tile, int count) {
        const double right = draw(), each = tile.solidAngle() / (count * count);
        double high = draw();
        for (int i = 0; i < count; ++i) {
            const double azimuth = tile.azimuth + (i + right) * tile.width / count;
            const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
            for (int j = 0; j < count; ++j) {
                const double up = tile.up + (j + high) * tile.height / count, level = std::sqrt(1 - up * up);
                hear(triangle, {level * cosine, level * sine, up}, each);
            }
            high += std::numbers::phi - 1;
            high -= std::floor(high);
        }
    }

    void hear(uint32_t number, const glm::dvec3& direction, double solid_angle) {
        const RayTree::Triangle& triangle = tree_[number];
        if (number != last_) aimAt(number);
        const double facing = glm::dot(normal_, direction), range = distance_ / facing;
        if (!(range >= grid_.range_min && range < grid_.range_max)) return;
        double cosine = std::abs(facing);
        if (triangle.mapped) {
            const glm::dvec3 ahead = world_from_sonar_ * direction;
            cosine = tree_.mappedCosine(number, from_ + range * ahead, ahead);
        }
        bins_[std::min(static_cast<int>(range / grid_.bin_width), grid_.bin_count - 1)] +=
            solid_angle * tree_.backscatter(number, cosine, world_from_sonar_ * direction, range) / (range * range);
    }

    void aimAt(uint32_t number) {
        const RayTree::Triangle& triangle = tree_[number];
        normal_ = glm::transpose(world_from_sonar_) * triangle.normal;
        distance_ = triangle.distance - glm::dot(triangle.normal, from_);
        last_ = number;
    }

    const RayTree& tree_;
    const sonar::BinGrid& grid_;
    glm::dmat3 world_from_sonar_;
    glm::dvec3 from_;
    double* bins_;
    double rays_ = 0;
    uint64_t seed_ = 0, drawn_ = 0;
    uint32_t last_ = RayTree::none;  ///< The triangle of which normal and distance are at hand.
    glm::dvec3 normal_{};            ///< Sonar axes.
    double distance_ = 0;            ///< Of the plane along it [m].
};

}  // namespace

std::vector<double> PointCaster::render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                                        uint64_t seed) {
    tree_.takeLaws(config);
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const sonar::Fan beams = sonar::makeBeams(config);
    const double half = std::sin(types::radians(config.beam_height_deg) / 2);
    const int parts = std::max(1, min_parts / static_cast<int>(beams.size()));  // of each beam
    const auto bins = static_cast<size_t>(grid.bin_count);
    std::vector<double> sums(beams.size() * static_cast<size_t>(parts) * bins), rays(sums.size() / bins);
    workers_.forEach(static_cast<int>(rays.size()), [&](int number) {
        const auto which = static_cast<uint64_t>(number / parts);
        const sonar::Beam& beam = beams[which];
        const auto azimuth = [&](int k) {
            return beam.low + (beam.high - beam.low) * boundary(k, across, types::hashed(seed, which, 0));
        };
        const auto sine = [&](int k) { return half * (2 * boundary(k, up, types::hashed(seed, which, 1)) - 1); };
        Part part(tree_, sonar, grid, sums.data() + static_cast<size_t>(number) * bins);
        for (int row = number % parts; row < up; row += parts)
            for (int column = 0; column < across; ++column)
                part.cast(
                    {azimuth(column), azimuth(column + 1) - azimuth(column), sine(row), sine(row + 1) - sine(row)},
                    types::hashed(seed, which, static_cast<uint64_t>(row + 1) << 32 | static_cast<uint32_t>(column)));
        rays[static_cast<size_t>(number)] = part.rays();
    });
    rays_ = 0;
    for (const double cast : rays) rays_ += cast;
    std::vector<double> energies(beams.size() * bins);
    for (size_t i = 0; i < sums.size(); ++i)
        energies[i / bins / static_cast<size_t>(parts) * bins + i % bins] += sums[i];
    return energies;
}

}  // namespace insonify::study
