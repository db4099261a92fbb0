#include "components/sonar/multipath/ForeignEchoes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "components/sonar/multipath/OtherSonars.hpp"
#include "components/sonar/multipath/PathCells.hpp"
#include "components/sonar/multipath/PathPatterns.hpp"
#include "components/sonar/rays/SurfaceMapping.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

constexpr double nearest_bin = 1e-3;  ///< Min slant range that is summed [m].

/** A transmission in one ping. */
struct PlacedSender {
    const types::Transmission* sent;
    Reception received;
    glm::dvec3 place;              ///< Sonar axes [m].
    glm::dquat sender_from_sonar;  ///< Rotation of directions.
    size_t sums;                   ///< Index of its sums among those of all lengths [1].
};

class EchoesOfOthers final : public ForeignEchoes {
public:
    explicit EchoesOfOthers(const RenderPlan& plan) : plan_(plan), receiver_(plan) { updateQuality(); }

    void updateQuality() override {
        patterns_.emplace(plan_);
        bin_count_ = static_cast<size_t>(plan_.summed.bin_count);
    }
    void begin(const types::Snapshot& snapshot) override;
    void follow(const TracedPing& ping, std::span<const TracedTile> tiles) override;
    bool addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) override;

private:
    /** Returns the rays of one tile, as bits, whose ends the sender sees. */
    uint32_t openTo(const PlacedSender& sender, const TracedPing& ping, const TracedTile& tile) const;
    void deposit(const PlacedSender& sender, const TracedPing& ping, const TracedTile& tile, int sample);
    LobeSlopes slopes(const TracedPing& ping, const TracedTile& tile, int sample, const CellAngles& at,
                      const MirrorPlane& plane, const HalfPath& path) const;
    /** Returns the index of the sums of pulses that become boxes of a length [m]; clears new sums. */
    size_t computeSums(double length);

    const RenderPlan& plan_;
    Receiver receiver_;
    std::optional<PathPatterns> patterns_;
    size_t bin_count_ = 0;  ///< Sums of a cell [1].
    std::vector<PlacedSender> senders_;
    std::vector<double> lengths_;              ///< Lengths of the boxes that pulses become [m].
    std::vector<std::vector<uint64_t>> sums_;  ///< One for each length: [cell][bin], in quanta.
};

size_t EchoesOfOthers::computeSums(double length) {
    const auto known = std::ranges::find(lengths_, length);
    const auto place = static_cast<size_t>(known - lengths_.begin());
    if (known != lengths_.end()) return place;
    lengths_.push_back(length);
    if (sums_.size() < lengths_.size()) sums_.emplace_back();
    sums_[place].assign(plan_.cells.size() * bin_count_, 0);
    return place;
}

void EchoesOfOthers::begin(const types::Snapshot& snapshot) {
    senders_.clear();
    lengths_.clear();
    const glm::dquat sonar_from_world = glm::conjugate(snapshot.sonar.orientation);
    for (const auto& sent : snapshot.transmissions) {
        const Reception received = receiver_.reception(*sent, snapshot.time);
        // The shortest path is half of the straight one; pulses sent too late for it are not received.
        const glm::dvec3 place = sonar_from_world * (sent->sonar.position - snapshot.sonar.position);
        if (received.offset + glm::length(place) / 2 >= plan_.grid.range_max) continue;
        senders_.push_back({sent.get(), received, place,
                            glm::conjugate(sent->sonar.orientation) * snapshot.sonar.orientation,
                            computeSums(received.length)});
    }
}

void EchoesOfOthers::follow(const TracedPing& ping, std::span<const TracedTile> tiles) {
    thread_local MappedTiles mapped;
    if (ping.scene.maps) {
        mapped.take(ping.view, ping.scene, tiles, true);
        tiles = mapped.whole();
    }
    for (const PlacedSender& sender : senders_)
        for (const TracedTile& tile : tiles) {
            const uint32_t open = openTo(sender, ping, tile);
            for (int i = 0; i < tile_samples; ++i)
                if (open >> i & 1) deposit(sender, ping, tile, i);
        }
}

uint32_t EchoesOfOthers::openTo(const PlacedSender& sender, const TracedPing& ping, const TracedTile& tile) const {
    PathRays rays{};
    rays.towards.active = 0;
    for (int i = 0; i < tile_samples; ++i) {
        rays.nearest[i] = 1, rays.farthest[i] = 0;
        if (tile.hits->command[i] == TileHits::nothing) continue;
        const int column = tile.first_column + ping.view.shape.at[i].columns,
                  row = tile.first_row + ping.view.shape.at[i].rows;
        if (column >= tile.end_column || row >= ping.view.cells.rows) continue;
        const glm::dvec3 direction = ping.view.cells.direction(column, row),
                         at = double{tile.hits->distance[i]} * direction, on = sender.place - at;
        const double length = glm::length(on);
        const MirrorPlane plane = planeMet(ping.scene, *tile.hits, i);
        // The sender and the sonar are on one side of the surface.
        if (!(glm::dot(plane.normal, direction) * glm::dot(plane.normal, on) < 0)) continue;
        if (!(length > RayVisibility::nearest)) continue;
        const double half = sender.received.offset + 0.5 * (glm::length(at) + length);
        if (!(half > nearest_bin && half < reaching_back * plan_.grid.range_max)) continue;
        rays.from_x[i] = static_cast<float>(at.x), rays.from_y[i] = static_cast<float>(at.y);
        rays.from_z[i] = static_cast<float>(at.z);
        rays.towards.x[i] = static_cast<float>(on.x), rays.towards.y[i] = static_cast<float>(on.y);
        rays.towards.z[i] = static_cast<float>(on.z);
        rays.nearest[i] = static_cast<float>(RayVisibility::nearest / length + 1e-6);
        rays.farthest[i] = static_cast<float>(1 - RayVisibility::nearest / length);
        rays.towards.active |= 1u << i;
    }
    return rays.towards.active ? rays.towards.active & ~ping.visibility.blocked(rays) : 0;
}

