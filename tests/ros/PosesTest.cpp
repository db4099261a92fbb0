#include <gmock/gmock.h>

#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/ros/Samples.hpp"

namespace insonify::ros {
namespace {

template <class Message>
Message poseMessage(const types::Pose& pose, WorldFrame frame) {
    Message message;
    convert(pose, frame, message);
    return message;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-14) << i;
}
void expectNear(const glm::dmat3& a, const glm::dmat3& b) {
    for (int i = 0; i < 3; ++i) expectNear(a[i], b[i]);
}

/** Returns the direction of the body's nose in the message's world. */
glm::dvec3 nose(const Pose& pose) {
    const Quaternion& q = pose.orientation;
    return glm::dquat(q.w, q.x, q.y, q.z) * glm::dvec3(1, 0, 0);
}

TEST(PosesTest, AsIsTurnsNothing) {
    const auto message = poseMessage<PoseStamped>(smallPose(), WorldFrame::AsIs);
    EXPECT_EQ(message.header, (Header{{2, 1000}, "world"}));
    EXPECT_EQ(message.pose.position, (Point{3, 2, -5}));
    EXPECT_EQ(message.pose.orientation.z, smallPose().orientation.z);
}

TEST(PosesTest, ABodyThatLooksWestDoesSoInEveryWorld) {
    const auto enu = poseMessage<PoseStamped>(smallPose(), WorldFrame::Enu).pose;
    EXPECT_EQ(enu.position, (Point{-2, 3, -5}));  // 2 west, 3 north, 5 deep
    expectNear(nose(enu), {-1, 0, 0});
    const auto ned = poseMessage<PoseStamped>(smallPose(), WorldFrame::Ned).pose;
    EXPECT_EQ(ned.position, (Point{3, -2, 5}));
    expectNear(nose(ned), {0, -1, 0});
    EXPECT_LT(ned.orientation.z, 0);  // port is against the right-handed turn about down
}

TEST(PosesTest, ALevelBodyThatLooksNorthIsTheIdentityInNedAndAQuarterTurnInEnu) {
    types::Pose pose;
    const auto ned = poseMessage<PoseStamped>(pose, WorldFrame::Ned).pose.orientation;
    EXPECT_DOUBLE_EQ(ned.w, 1);
    const auto enu = poseMessage<PoseStamped>(pose, WorldFrame::Enu).pose.orientation;
    EXPECT_NEAR(enu.w, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(enu.z, std::sqrt(0.5), 1e-15);
}

TEST(PosesTest, ANoseDownBodyIsNoseDownInNed) {
    types::Pose pose;
    pose.orientation = glm::angleAxis(types::radians(30), glm::dvec3(0, 1, 0));  // looks down in Rock
    expectNear(nose(poseMessage<PoseStamped>(pose, WorldFrame::Ned).pose), {std::cos(types::radians(30)), 0, 0.5});
}

TEST(PosesTest, ATransformEqualsTheOdometry) {
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned}) {
        const auto odometry = poseMessage<Odometry>(smallPose(), frame);
        const auto message = poseMessage<TFMessage>(smallPose(), frame);
        ASSERT_EQ(message.transforms.size(), 1u);
        const TransformStamped& transform = message.transforms[0];
        EXPECT_EQ(transform.header, odometry.header);
        EXPECT_EQ(transform.child_frame_id, "body");
        const Point& p = odometry.pose.pose.position;
        EXPECT_EQ(transform.transform.translation, (Vector3{p.x, p.y, p.z}));
        EXPECT_EQ(transform.transform.rotation, odometry.pose.pose.orientation);
    }
}

TEST(PosesTest, AMountIsATransformToTheAxesOfThePing) {
    types::Mount mount;
    mount.position = {0.4, 0.1, -0.2};
    mount.pitch_deg = 90;  // looks down
    const auto turned = [](const Transform& transform, glm::dvec3 v) {
        const Quaternion& q = transform.rotation;
        return glm::dquat(q.w, q.x, q.y, q.z) * v;
    };
    const Transform ahead = toTransform(mount, WorldFrame::Enu, SensorFrame::XForward);
    EXPECT_EQ(ahead.translation, (Vector3{0.4, 0.1, -0.2}));
    expectNear(turned(ahead, {1, 0, 0}), {0, 0, -1});
    const Transform z_ahead = toTransform(mount, WorldFrame::Enu, SensorFrame::ZForward);
    expectNear(turned(z_ahead, {0, 0, 1}), {0, 0, -1});
    expectNear(turned(z_ahead, {0, 1, 0}), {0, -1, 0});  // to starboard
    expectNear(turned(z_ahead, {1, 0, 0}), {1, 0, 0});   // the sonar's up axis is ahead
    const Transform in_ned = toTransform(mount, WorldFrame::Ned, SensorFrame::XForward);
    EXPECT_EQ(in_ned.translation, (Vector3{0.4, -0.1, 0.2}));
    expectNear(turned(in_ned, {1, 0, 0}), {0, 0, 1});  // down
}

