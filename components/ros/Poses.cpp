#include "components/ros/Poses.hpp"

#include <numbers>

#include "components/ros/Stamps.hpp"

namespace insonify::ros {

namespace {

using types::Axes;

template <class Xyz>
Xyz known(glm::dvec3 v) {
    if (isUnknown(v)) return {0, 0, 0};
    return {v.x, v.y, v.z};
}

/** Sets block 0 or 1 of the diagonal. */
void setBlock(size_t block, bool value_known, const glm::dmat3& covariance, Covariance& all) {
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 3; ++column)
            all[(3 * block + row) * 6 + 3 * block + column] =
                isUnknown(covariance) ? 0 : covariance[static_cast<int>(column)][static_cast<int>(row)];
    if (!value_known) all[21 * block] = -1;
}

glm::dmat3 blockOf(size_t block, const Covariance& all) {
    glm::dmat3 covariance{0};
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 3; ++column)
            covariance[static_cast<int>(column)][static_cast<int>(row)] =
                all[(3 * block + row) * 6 + 3 * block + column];
    return covariance == glm::dmat3(0) || all[21 * block] == -1 ? types::Pose::unknownMatrix() : covariance;
}

glm::dvec3 valueOf(size_t block, const Vector3& v, const Covariance& all) {
    return all[21 * block] == -1 ? glm::dvec3(types::Pose::unknown) : glm::dvec3(v.x, v.y, v.z);
}

void fillPose(const types::Pose& pose, Axes axes, Header& header, Pose& message) {
    header.stamp = toRos(pose.time);
    header.frame_id = pose.target_frame;
    const glm::dvec3 p = axes.worldFromRock(pose.position);
    const glm::dquat q = axes.orientationFromRock(pose.orientation);
    message.position = {p.x, p.y, p.z};
    message.orientation = {q.x, q.y, q.z, q.w};
}

void readPose(const Header& header, const Pose& message, Axes axes, types::Pose& pose) {
    pose.time = fromRos(header.stamp);
    pose.target_frame = header.frame_id;
    const Point& p = message.position;
    const Quaternion& q = message.orientation;
    pose.position = axes.rockFromWorld({p.x, p.y, p.z});
    pose.orientation = axes.rockFromOrientation(glm::dquat(q.w, q.x, q.y, q.z));
}

}  // namespace

glm::dvec3 worldFromRock(WorldFrame frame, glm::dvec3 v) { return Axes{frame}.worldFromRock(v); }
glm::dvec3 rockFromWorld(WorldFrame frame, glm::dvec3 v) { return Axes{frame}.rockFromWorld(v); }

void convert(const types::Pose& pose, WorldFrame frame, PoseStamped& message) {
    fillPose(pose, {frame}, message.header, message.pose);
}

void convert(const types::Pose& pose, WorldFrame frame, TFMessage& message) {
    message.transforms.resize(1);
    TransformStamped& stamped = message.transforms[0];
    Pose placed;
    fillPose(pose, {frame}, stamped.header, placed);
    stamped.child_frame_id = pose.source_frame;
    stamped.transform = {{placed.position.x, placed.position.y, placed.position.z}, placed.orientation};
}

Transform toTransform(const types::Mount& mount, WorldFrame frame, SensorFrame axes) {
    constexpr double half = std::numbers::sqrt2 / 2;
    const glm::dquat body_from_rock = frame == WorldFrame::Ned ? glm::dquat(0, 1, 0, 0) : glm::dquat(1, 0, 0, 0),
                     ahead_from_z =
                         axes == SensorFrame::ZForward ? glm::dquat(0, half, 0, half) : glm::dquat(1, 0, 0, 0);
    const glm::dvec3 p = Axes{frame}.body(mount.position);
    const glm::dquat q = glm::normalize(body_from_rock * mount.orientation() * ahead_from_z);
    return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

void convert(const types::Pose& pose, WorldFrame frame, Odometry& message) {
    const Axes axes{frame};
    fillPose(pose, axes, message.header, message.pose.pose);
    message.child_frame_id = pose.source_frame;
    const glm::dquat rock_from_body = glm::normalize(pose.orientation), body_from_rock = glm::inverse(rock_from_body);
    const auto body = [&](glm::dvec3 v) { return axes.body(v); };
    const auto world = [&](glm::dvec3 v) { return axes.worldFromRock(v); };
    const auto to_body = [&](glm::dvec3 v) { return axes.body(body_from_rock * v); };
    const auto to_world = [&](glm::dvec3 v) { return axes.worldFromRock(rock_from_body * v); };
    setBlock(0, true, both(pose.cov_position, world), message.pose.covariance);
    setBlock(1, true, both(pose.cov_orientation, to_world), message.pose.covariance);
    message.twist.twist.linear = known<Vector3>(to_body(pose.velocity));
    message.twist.twist.angular = known<Vector3>(body(pose.angular_velocity));
    setBlock(0, !isUnknown(pose.velocity), both(pose.cov_velocity, to_body), message.twist.covariance);
    setBlock(1, !isUnknown(pose.angular_velocity), both(pose.cov_angular_velocity, body), message.twist.covariance);
}

void convert(const PoseStamped& message, WorldFrame frame, types::Pose& pose) {
    pose = {};
    readPose(message.header, message.pose, {frame}, pose);
}

void convert(const Odometry& message, WorldFrame frame, types::Pose& pose) {
    const Axes axes{frame};
    readPose(message.header, message.pose.pose, axes, pose);
    pose.source_frame = message.child_frame_id;
    const glm::dquat rock_from_body = glm::normalize(pose.orientation), body_from_rock = glm::inverse(rock_from_body);
    const auto body = [&](glm::dvec3 v) { return axes.body(v); };
    const auto from_body = [&](glm::dvec3 v) { return rock_from_body * axes.body(v); };
    const auto from_world = [&](glm::dvec3 v) { return body_from_rock * axes.rockFromWorld(v); };
    const Covariance &of_pose = message.pose.covariance, &of_twist = message.twist.covariance;
    pose.cov_position = both(blockOf(0, of_pose), [&](glm::dvec3 v) { return axes.rockFromWorld(v); });
    pose.cov_orientation = both(blockOf(1, of_pose), from_world);
    pose.velocity = from_body(valueOf(0, message.twist.twist.linear, of_twist));
    pose.angular_velocity = body(valueOf(1, message.twist.twist.angular, of_twist));
    pose.cov_velocity = both(blockOf(0, of_twist), from_body);
    pose.cov_angular_velocity = both(blockOf(1, of_twist), body);
}

}  // namespace insonify::ros