LobeSlopes EchoesOfOthers::slopes(const TracedPing& ping, const TracedTile& tile, int sample, const CellAngles& at,
                                  const MirrorPlane& plane, const HalfPath& path) const {
    const PlacedRun& run = ping.scene.ranges[tile.hits->command[sample]];
    if (!run.facets || !ping.rules.laws.hasLobe(run.material)) return {};
    LobeSample seen{};
    seen.facet = run.facets[tile.hits->triangle[sample]];
    seen.normal = plane.normal;
    seen.axis = turned(run, seen.facet.axis);
    seen.range = 1 / path.inverse;
    seen.lookAlong(glm::normalize(at.middle + path.from_focus));
    seen.width = at.width;
    seen.height = at.height;
    return ping.rules.laws.lobeSlopes(run.material, seen);
}

void EchoesOfOthers::deposit(const PlacedSender& sender, const TracedPing& ping, const TracedTile& tile, int sample) {
    const CellAngles at(ping.view, tile, sample, 1);
    const MirrorPlane plane = planeMet(ping.scene, *tile.hits, sample);
    const double facing = std::abs(glm::dot(plane.normal, at.middle));
    if (!(facing > edge_on && plane.distance * glm::dot(plane.normal, at.middle) > 0)) return;
    HalfPath path = computeHalfPath(plane, sender.place, at);
    const double lit = std::abs(glm::dot(plane.normal, path.from_focus));
    const double half = 1 / path.inverse, range = half + sender.received.offset;
    if (!(lit > edge_on && range > nearest_bin)) return;
    const PlacedRun& run = ping.scene.ranges[tile.hits->command[sample]];
    const MaterialLaws::Bistatic given = ping.rules.laws.bistatic(
        run.material, lit, facing, std::abs(glm::dot(plane.normal, glm::normalize(at.middle + path.from_focus))),
        slopes(ping, tile, sample, at, plane, path));
    const double power = sender.sent->radiation->towards(glm::normalize(sender.sender_from_sonar * path.from_focus)) *
                         patterns_->received(patterns_->toDirection(at.middle)) * sender.received.level;
    if (!(power > 0)) return;
    // The cell's own echo is at `half`; the delay of the pulse shifts it, and its extent stays.
    const double stretch = half / range * (half / range), nearest = 1 / path.nearest + sender.received.offset;
    const Footprint cell = trapezoidFootprint(
        1 / range, 1 / range, std::abs(path.per_azimuth) * stretch * at.width,
        std::abs(path.per_elevation + path.per_azimuth * at.lean) * stretch * at.height,
        nearest > nearest_bin ? 1 / nearest : 1 / nearest_bin, 1 / nearest_bin, 0, ping.rules.edges.front(),
        ping.rules.edges[static_cast<size_t>(ping.rules.bins.bin_count)], at.size);
    const double absorbed = std::exp(2 * sender.received.loss * (range - half)) * tile.meanGain(sample, 1);
    SharedBins(ping.rules, sums_[sender.sums].data())
        .depositCell(cell, static_cast<uint>(at.cell),
                     ping.rules.strength_scale * power * (given.diffuse + given.lobe) * absorbed * range * range *
                         range / (path.back * path.back));
}

bool EchoesOfOthers::addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) {
    INSONIFY_CHECK(bins.size() == bin_count_ && cell < plan_.cells.size(), bins.size(), bin_count_, cell);
    const double quantum = computeQuantum(ping);
    bool any = false;
    thread_local std::vector<double> facing;  // cumulated up to each bin
    facing.resize(bins.size());
    for (size_t group = 0; group < lengths_.size(); ++group) {
        const uint64_t* sums = sums_[group].data() + cell * bins.size();
        // A box of the pulse's length about each echo: the difference of two cumulated sums.
        const auto reach = static_cast<std::ptrdiff_t>(std::llround(lengths_[group] / 2 / ping.rules.bins.bin_width));
        double before = 0;
        for (size_t j = 0; j < bins.size(); ++j)
            facing[j] = before += double{ping.levels.intensity(j, static_cast<double>(sums[j]) * quantum)};
        if (!(before > 0)) continue;
        any = true;
        const auto bins_in_box = static_cast<double>(2 * reach + 1);
        // The pulse's own response is applied after these sums and weights a box by its cell.
        const double intensity = lengths_[group] > 0 ? lengths_[group] / (receiver_.summedCell() * bins_in_box) : 1;
        for (std::ptrdiff_t j = 0; j < std::ssize(bins); ++j) {
            const std::ptrdiff_t low = j - reach - 1, high = std::min(j + reach, std::ssize(bins) - 1);
            const double sum = facing[static_cast<size_t>(high)] - (low >= 0 ? facing[static_cast<size_t>(low)] : 0);
            float& bin = bins[static_cast<size_t>(j)];
            bin =
                static_cast<float>(std::min(double{bin} + intensity * sum, double{std::numeric_limits<float>::max()}));
        }
    }
    return any;
}

}  // namespace

std::unique_ptr<ForeignEchoes> makeForeignEchoes(const RenderPlan& plan) {
    return std::make_unique<EchoesOfOthers>(plan);
}

}  // namespace insonify::sonar
