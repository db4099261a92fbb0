#include "components/gazebo/Poses.hpp"

#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <cstdint>

namespace insonify::gazebo {
namespace {

glm::dvec3 vectorOf(const wire::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

types::Pose poseOf(const wire::Pose& message, const types::Axes& axes) {
    const wire::Quaternion& q = message.orientation();
    types::Pose pose;
    pose.position = axes.rockFromWorld(vectorOf(message.position()));
    // A message omits the identity orientation.
    const glm::dquat turned =
        message.has_orientation() ? glm::dquat(q.w(), q.x(), q.y(), q.z()) : glm::dquat(1, 0, 0, 0);
    pose.orientation = axes.rockFromOrientation(turned);
    return pose;
}

std::optional<types::Time> stampOf(const wire::Header& header) {
    constexpr int64_t latest = int64_t{1} << 40;  // [s]; more than 34,000 years
    if (!header.has_stamp()) return {};
    const int64_t seconds = header.stamp().sec();
    if (seconds < -latest || seconds > latest) return {};
    return types::Time{seconds * 1'000'000 + header.stamp().nsec() / 1000};
}

bool parse(std::string_view bytes, auto& message) {
    return bytes.size() < size_t{1} << 31 && message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

}  // namespace

std::optional<PoseMessage> readPoses(std::string_view bytes, types::WorldFrame frame) {
    wire::PoseV message;
    if (!parse(bytes, message)) return {};
    const types::Axes axes{frame};
    PoseMessage read{stampOf(message.header()), {}};
    for (const wire::Pose& pose : message.pose()) read.entities.push_back({pose.name(), poseOf(pose, axes)});
    return read;
}

std::optional<OdometryMessage> readOdometry(std::string_view bytes, types::WorldFrame frame) {
    wire::Odometry message;
    if (!parse(bytes, message)) return {};
    const types::Axes axes{frame};
    OdometryMessage read{stampOf(message.header()), poseOf(message.pose(), axes)};
    types::Pose& pose = read.pose;
    if (!message.has_twist() || !types::isUsable(pose)) return read;
    pose.velocity = glm::normalize(pose.orientation) * axes.body(vectorOf(message.twist().linear()));
    pose.angular_velocity = axes.body(vectorOf(message.twist().angular()));
    return read;
}

FoundEntity findEntity(const PoseMessage& message, const std::string& name) {
    FoundEntity found;
    int count = 0;
    for (const PoseMessage::Entity& entity : message.entities)
        if (entity.name == name) {
            found.pose = &entity.pose;
            ++count;
        }
    if (count == 1) return found;
    if (count == 0) return {nullptr, "no entity of that name"};
    return {nullptr, "several entities of that name; those inside models have poses in their parents' frames"};
}

}  // namespace insonify::gazebo
