#include "components/sonar/rays/RayTable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Vertical rays are not bent; steeper rays are replaced by this one [rad]. */
constexpr double steepest_ray = types::radians(89.99);
constexpr double widest_step = 0.001;  ///< Max angle between rays [rad].

/** Returns the spacing of corners at which an arc of max curvature deviates from its chord by at most a tenth of a bin
 *  [m]; at most `max_corners` of them. */
double cornerSpacing(const acoustics::SoundProfile& profile, const BinGrid& grid) {
    const double radius = profile.slowest() / std::max(profile.steepest(), 1e-9);
    return std::max(std::sqrt(8 * 0.1 * grid.bin_width * radius),
                    RayTable::beyond * grid.range_max / RayTable::max_corners);
}

}  // namespace

RayTable::RayTable(const acoustics::SoundProfile& profile, const BinGrid& grid)
    : profile_(profile), nominal_(grid.speed_of_sound) {
    const double farthest = beyond * grid.range_max;
    const double steps = std::max(1.0, std::ceil(farthest / cornerSpacing(profile, grid)));
    range_step_ = farthest / steps;
    for (double k = 0; k <= steps; ++k) {
        ranges_.push_back(k * range_step_);
        times_.push_back(ranges_.back() / nominal_);
    }
    // Between two rays at this angle, a straight line deviates from the arc by a fiftieth of a bin.
    const double wanted = std::min(widest_step, std::sqrt(8 * 0.02 * grid.bin_width / grid.range_max));
    rays_ = 1 + static_cast<size_t>(std::ceil(std::numbers::pi / wanted));
    elevation_step_ = std::numbers::pi / static_cast<double>(rays_ - 1);
    good_for_ = 0.01 * grid.bin_width * profile.slowest() / (std::max(profile.steepest(), 1e-9) * grid.range_max);
}

bool RayTable::place(double depth) {
    if (!places_.empty() && std::abs(depth - depth_) <= good_for_) return false;
    depth_ = depth;
    points_.resize(ranges_.size());
    places_.resize(rays_ * ranges_.size());
    for (size_t ray = 0; ray < rays_; ++ray) trace(ray, depth);
    findTears();
    return true;
}

void RayTable::findTears() {
    constexpr double widest = 6;  // relative to the distance of straight rays
    const size_t corners = ranges_.size();
    torn_.assign(places_.size(), 0);
    for (size_t i = 0; i + corners < places_.size(); ++i) {
        const Place &one = places_[i], &next = places_[i + corners];
        const bool part = (one.rise_rate < 0) != (next.rise_rate < 0);
        torn_[i] = part && std::abs(next.rise - one.rise) > widest * elevation_step_ * ranges_[i % corners];
    }
}

void RayTable::trace(size_t ray, double depth) {
    const double wanted = static_cast<double>(ray) * elevation_step_ - std::numbers::pi / 2;
    const double elevation = std::clamp(wanted, -steepest_ray, steepest_ray), cosine = std::cos(elevation);
    acoustics::traceRay(profile_, depth, elevation, times_, points_);
    for (size_t i = 0; i < points_.size(); ++i) {
        const acoustics::RayPoint& point = points_[i];
        const double pace = point.speed / nominal_;
        places_[ray * points_.size() + i] = {point.across / cosine, depth - point.depth,
                                             pace * std::cos(point.elevation) / cosine,
                                             pace * std::sin(point.elevation)};
    }
}

RayTable::Place RayTable::between(size_t ray, size_t corner, double share) const {
    const Place& a = places_[ray * ranges_.size() + corner];
    const Place& b = places_[ray * ranges_.size() + corner + 1];
    const double s = share, t = 1 - s, h = range_step_;
    const auto value = [&](double from, double from_rate, double to, double to_rate) {
        return from * t * t * (1 + 2 * s) + to * s * s * (1 + 2 * t) + h * s * t * (from_rate * t - to_rate * s);
    };
    const auto rate = [&](double from, double from_rate, double to, double to_rate) {
        return 6 * s * t * (to - from) / h + from_rate * t * (1 - 3 * s) + to_rate * s * (1 - 3 * t);
    };
    return {value(a.spread, a.spread_rate, b.spread, b.spread_rate), value(a.rise, a.rise_rate, b.rise, b.rise_rate),
            rate(a.spread, a.spread_rate, b.spread, b.spread_rate), rate(a.rise, a.rise_rate, b.rise, b.rise_rate)};
}

RayTable::Place RayTable::at(double elevation, double range) const {
    const double along = std::clamp(range / range_step_, 0.0, static_cast<double>(ranges_.size() - 1));
    const auto corner = std::min(static_cast<size_t>(along), ranges_.size() - 2);
    const double up = std::clamp((elevation + std::numbers::pi / 2) / elevation_step_, 0.0, double(rays_ - 1));
    const auto ray = std::min(static_cast<size_t>(up), rays_ - 2);
    const double share = along - static_cast<double>(corner), nearer = up - static_cast<double>(ray);
    const bool torn = torn_[ray * ranges_.size() + corner + 1];
    const double upper = torn ? std::round(nearer) : nearer, lower = 1 - upper;
    const Place a = between(ray, corner, share), b = between(ray + 1, corner, share);
    return {lower * a.spread + upper * b.spread, lower * a.rise + upper * b.rise,
            lower * a.spread_rate + upper * b.spread_rate, lower * a.rise_rate + upper * b.rise_rate};
}

}  // namespace insonify::sonar
