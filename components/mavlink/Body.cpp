#include "components/mavlink/Body.hpp"

#include <cmath>

#include "types/geometry/WorldFrame.hpp"

namespace insonify::mavlink {
namespace {

using types::Time;
using Order = types::SenderClock::Order;

constexpr types::Axes ned{types::WorldFrame::Ned};

/** Returns the time from an earlier stamp to a later one, also across a wrap-around. */
Time between(uint32_t earlier_ms, uint32_t later_ms) {
    return {int64_t{1000} * static_cast<int32_t>(later_ms - earlier_ms)};
}

bool isFinite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

types::Pose poseAt(glm::dvec3 north_east_down, glm::dquat ned_from_body) {
    types::Pose pose;
    pose.position = ned.rockFromWorld(north_east_down);
    pose.orientation = ned.rockFromOrientation(ned_from_body);
    return pose;
}

constexpr const char* overtaken = "the stamp is before that of the previous message";
constexpr const char* not_finite = "position and orientation are not finite, or the orientation has no length";

}  // namespace

types::Pose getPose(const AttitudeQuaternion& attitude, const LocalPositionNed& position) {
    const glm::dvec3 velocity{position.vx, position.vy, position.vz};
    glm::dvec3 place{position.x, position.y, position.z};
    if (isFinite(velocity)) place += velocity * between(position.time_boot_ms, attitude.time_boot_ms).seconds();
    types::Pose pose = poseAt(place, glm::dquat(attitude.w, attitude.x, attitude.y, attitude.z));
    pose.velocity = ned.rockFromWorld(velocity);
    pose.angular_velocity = ned.body({attitude.roll_speed, attitude.pitch_speed, attitude.yaw_speed});
    return pose;
}

types::Pose getPose(const VisionPositionEstimate& estimate) {
    const glm::dquat turned = glm::angleAxis(double{estimate.yaw}, glm::dvec3(0, 0, 1)) *
                              glm::angleAxis(double{estimate.pitch}, glm::dvec3(0, 1, 0)) *
                              glm::angleAxis(double{estimate.roll}, glm::dvec3(1, 0, 0));
    return poseAt({estimate.x, estimate.y, estimate.z}, turned);
}

bool Body::wants(uint32_t message) const {
    if (config_.source == Source::Vision) return message == VisionPositionEstimate::kind.message;
    return message == AttitudeQuaternion::kind.message || message == LocalPositionNed::kind.message;
}

bool Body::isInPart(const Frame& frame) const {
    return wants(frame.message) && frame.system == config_.system_id &&
           frame.component == config_.component_id.value_or(frame.component);
}

bool Body::listensTo(const Sender& sender, Time now) {
    if (sender_ && *sender_ != sender && types::elapsed(sender_came_, now) <= max_silence) return false;
    if (sender_ != sender) {
        position_.reset();
        boot_ms_.reset();
        clock_ = {};
    }
    sender_ = sender;
    sender_came_ = now;
    return true;
}

Body::Taken Body::take(const Frame& frame, uint64_t way, Time now) {
    if (!listensTo({way, frame.component}, now)) return {{}, "from another sender while the first is still sending"};
    if (const auto attitude = makeMessage<AttitudeQuaternion>(frame)) return take(*attitude, now);
    if (const auto position = makeMessage<LocalPositionNed>(frame)) return take(*position, now);
    if (const auto estimate = makeMessage<VisionPositionEstimate>(frame)) return take(*estimate, now);
    return {};
}

std::vector<uint32_t> Body::missing(Time now) const {
    const auto lacks = [&](Time came) { return types::elapsed(came, now) > patience; };
    std::vector<uint32_t> all;
    if (config_.source == Source::Vision) return all;  // sources other than the autopilot send unasked
    if (lacks(attitude_came_)) all.push_back(AttitudeQuaternion::kind.message);
    if (lacks(position_came_)) all.push_back(LocalPositionNed::kind.message);
    return all;
}

std::string Body::incomplete(const char* came, const char* lacks, Time now) {
    if (!incomplete_since_) incomplete_since_ = now;
    if (!types::due(*incomplete_since_, patience, now)) return {};
    return std::string(came) + " arrives without " + lacks + ": the vehicle must stream both";
}

Time Body::sinceBoot(uint32_t milliseconds) const {
    return boot_ms_ ? since_boot_ + between(*boot_ms_, milliseconds) : Time{int64_t{1000} * milliseconds};
}

Body::Taken Body::stamped(types::Pose pose, const types::SenderClock::Reading& reading) const {
    pose.time = reading.time;
    pose.position += origin_;
    pose.orientation = glm::normalize(pose.orientation);
    return {pose, ""};
}

Body::Taken Body::take(const AttitudeQuaternion& attitude, Time now) {
    const double length = glm::length(glm::dquat(attitude.w, attitude.x, attitude.y, attitude.z));
    if (!std::isfinite(length) || length < 1e-6) return {{}, not_finite};
    attitude_came_ = now;
    const Time stamp = sinceBoot(attitude.time_boot_ms);
    const auto reading = clock_.read(stamp, now);
    if (reading.order == Order::Late) return {{}, overtaken};
    if (reading.order == Order::Repeated) return {};
    since_boot_ = stamp;
    boot_ms_ = attitude.time_boot_ms;
    if (reading.order == Order::Restarted) position_.reset();
    const Time gap = position_ ? between(position_->time_boot_ms, attitude.time_boot_ms) : max_gap + max_gap;
    if (gap > max_gap || Time{} - gap > max_gap)
        return {{}, incomplete(AttitudeQuaternion::name, LocalPositionNed::name, now)};
    incomplete_since_.reset();
    return stamped(getPose(attitude, *position_), reading);
}

Body::Taken Body::take(const LocalPositionNed& position, Time now) {
    if (!isFinite({position.x, position.y, position.z})) return {{}, not_finite};
    position_came_ = now;
    const Time since = position_ ? between(position_->time_boot_ms, position.time_boot_ms) : Time{};
    if (since < Time{} && Time{} - since <= types::max_lateness) return {{}, overtaken};
    position_ = position;
    const bool is_alone = types::elapsed(attitude_came_, now) > patience;
    return {{}, is_alone ? incomplete(LocalPositionNed::name, AttitudeQuaternion::name, now) : ""};
}

Body::Taken Body::take(const VisionPositionEstimate& estimate, Time now) {
    const types::Pose pose = getPose(estimate);
    if (!types::isUsable(pose)) return {{}, not_finite};
    constexpr uint64_t latest = uint64_t{1} << 60;  // [us]; more than 36,000 years
    if (estimate.usec > latest) return {{}, "the stamp is out of bounds"};
    vision_came_ = now;
    const auto reading = clock_.read({static_cast<int64_t>(estimate.usec)}, now);
    if (reading.order == Order::Late) return {{}, overtaken};
    if (reading.order == Order::Repeated) return {};
    return stamped(pose, reading);
}

}  // namespace insonify::mavlink
