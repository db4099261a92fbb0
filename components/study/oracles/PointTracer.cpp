#include "components/study/oracles/PointTracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <stdexcept>

#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Pulse.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

constexpr int split = 4;       ///< Divisions of a tile along each side: 16 rays.
constexpr int partings = 2;    ///< Max divisions of a tile that shows more than one triangle.
constexpr int min_parts = 64;  ///< Parts of a ping, shared by threads.
/** Points along each side of a tile that shows one triangle: after all divisions, after one, after none. */
constexpr int fill[partings + 1] = {8, 32, 128};
constexpr int mapped_fill[partings + 1] = {8, 16, 64};  ///< The same if each point looks up a normal map.
static_assert(split * split == RayTree::packet);

/** Returns a unit direction in the sonar's axes. */
glm::dvec3 computeDirection(double azimuth, double up) {
    const double level = std::sqrt(1 - up * up);
    return {level * std::cos(azimuth), level * std::sin(azimuth), up};
}
using Directions = std::array<glm::dvec3, RayTree::packet>;

/** An interval of azimuth and of the sine of elevation: its solid angle is their product. */
struct Tile {
    double azimuth, width, up, height;
    double solidAngle() const { return width * height; }
    Tile part(int column, int row) const {
        return {azimuth + column * width / split, width / split, up + row * height / split, height / split};
    }
    /** Returns the direction at fractions of the width and the height. */
    glm::dvec3 at(double across, double along) const {
        return computeDirection(azimuth + across * width, up + along * height);
    }
};

/** Returns a slightly randomised boundary of a division into n, so that no two seeds have the same tiles. */
double boundary(int k, int n, uint64_t seed) {
    const double moved =
        k == 0 || k == n ? 0 : (types::unit(types::mixedBits(seed + static_cast<uint64_t>(k)) >> 32) - 0.5) / 2;
    return (k + moved) / n;
}

double computePower(const std::optional<acoustics::BeamLaw>& law, double angle) {
    return law ? acoustics::BeamPattern(*law).power(angle) : 1;
}

/** Two-way weight of an elevation by a pattern, from the elevation's sine. */
class Aperture {
public:
    explicit Aperture(const sonar::SonarConfig& config) : half_(std::sin(types::radians(config.beam_height_deg) / 2)) {
        if (!config.beam_pattern || !config.beam_pattern->hasElevation()) return;
        const sonar::BeamPatternConfig& pattern = *config.beam_pattern;
        std::vector<double> all;
        for (int i = 0; i <= steps; ++i) {
            const double angle = std::asin(2.0 * i / steps - 1);
            all.push_back(computePower(pattern.transmit.elevation, angle) *
                          computePower(pattern.receive.elevation, angle));
        }
        const double floor = std::pow(10, pattern.floor_db / 10);
        const auto received = std::ranges::find_if(all, [&](double power) { return power >= floor; }) - all.begin();
        half_ = 1 - 2.0 * static_cast<double>(received) / steps;
        weights_ = std::move(all);
    }
    double half() const { return half_; }  ///< Sine of the max elevation received [1].
    double weight(double up) const {
        if (weights_.empty()) return 1;
        const double place = std::clamp((up + 1) / 2, 0.0, 1.0) * steps;
        const auto i = std::min(static_cast<size_t>(place), weights_.size() - 2);
        const double beyond = place - static_cast<double>(i);
        return (1 - beyond) * weights_[i] + beyond * weights_[i + 1];
    }

private:
    static constexpr int steps = 1 << 16;
    double half_;
    std::vector<double> weights_;
};

/** Sums of a strip's points: echoes in each bin, and the solid angle that ends in it. */
struct Sums {
    std::vector<double> echoes, ended, partial;  ///< `partial`: solid angle that ends in a bin, times 1/edge - 1/range.
};

/** The points of some tiles of one strip. */
class Part {
public:
    Part(const RayTree& tree, const types::Pose& sonar, const sonar::BinGrid& grid, const Aperture& aperture,
         Sums& sums)
        : tree_(tree),
          grid_(grid),
          aperture_(aperture),
          world_from_sonar_(glm::mat3_cast(sonar.orientation)),
          from_(sonar.position - tree.origin()),
          sums_(sums) {}

