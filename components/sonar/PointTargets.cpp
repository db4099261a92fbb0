#include "components/sonar/PointTargets.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/RangeResponse.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Steps of the table over the width of h [1]. */
constexpr double steps_per_width = 256;

}  // namespace

PulseMeans::PulseMeans(const acoustics::Pulse& pulse) : reach_(pulse.extent(RangeResponse::floor_db)) {
    if (!pulse.peakSidelobeDb()) {
        tone_ = pulse;
        return;
    }
    step_ = pulse.resolution() / steps_per_width;
    const auto steps = static_cast<size_t>(std::ceil(reach_ / step_)) + 1;
    integral_.push_back(0);
    for (size_t i = 0; i <= steps; ++i) {
        response_.push_back(pulse.response(static_cast<double>(i) * step_));
        if (i > 0) integral_.push_back(integral_.back() + step_ * (response_[i - 1] + response_[i]) / 2);
    }
}

double PulseMeans::integralTo(double distance) const {
    const double at = std::min(std::abs(distance), reach_) / step_;
    const auto i = static_cast<size_t>(at);
    const double rest = at - static_cast<double>(i), slope = response_[i + 1] - response_[i];
    return std::copysign(integral_[i] + step_ * rest * (response_[i] + rest * slope / 2), distance);
}

double PulseMeans::mean(double low, double high) const {
    if (tone_) return tone_->mean(low, high);
    return (integralTo(high) - integralTo(low)) / (high - low);
}

PointTargets::PointTargets(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), sightlines_(geometry), absorption_(makeAbsorption(plan.config).intensityPerMetre()) {
    if (plan.has(Pass::Pulse)) pulse_.emplace(acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound));
    means_.reserve(static_cast<size_t>(plan.grid.bin_count));
}

std::optional<PointTargets::Place> PointTargets::placeOf(const types::Pose& sonar, const glm::dvec3& position) const {
    const glm::dvec3 at = glm::conjugate(sonar.orientation) * (position - sonar.position);
    const double range = glm::length(at);
    const bool conical = plan_.features.has(Feature::Conical);
    const bool silent = !(range >= plan_.grid.range_min && range > 0) || (conical && at.x < 0);
    if (silent) return {};
    const double azimuth = conical ? std::asin(std::clamp(at.y / range, -1.0, 1.0)) : std::atan2(at.y, at.x);
    return Place{range, azimuth, std::asin(std::clamp(at.z / range, -1.0, 1.0))};
}

double PointTargets::powerIn(const Beam& beam, const Place& place) const {
    const auto& pattern = plan_.directivity;
    const double half_height = types::radians(plan_.config.beam_height_deg) / 2;
    const double off = std::remainder(place.azimuth - beam.centre, 2 * std::numbers::pi);
    const bool in_box = off >= beam.low - beam.centre && off < beam.high - beam.centre;
    const double across = pattern && pattern->hasAzimuth() ? pattern->azimuth(place.azimuth, beam.centre) : in_box;
    const double along = pattern && pattern->hasElevation() ? pattern->elevation(place.elevation)
                                                            : std::abs(place.elevation) <= half_height;
    return pattern && across * along < pattern->floor() ? 0 : across * along;
}

bool PointTargets::spread(double range) {
    const BinGrid& grid = plan_.grid;
    const double reach = pulse_ ? pulse_->reach() : 0;
    const double first = std::max(0.0, std::floor((range - reach) / grid.bin_width));
    const double last = std::min(grid.bin_count - 1.0, std::floor((range + reach) / grid.bin_width));
    means_.clear();
    first_bin_ = static_cast<size_t>(first);
    for (double k = first; k <= last; ++k)
        means_.push_back(pulse_ ? pulse_->mean(k * grid.bin_width - range, (k + 1) * grid.bin_width - range) : 1);
    return !means_.empty();
}

bool PointTargets::addTo(types::Sonar& ping, const Place& place, double intensity) const {
    bool heard = false;
    for (size_t beam = 0; beam < plan_.beams.size(); ++beam) {
        const double power = powerIn(plan_.beams[beam], place);
        if (!(power > 0)) continue;
        float* bins = &ping.bins[beam * ping.bin_count + first_bin_];
        for (size_t i = 0; i < means_.size(); ++i) bins[i] += static_cast<float>(intensity * power * means_[i]);
        heard = true;
    }
    return heard;
}

size_t PointTargets::add(const types::Snapshot& snapshot, types::Sonar& ping) {
    sightlines_.place(snapshot);
    size_t heard = 0;
    for (const types::PointTarget& target : snapshot.targets) {
        const auto place = placeOf(snapshot.sonar, target.position);
        if (!place || !spread(place->range) || !sightlines_.isOpen(target.position)) continue;
        const double r = place->range;
        const double intensity = std::pow(10, target.strength_db / 10) * std::exp(-absorption_ * r) / (r * r * r * r);
        heard += addTo(ping, *place, intensity) ? 1 : 0;
    }
    return heard;
}

}  // namespace insonify::sonar
