// Messages of Fortress, made by its own library.
#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "components/gazebo/Subscriptions.hpp"
#include "tests/gazebo/FortressWorld.hpp"

namespace insonify::gazebo {
namespace {

using types::WorldFrame;
constexpr double pi = std::numbers::pi;

void expectNear(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

ignition::msgs::Pose placed(double yaw) {
    ignition::msgs::Pose pose;
    setPose(pose, "rov", 1, 2, 3, yaw);
    return pose;
}

types::Pose getPose(const ignition::msgs::Pose& pose, WorldFrame frame) {
    ignition::msgs::Pose_V message;
    *message.add_pose() = pose;
    return readPoses(message.SerializeAsString(), frame).value_or(PoseMessage{}).entities.at(0).pose;
}

types::Pose getPose(const ignition::msgs::Odometry& message, WorldFrame frame) {
    return readOdometry(message.SerializeAsString(), frame).value_or(OdometryMessage{}).pose;
}

/** @param header  null: the message has none */
std::optional<types::Time> getStamp(const ignition::msgs::Header* header) {
    ignition::msgs::Pose_V message;
    if (header) *message.mutable_header() = *header;
    return readPoses(message.SerializeAsString(), WorldFrame::AsIs).value_or(PoseMessage{}).stamp;
}

TEST(PosesTest, AxesAreThoseOfTheScenesFileUnlessConfigured) {
    const types::Pose same = getPose(placed(pi / 2), WorldFrame::AsIs);
    expectNear(same.position, {1, 2, 3});
    expectNear(same.orientation * glm::dvec3(1, 0, 0), {0, 1, 0});
    const types::Pose of_enu = getPose(placed(pi / 2), WorldFrame::Enu);
    expectNear(of_enu.position, {2, -1, 3});  // 1 east, 2 north
    expectNear(of_enu.orientation * glm::dvec3(1, 0, 0), {1, 0, 0});
    const types::Pose of_ned = getPose(placed(pi / 2), WorldFrame::Ned);
    expectNear(of_ned.position, {1, -2, -3});
    expectNear(of_ned.orientation * glm::dvec3(1, 0, 0), {0, -1, 0});
}

TEST(PosesTest, APitchLowersTheBowAndARollLowersStarboard) {
    ignition::msgs::Pose pose;
    pose.mutable_orientation()->set_w(std::cos(pi / 12));
    pose.mutable_orientation()->set_y(std::sin(pi / 12));
    expectNear(getPose(pose, WorldFrame::AsIs).orientation * glm::dvec3(1, 0, 0), {std::cos(pi / 6), 0, -0.5});
    pose.mutable_orientation()->set_y(0);
    pose.mutable_orientation()->set_x(std::sin(pi / 12));
    expectNear(getPose(pose, WorldFrame::AsIs).orientation * glm::dvec3(0, 1, 0), {0, std::cos(pi / 6), 0.5});
}

TEST(PosesTest, AMessageWithoutAnOrientationIsNotTurned) {
    EXPECT_EQ(getPose(ignition::msgs::Pose{}, WorldFrame::AsIs).orientation, glm::dquat(1, 0, 0, 0));
}

TEST(PosesTest, VelocitiesOfOdometryAreThoseOfTheBody) {
    ignition::msgs::Odometry message;
    *message.mutable_pose() = placed(pi / 2);
    EXPECT_TRUE(std::isnan(getPose(message, WorldFrame::AsIs).velocity.x)) << "without a twist";
    message.mutable_twist()->mutable_linear()->set_x(2);
    message.mutable_twist()->mutable_angular()->set_y(0.5);
    const types::Pose pose = getPose(message, WorldFrame::AsIs);
    expectNear(pose.velocity, {0, 2, 0});
    expectNear(pose.angular_velocity, {0, 0.5, 0});
    expectNear(getPose(message, WorldFrame::Enu).velocity, {2, 0, 0});
}

TEST(PosesTest, StampsAreThoseOfTheSimulation) {
    ignition::msgs::Header header;
    EXPECT_EQ(getStamp(nullptr), std::nullopt);
    EXPECT_EQ(getStamp(&header), std::nullopt);
    setStamp(header, 0);
    EXPECT_EQ(getStamp(&header), types::Time{0});
    setStamp(header, 12.5);
    EXPECT_EQ(getStamp(&header), types::Time{12'500'000});
    header.mutable_stamp()->set_sec(std::numeric_limits<int64_t>::max());
    EXPECT_EQ(getStamp(&header), std::nullopt);
}

TEST(PosesTest, FindsAnEntityByAUniqueName) {
    ignition::msgs::Pose_V message;
    setPose(*message.add_pose(), "rov", 1, 2, 3, 0);
    for (int i = 0; i < 2; ++i) setPose(*message.add_pose(), "link", 0, 0, 0, 0);
    const PoseMessage read = readPoses(message.SerializeAsString(), WorldFrame::AsIs).value_or(PoseMessage{});
    ASSERT_TRUE(findEntity(read, "rov").pose);
    EXPECT_EQ(findEntity(read, "rov").pose->position.y, 2);
    EXPECT_EQ(findEntity(read, "auv").diagnostic, "no entity of that name");
    EXPECT_EQ(findEntity(read, "auv").pose, nullptr);
    EXPECT_EQ(findEntity(read, "link").pose, nullptr);
    EXPECT_THAT(findEntity(read, "link").diagnostic, testing::StartsWith("several entities of that name"));
}

}  // namespace
}  // namespace insonify::gazebo