    double rays() const { return rays_; }

    /** Samples a tile; each tile has its own `seed`. */
    void trace(const Tile& tile, uint64_t seed) {
        seed_ = seed, drawn_ = 0;
        trace(tile, partings);
    }

private:
    double draw() { return types::unit(types::mixedBits(seed_ + ++drawn_) >> 32); }

    void trace(const Tile& tile, int partings_left) {
        Directions directions;
        for (int i = 0; i < RayTree::packet; ++i)  // an edge that cuts off a corner separates the corner rays
            directions[static_cast<size_t>(i)] = tile.at(i % split / (split - 1.0), i / split / (split - 1.0));
        const RayTree::Found seen = traceRays(directions);
        if (std::ranges::count(seen, seen[0]) == RayTree::packet) {
            const bool mapped = seen[0] != RayTree::none && tree_[seen[0]].mapped;
            fillWith(seen[0], tile, mapped ? mapped_fill[partings_left] : fill[partings_left]);
        } else if (partings_left > 0) {
            for (int i = 0; i < RayTree::packet; ++i) trace(tile.part(i % split, i / split), partings_left - 1);
        } else {
            receiveRays(tile);
        }
    }

    /** Traces one random ray in each part of the tile. */
    void receiveRays(const Tile& tile) {
        Directions directions;
        for (int i = 0; i < RayTree::packet; ++i)
            directions[static_cast<size_t>(i)] = tile.part(i % split, i / split).at(draw(), draw());
        const RayTree::Found found = traceRays(directions);
        for (size_t i = 0; i < found.size(); ++i) addEcho(found[i], directions[i], tile.solidAngle() / RayTree::packet);
    }

    RayTree::Found traceRays(const Directions& directions) {
        RayTree::Rays rays;
        for (int i = 0; i < RayTree::packet; ++i) rays.set(i, world_from_sonar_ * directions[static_cast<size_t>(i)]);
        RayTree::Found found;
        tree_.trace(from_, {&rays, 1}, {&found, 1});
        rays_ += RayTree::packet;
        return found;
    }

    /** Fills a tile with points in columns. Each column is shifted against the previous by the golden section, so that
     *  no two points have the same height. */
    void fillWith(uint32_t triangle, const Tile& tile, int count) {
        if (triangle == RayTree::none && sums_.ended.empty()) return;
        const double right = draw(), each = tile.solidAngle() / (count * count);
        double high = draw();
        rays_ += count * count;
        for (int i = 0; i < count; ++i) {
            const double azimuth = tile.azimuth + (i + right) * tile.width / count;
            const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
            for (int j = 0; j < count; ++j) {
                const double up = tile.up + (j + high) * tile.height / count, level = std::sqrt(1 - up * up);
                addEcho(triangle, {level * cosine, level * sine, up}, each);
            }
            high += std::numbers::phi - 1;
            high -= std::floor(high);
        }
    }

    void addEcho(uint32_t number, const glm::dvec3& direction, double solid_angle) {
        solid_angle *= aperture_.weight(direction.z);
        if (number == RayTree::none) return endAt(grid_.range_max, solid_angle);
        const RayTree::Triangle& triangle = tree_[number];
        if (number != last_) startPart(number);
        const double facing = glm::dot(normal_, direction), range = distance_ / facing;
        endAt(range, solid_angle);
        if (!(range >= grid_.range_min && range < grid_.range_max)) return;
        double cosine = std::abs(facing);
        if (triangle.mapped) {
            const glm::dvec3 ahead = world_from_sonar_ * direction;
            cosine = tree_.mappedCosine(number, from_ + range * ahead, ahead);
        }
        sums_.echoes[findBin(range)] +=
            solid_angle * tree_.backscatter(number, cosine, world_from_sonar_ * direction, range) / (range * range);
    }

    size_t findBin(double range) const {
        return static_cast<size_t>(std::min(static_cast<int>(range / grid_.bin_width), grid_.bin_count - 1));
    }

    /** Adds water up to a range. */
    void endAt(double range, double solid_angle) {
        if (sums_.ended.empty() || !(range > grid_.range_min)) return;
        const double end = std::min(range, grid_.range_max);
        const size_t bin = findBin(end);
        sums_.ended[bin] += solid_angle;
        sums_.partial[bin] +=
            solid_angle * (1 / std::max(grid_.edge(static_cast<int>(bin)), grid_.range_min) - 1 / end);
    }

