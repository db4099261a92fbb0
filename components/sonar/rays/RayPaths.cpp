#include "components/sonar/rays/RayPaths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "components/sonar/beams/BeamFan.hpp"
#include "types/geometry/Angle.hpp"

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

/** Returns a unit vector normal to a direction. */
glm::dvec3 computeAcross(const glm::dvec3& direction) {
    const glm::dvec3 up = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(up, direction));
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

double dopplerCoupling(const SonarConfig& config) {
    if (!config.motion_in_ping || !config.pulse || !config.pulse->chirp_us) return 0;
    return 1e-6 * *config.pulse->chirp_us * config.frequency_khz.value() / config.pulse->bandwidth_khz.value();
}

MotionBound motionBound(const SonarConfig& config, const BinGrid& grid) {
    const double flight = 2 * grid.range_max / grid.speed_of_sound;
    const double seconds = std::max(flight, dopplerCoupling(config));
    return {grid.bin_width / (2 * seconds), types::radians(config.beamWidthDeg()) / (2 * flight)};
}

RayPaths::RayPaths(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), coupling_(dopplerCoupling(plan.config)), share_(plan.beams.size() == 1 ? 0.5 : 1), stretch_(1) {
    if (plan.profile) table_.emplace(*plan.profile, plan.grid);
    if (plan.profile) stretch_ = std::max(1.0, plan.profile->fastest() / plan.grid.speed_of_sound);
    if (plan.config.motion_in_ping) motion_.emplace(geometry, 0.1 * plan.grid.speed_of_sound);
    corners_.reserve(RayTable::max_corners + 1);
}

void RayPaths::setScene(const types::Geometry& geometry) {
    if (motion_) motion_->setScene(geometry);
}

void RayPaths::place(const types::Snapshot& snapshot) {
    world_from_sonar_ = glm::mat3_cast(glm::normalize(snapshot.sonar.orientation));
    if (table_) table_->place(-waterView(snapshot).height);
    if (motion_) placeMotion(snapshot);
    placeCorners();
}

void RayPaths::placeMotion(const types::Snapshot& snapshot) {
    motion_->follow(snapshot);
    velocity_ = motion_->velocity() * world_from_sonar_;
    turn_ = motion_->turn() * world_from_sonar_;
    fastest_ = glm::length(velocity_) + motion_->fastest();
    const MotionBound bound = motionBound(plan_.config, plan_.grid);
    moves_ = fastest_ >= bound.speed || glm::length(turn_) >= bound.turn;
}

void RayPaths::placeCorners() {
    const double farthest = RayTable::beyond * plan_.grid.range_max;
    // A turning ray has the curvature 4 turn / c; about an object that turns, the curvature is 2 turn / c more. The arc
    // deviates from the chord by at most a tenth of a bin.
    const double bend = moves_ ? 4 * share_ * glm::length(turn_) + 2 * motion_->steepest() : 0;
    const double spacing =
        std::sqrt(8 * 0.1 * plan_.grid.bin_width * plan_.grid.speed_of_sound / std::max(bend, 1e-30));
    const double wanted = std::max(table_ ? static_cast<double>(table_->corners()) : 1, std::ceil(farthest / spacing));
    const auto count = static_cast<size_t>(std::min(wanted, static_cast<double>(RayTable::max_corners)));
    corners_.clear();
    for (size_t i = 0; i <= count; ++i)
        corners_.push_back(farthest * static_cast<double>(i) / static_cast<double>(count));
}

std::optional<EchoPoint> RayPaths::received(const glm::dvec3& place, size_t target) const {
    constexpr int steps = 100;
    Drift drift;
    if (motion_) drift.constant = motion_->targetVelocity(target) * world_from_sonar_;
    glm::dvec3 point = place, missed(0);  // the echo from `point` is `missed` away from the target
    for (int i = 0; i < steps; ++i) {
        missed = place - at(glm::normalize(point), glm::length(point), &drift);
        if (glm::length(missed) < 1e-6 * glm::length(place)) break;
        point += missed;
    }
    if (!(glm::length(missed) < 0.1 * plan_.grid.bin_width)) return {};
    const double range = glm::length(point);
    const glm::dvec3 direction = point / range;
    return EchoPoint{point, apparent(direction, glm::dot(direction, place), direction, range, &drift).focus};
}

