#include "components/gazebo/Poses.hpp"

#include <cstdint>

namespace insonify::gazebo {
namespace {

glm::dvec3 vectorOf(const ignition::msgs::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

types::Pose poseOf(const ignition::msgs::Pose& message, types::WorldFrame frame) {
    const types::Axes axes{frame};
    const ignition::msgs::Quaternion& q = message.orientation();
    types::Pose pose;
    pose.position = axes.rockFromWorld(vectorOf(message.position()));
    // A message leaves out what is not turned at all.
    const glm::dquat turned =
        message.has_orientation() ? glm::dquat(q.w(), q.x(), q.y(), q.z()) : glm::dquat(1, 0, 0, 0);
    pose.orientation = axes.rockFromOrientation(turned);
    return pose;
}

types::Pose poseOf(const ignition::msgs::Odometry& message, types::WorldFrame frame) {
    const types::Axes axes{frame};
    types::Pose pose = poseOf(message.pose(), frame);
    if (!message.has_twist() || !types::isUsable(pose)) return pose;
    pose.velocity = glm::normalize(pose.orientation) * axes.body(vectorOf(message.twist().linear()));
    pose.angular_velocity = axes.body(vectorOf(message.twist().angular()));
    return pose;
}

std::optional<types::Time> stampOf(bool has_header, const ignition::msgs::Header& header) {
    constexpr int64_t latest = int64_t{1} << 40;  // [s]; more than 34,000 years
    if (!has_header || !header.has_stamp()) return {};
    const int64_t seconds = header.stamp().sec();
    if (seconds < -latest || seconds > latest) return {};
    return types::Time{seconds * 1'000'000 + header.stamp().nsec() / 1000};
}

Entity findEntity(const ignition::msgs::Pose_V& message, const std::string& name) {
    Entity found;
    int count = 0;
    for (const ignition::msgs::Pose& pose : message.pose())
        if (pose.name() == name) {
            found.pose = &pose;
            ++count;
        }
    if (count == 1) return found;
    if (count == 0) return {nullptr, "no entity of that name"};
    return {nullptr, "several entities of that name, of which those in models are told in their parents"};
}

}  // namespace insonify::gazebo