    void startPart(uint32_t number) {
        const RayTree::Triangle& triangle = tree_[number];
        normal_ = glm::transpose(world_from_sonar_) * triangle.normal;
        distance_ = triangle.distance - glm::dot(triangle.normal, from_);
        last_ = number;
    }

    const RayTree& tree_;
    const sonar::BinGrid& grid_;
    const Aperture& aperture_;
    glm::dmat3 world_from_sonar_;
    glm::dvec3 from_;
    Sums& sums_;
    double rays_ = 0;
    uint64_t seed_ = 0, drawn_ = 0;
    uint32_t last_ = RayTree::none;  ///< The triangle of normal_ and distance_.
    glm::dvec3 normal_{};            ///< Sonar axes.
    double distance_ = 0;            ///< Distance of the plane along the normal [m].
};

/** An interval of azimuth [rad]. */
struct Strip {
    double low, high;
};

/** Returns the beams; with a pattern in azimuth eight strips per beam, or per its width if that is less, all around. */
std::vector<Strip> makeStrips(const sonar::SonarConfig& config) {
    std::vector<Strip> strips;
    if (!config.beam_pattern || !config.beam_pattern->hasAzimuth()) {
        for (const sonar::Beam& beam : sonar::makeBeams(config)) strips.push_back({beam.low, beam.high});
        return strips;
    }
    const auto& law = config.beam_pattern->receive.azimuth;
    const double beam = types::radians(config.beamWidthDeg());
    const double width = law && law->width_deg ? std::min(beam, types::radians(*law->width_deg)) : beam;
    const int count = static_cast<int>(std::ceil(2 * std::numbers::pi / (width / 8)));
    for (int i = 0; i < count; ++i)
        strips.push_back({std::numbers::pi * (2.0 * i / count - 1), std::numbers::pi * (2.0 * (i + 1) / count - 1)});
    return strips;
}

/** Returns the strips' weights in each beam; strips without weight are not traced. */
std::vector<std::vector<double>> getWeights(const sonar::SonarConfig& config, const std::vector<Strip>& strips) {
    const sonar::BeamPatternConfig& pattern = *config.beam_pattern;
    const auto law = [](const std::optional<acoustics::BeamLaw>& of) {
        return of ? std::optional<acoustics::BeamPattern>(*of) : std::nullopt;
    };
    const auto sent = law(pattern.transmit.azimuth), received = law(pattern.receive.azimuth);
    std::vector<std::vector<double>> weights;
    for (const sonar::Beam& beam : sonar::makeBeams(config)) {
        const double axis = (beam.low + beam.high) / 2;
        const auto shareInBox = [&](const Strip& strip) {
            const double off = std::remainder((strip.low + strip.high) / 2 - axis, 2 * std::numbers::pi),
                         half = (strip.high - strip.low) / 2, box = (beam.high - beam.low) / 2;
            return std::max(0.0, std::min(off + half, box) - std::max(off - half, -box)) / (2 * half);
        };
        std::vector<double>& each = weights.emplace_back();
        for (const Strip& strip : strips) {
            constexpr double gauss = 0.7745966692414834;  // three points of Gauss and Legendre
            const auto power = [&](double share) {
                const double a = (strip.low + strip.high + share * (strip.high - strip.low)) / 2;
                return (sent ? sent->power(a) : 1) * (received ? received->power(a - axis) : 1);
            };
            each.push_back((received ? 1 : shareInBox(strip)) * (5 * power(-gauss) + 8 * power(0) + 5 * power(gauss)) /
                           18);
        }
    }
    return weights;
}

/** Adds echoes of the water of a strip [bin]. */
void addWater(Sums& sums, const sonar::BinGrid& grid, double strength) {
    double beyond = 0;
    for (int k = grid.bin_count - 1; k >= 0; --k) {
        const auto bin = static_cast<size_t>(k);
        const double near = std::max(grid.edge(k), grid.range_min), whole = 1 / near - 1 / grid.edge(k + 1);
        sums.echoes[bin] += strength * (sums.partial[bin] + (whole > 0 ? beyond * whole : 0));
        beyond += sums.ended[bin];
    }
}

