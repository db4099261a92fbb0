#include "components/sonar/multipath/DirectSound.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

#include "types/Angle.hpp"

namespace insonify::sonar {

DirectSound::DirectSound(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), receiver_(plan), shape_(echoShapeOf(plan)) {
    takeScene(geometry);
}

void DirectSound::takeScene(const types::Geometry& geometry) { ways_.emplace(plan_.config, geometry); }

double DirectSound::receivedBy(const Beam& beam, const BeamAngles& from, double range) const {
    const auto& pattern = plan_.directivity;
    const double off = std::remainder(from.azimuth - beam.centre, 2 * std::numbers::pi);
    const double across = pattern && pattern->hasAzimuth() && !pattern->hasBoxes()
                              ? pattern->receivedAzimuth(from.azimuth, beam.centre, pattern->zoneAt(range))
                              : off >= beam.low - beam.centre && off < beam.high - beam.centre;
    const double along = pattern && pattern->hasElevation()
                             ? pattern->receivedElevation(from.elevation)
                             : std::abs(from.elevation) <= types::radians(plan_.config.beam_height_deg) / 2;
    return across * along;
}

bool DirectSound::spread(double range, double length) {
    const BinGrid& grid = plan_.grid;
    const double reach = length > 0 ? length / 2 : shape_ ? shape_->reach() : 0;
    const double first = std::max(0.0, binAt(range - reach, grid.bin_width));
    const double last = std::min(grid.bin_count - 1.0, binAt(range + reach, grid.bin_width));
    shares_.clear();
    if (!(first <= last)) return false;
    first_bin_ = static_cast<size_t>(first);
    for (double k = first; k <= last; ++k) {
        const double low = k * grid.bin_width - range, high = low + grid.bin_width;
        if (length > 0)
            shares_.push_back(std::max(0.0, std::min(high, reach) - std::max(low, -reach)) / grid.bin_width);
        else
            shares_.push_back(shape_ ? shape_->mean(low, high) : 1);
    }
    return true;
}

bool DirectSound::addWay(const types::Transmission& sent, const Reception& received, const TargetWay& way,
                         types::Sonar& ping) {
    const double range = received.offset + way.length / 2;
    if (!(range >= plan_.grid.range_min) || !spread(range, received.length)) return false;
    const bool conical = plan_.features.has(Feature::Conical);
    if (conical && way.direction.x < 0) return false;
    const double power = sent.radiation->towards(glm::conjugate(sent.sonar.orientation) * way.from_point);
    const double intensity =
        received.level * power * way.power * std::exp(-received.loss * way.length) / (way.length * way.length);
    const BeamAngles from = beamAnglesOf(way.direction, conical);
    bool has_echo = false;
    for (size_t beam = 0; intensity > 0 && beam < plan_.beams.size(); ++beam) {
        const double gain = receivedBy(plan_.beams[beam], from, way.length);
        if (!(gain > 0)) continue;
        has_echo = true;
        float* bins = &ping.bins[beam * ping.bin_count + first_bin_];
        for (size_t i = 0; i < shares_.size(); ++i)
            bins[i] = static_cast<float>(
                std::min(double{bins[i]} + intensity * gain * shares_[i], double{std::numeric_limits<float>::max()}));
    }
    return has_echo;
}

size_t DirectSound::add(const types::Snapshot& snapshot, types::Sonar& ping) {
    // A path may be longer by the time that the pulse was sent before the ping.
    received_.clear();
    double earliest = 0;
    for (const auto& sent : snapshot.transmissions) {
        received_.push_back(receiver_.receptionOf(*sent, snapshot.time));
        earliest = std::max(earliest, -received_.back().offset);
    }
    ways_->place(snapshot, plan_.grid.range_max + earliest);
    size_t has_echo = 0;
    for (size_t i = 0; i < received_.size(); ++i) {
        const auto& sent = snapshot.transmissions[i];
        bool any = false;
        for (const TargetWay& way : ways_->waysTo(sent->sonar.position)) any |= addWay(*sent, received_[i], way, ping);
        has_echo += any ? 1 : 0;
    }
    return has_echo;
}

}  // namespace insonify::sonar