TEST(PosesTest, OdometryHasTheVelocityInTheBody) {
    // 0.5 north, 1.5 west; in a body that looks west: 1.5 ahead, 0.5 to starboard
    const auto enu = poseMessage<Odometry>(smallPose(), WorldFrame::Enu);
    expectNear({enu.twist.twist.linear.x, enu.twist.twist.linear.y, enu.twist.twist.linear.z}, {1.5, -0.5, -0.25});
    const auto ned = poseMessage<Odometry>(smallPose(), WorldFrame::Ned);
    expectNear({ned.twist.twist.linear.x, ned.twist.twist.linear.y, ned.twist.twist.linear.z}, {1.5, 0.5, 0.25});
    EXPECT_EQ(ned.twist.twist.angular, (Vector3{0.1, -0.2, -0.3}));
    EXPECT_NEAR(enu.pose.covariance[0], 2, 1e-14);  // variance of east: Rock's y
    EXPECT_NEAR(enu.pose.covariance[1], -0.1, 1e-14);
    EXPECT_EQ(enu.child_frame_id, "body");
}

TEST(PosesTest, RestoresOdometryFromEveryWorld) {
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned}) {
        const types::Pose pose = smallPose();
        types::Pose again;
        convert(poseMessage<Odometry>(pose, frame), frame, again);
        EXPECT_EQ(again.time, pose.time);
        EXPECT_EQ(again.source_frame, "body");
        EXPECT_EQ(again.target_frame, "world");
        expectNear(again.position, pose.position);
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(again.orientation[i], pose.orientation[i], 1e-15);
        expectNear(again.velocity, pose.velocity);
        expectNear(again.angular_velocity, pose.angular_velocity);
        expectNear(again.cov_position, pose.cov_position);
        expectNear(again.cov_orientation, pose.cov_orientation);
        expectNear(again.cov_velocity, pose.cov_velocity);
        expectNear(again.cov_angular_velocity, pose.cov_angular_velocity);
    }
}

TEST(PosesTest, MarksUnknownValuesAndRestoresThemAsUnknown) {
    types::Pose pose;
    pose.position = {1, 2, 3};
    const auto message = poseMessage<Odometry>(pose, WorldFrame::Enu);
    EXPECT_EQ(message.twist.twist.linear, Vector3{});
    EXPECT_EQ(message.twist.covariance[0], -1);
    EXPECT_EQ(message.twist.covariance[21], -1);
    EXPECT_EQ(message.pose.covariance, Covariance{});
    types::Pose again = smallPose();
    convert(message, WorldFrame::Enu, again);
    EXPECT_TRUE(std::isnan(again.velocity.x) && std::isnan(again.angular_velocity.z));
    EXPECT_TRUE(std::isnan(again.cov_position[0][0]) && std::isnan(again.cov_velocity[2][2]));
    convert(poseMessage<PoseStamped>(pose, WorldFrame::Ned), WorldFrame::Ned, again);
    EXPECT_EQ(again.position, pose.position);
    EXPECT_TRUE(std::isnan(again.velocity.x));
}

TEST(PosesTest, KeepsTimesToTheMicrosecondOnBothSidesOfTheEpoch) {
    for (const int64_t time : {int64_t{0}, int64_t{-1}, int64_t{1}, int64_t{-1'000'000}, int64_t{1'999'999}}) {
        EXPECT_LT(toRos({time}).nanosec, 1'000'000'000u);
        EXPECT_EQ(fromRos(toRos({time})).microseconds, time);
    }
    EXPECT_EQ(toClock({-1}).clock, (Time{-1, 999'999'000}));
}

}  // namespace
}  // namespace insonify::ros
