#include "components/nav/Motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace insonify::nav {
namespace {

/** Returns the rotation vector of a unit quaternion, the shorter way [rad]. */
glm::dvec3 rotationVector(glm::dquat turn) {
    if (turn.w < 0) turn = -turn;
    const glm::dvec3 half(turn.x, turn.y, turn.z);
    const double sine = glm::length(half);
    return sine == 0 ? glm::dvec3(0) : half * (2 * std::atan2(sine, turn.w) / sine);
}

/** First and second derivative at 0 of the parabola through 0 there and two other points. */
struct Derivatives {
    glm::dvec3 first, second;

    Derivatives(const glm::dvec3& before, double seconds_before, const glm::dvec3& after, double seconds_after) {
        const double all = seconds_before + seconds_after;
        const glm::dvec3 arriving = -before / seconds_before, leaving = after / seconds_after;
        first = (arriving * seconds_after + leaving * seconds_before) / all;
        second = 2.0 * (leaving - arriving) / all;
    }
};

bool isFinite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::optional<Motion> MotionTracker::take(const types::Pose& body) {
    const double seconds = count_ == 0 ? 0 : (body.time - poses_[2].time).seconds();
    const bool paused = std::abs(seconds) > longest_gap;
    if (pauses_.isDue(paused))
        warning_ = fmt::format(
            "poses {:.3g} s apart give no motion; measurements resume after three poses that are at most {:g} s apart",
            std::abs(seconds), longest_gap);
    if (paused) count_ = 0;
    if (count_ > 0 && seconds <= 0) return {};
    std::ranges::rotate(poses_, poses_.begin() + 1);
    types::place(body, mount_, poses_[2]);
    count_ = std::min(count_ + 1, 3);
    if (count_ < 3) return {};
    const Motion motion = middle();
    const bool is_finite = isFinite(motion.velocity) && isFinite(motion.acceleration) && isFinite(motion.angular_rate);
    return is_finite ? std::optional(motion) : std::nullopt;
}

std::string MotionTracker::consumeWarning() { return std::exchange(warning_, {}); }

Motion MotionTracker::middle() const {
    const auto& [before, now, after] = poses_;
    const double back = (now.time - before.time).seconds(), on = (after.time - now.time).seconds();
    const auto turnTo = [&](const types::Pose& other) {
        return rotationVector(glm::conjugate(now.orientation) * other.orientation);
    };
    const Derivatives place(before.position - now.position, back, after.position - now.position, on);
    const Derivatives turn(turnTo(before), back, turnTo(after), on);
    return {now.time, now.position, now.orientation, place.first, place.second, turn.first, (back + on) / 2};
}

bool Cadence::isDue(types::Time time) {
    if (period_ <= 0) return true;
    const int64_t us = time.microseconds;
    const int64_t periods = us / period_ - (us % period_ < 0);
    const bool is_due = !last_ || *last_ != periods;
    last_ = periods;
    return is_due;
}

}  // namespace insonify::nav