/** Spreads each bin by the pulse. */
void applyPulse(std::vector<double>& energies, const sonar::BinGrid& grid, const acoustics::PulseConfig& config) {
    const acoustics::Pulse pulse(config, grid.speed_of_sound);
    std::vector<double> response;
    for (int m = 0; m < grid.bin_count; ++m)
        response.push_back(pulse.mean((m - 0.5) * grid.bin_width, (m + 0.5) * grid.bin_width));
    const auto bins = static_cast<size_t>(grid.bin_count);
    for (size_t first = 0; first < energies.size(); first += bins) {
        const std::vector<double> beam(energies.begin() + static_cast<std::ptrdiff_t>(first),
                                       energies.begin() + static_cast<std::ptrdiff_t>(first + bins));
        for (size_t j = 0; j < bins; ++j) {
            double sum = 0;
            for (size_t i = 0; i < bins; ++i) sum += response[i < j ? j - i : i - j] * beam[i];
            energies[first + j] = sum;
        }
    }
}

}  // namespace

std::vector<double> PointTracer::render(const types::Pose& sonar, const sonar::SonarConfig& config, int up, int across,
                                        uint64_t seed) {
    if (config.hasLayers()) throw std::invalid_argument("points support only homogeneous water, no layers");
    tree_.updateLaws(config);
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const std::vector<Strip> strips = makeStrips(config);
    const bool formed = config.beam_pattern && config.beam_pattern->hasAzimuth();
    const auto weights = formed ? getWeights(config, strips) : std::vector<std::vector<double>>{};
    const auto isReceived = [&](size_t strip) {
        return !formed || std::ranges::any_of(weights, [&](const auto& beam) { return beam[strip] > 0; });
    };
    const Aperture aperture(config);
    const auto count = static_cast<int>(strips.size());
    const int parts = std::max(1, min_parts / count);  // of each strip
    if (formed) across = std::max(1, across * config.beams() / count);
    const auto bins = static_cast<size_t>(grid.bin_count), water = config.volume.empty() ? 0 : bins;
    std::vector<Sums> sums(strips.size() * static_cast<size_t>(parts));
    std::vector<double> rays(sums.size());
    workers_.forEach(static_cast<int>(sums.size()), [&](int number) {
        const auto which = static_cast<size_t>(number / parts);
        const Strip& strip = strips[which];
        const auto azimuth = [&](int k) {
            return strip.low + (strip.high - strip.low) * boundary(k, across, types::hashed(seed, which, 0));
        };
        const auto sine = [&](int k) {
            return aperture.half() * (2 * boundary(k, up, types::hashed(seed, which, 1)) - 1);
        };
        Sums& own = sums[static_cast<size_t>(number)];
        own = {std::vector<double>(bins), std::vector<double>(water), std::vector<double>(water)};
        if (!isReceived(which)) return;
        Part part(tree_, sonar, grid, aperture, own);
        for (int row = number % parts; row < up; row += parts)
            for (int column = 0; column < across; ++column)
                part.trace(
                    {azimuth(column), azimuth(column + 1) - azimuth(column), sine(row), sine(row + 1) - sine(row)},
                    types::hashed(seed, which, static_cast<uint64_t>(row + 1) << 32 | static_cast<uint32_t>(column)));
        if (water > 0) addWater(own, grid, std::pow(10, *config.volume.front().strength_db / 10));
        rays[static_cast<size_t>(number)] = part.rays();
    });
    rays_ = 0;
    for (const double traced : rays) rays_ += traced;
    std::vector<double> energies(static_cast<size_t>(config.beams()) * bins);
    workers_.forEach(config.beams(), [&](int number) {
        const auto beam = static_cast<size_t>(number);
        for (size_t i = 0; i < sums.size(); ++i) {
            const size_t strip = i / static_cast<size_t>(parts);
            const double weight = formed ? weights[beam][strip] : strip == beam ? 1 : 0;
            if (weight > 0)
                for (size_t bin = 0; bin < bins; ++bin) energies[beam * bins + bin] += weight * sums[i].echoes[bin];
        }
    });
    if (config.pulse) applyPulse(energies, grid, *config.pulse);
    return energies;
}

}  // namespace insonify::study