glm::dvec3 RayPaths::movedBy(const glm::dvec3& direction, double range, const Drift* drift) const {
    const double c = plan_.grid.speed_of_sound, back = 2 * range / c;
    const glm::dvec3 swept = turn_ * (back * share_);
    const double angle = glm::length(swept);
    const glm::dvec3 ray = angle > 0 ? glm::angleAxis(angle, swept / angle) * direction : direction;
    // Sent from the origin and received at `there`, 2 `range` / c later, from direction `ray`: an ellipsoid about both.
    const glm::dvec3 there = velocity_ * back;
    const double leg = (4 * range * range - glm::dot(there, there)) / (4 * range + 2 * glm::dot(ray, there));
    const glm::dvec3 point = there + leg * ray;
    return drift ? point - drift->at(point) * ((2 * range - leg) / c) : point;
}

glm::dvec3 RayPaths::at(const glm::dvec3& direction, double range, const Drift* drift) const {
    glm::dvec3 point = direction * range;
    if (moves_ && range > 0) {
        const glm::dvec3 closing = velocity_ - (drift ? drift->at(point) : glm::dvec3(0));
        range = std::max(range + coupling_ * glm::dot(closing, direction), 1e-9);
        point = movedBy(direction, range, drift);
    }
    if (!table_) return point;
    const glm::dvec3 ray = world_from_sonar_ * direction;
    const RayTable::Place place = table_->at(std::asin(std::clamp(ray.z, -1.0, 1.0)), range);
    const glm::dvec3 bent = glm::dvec3(place.spread * ray.x, place.spread * ray.y, place.rise) * world_from_sonar_;
    return bent + (point - range * direction);
}

double RayPaths::nearLimit(double inverse_distance) const {
    const double speed = moves_ ? fastest_ : 0;
    const double stretched = stretch_ * (1 + 2 * speed / plan_.grid.speed_of_sound);
    const double range = 1 / (inverse_distance * stretched) - coupling_ * speed;
    return range > 1e-6 ? 1 / range : 1e6;
}

double RayPaths::computeRange(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                              const Drift* drift) const {
    constexpr int steps = 3;
    double range = near;
    for (int i = 0; i < steps; ++i) {
        const double here = glm::dot(normal, at(direction, range, drift)) - distance;
        const double apart = 1e-3 * near;
        const double there = glm::dot(normal, at(direction, range + apart, drift)) - distance;
        const double step = apart * here / (there - here);
        if (!(std::abs(step) < 0.1 * near)) break;  // along the plane
        range -= step;
    }
    return range;
}

ApparentPlane RayPaths::apparent(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                                 const Drift* drift) const {
    const double range = computeRange(normal, distance, direction, near, drift);
    const glm::dvec3 across = computeAcross(direction), upward = glm::cross(direction, across);
    const double angle = table_ ? table_->elevationStep() : 1e-3, length = 1e-3 * range;
    const auto turned = [&](const glm::dvec3& aside) {
        const auto to = [&](double by) { return at(glm::normalize(direction + by * aside), range, drift); };
        return (to(angle) - to(-angle)) / (2 * angle);
    };
    const glm::dvec3 by_across = turned(across), by_upward = turned(upward);
    const glm::dvec3 onward =
        (at(direction, range + length, drift) - at(direction, range - length, drift)) / (2 * length);
    const double facing = glm::dot(normal, onward), pace = glm::length(onward);
    // Derivatives of range with the direction, on the plane normal . at(direction, range) = distance [m].
    const double slope_across = -glm::dot(normal, by_across) / facing;
    const double slope_upward = -glm::dot(normal, by_upward) / facing;
    const double area = std::abs(glm::dot(glm::cross(by_across, by_upward), onward)) / pace;  // per steradian [m^2]
    ApparentPlane plane;
    plane.normal = direction / range - (slope_across * across + slope_upward * upward) / (range * range);
    plane.cosine = std::abs(facing) / (glm::length(normal) * pace);
    plane.focus = std::min(range * range / area, max_focus);
    return plane;
}

}  // namespace insonify::sonar
