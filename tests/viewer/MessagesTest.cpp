#include <gtest/gtest.h>

#include <cmath>

#include "components/ros/Cdr.hpp"
#include "components/ros/GeometryMessages.hpp"
#include "components/viewer/Messages.hpp"
#include "components/viewer/ViewerConfig.hpp"

namespace insonify::viewer {
namespace {

ros::PoseStamped poseAs(ros::WorldFrame world, const AnySample& sample) {
    ros::PoseStamped message;
    ros::decode(*Messages({}, world).encode(sample), message);
    return message;
}

/** 3 m north, 2 m west, 1 m below the surface, heading west. */
types::Pose knownPose() {
    types::Pose pose;
    pose.time = {5'000'000};
    pose.position = {3, 2, -1};
    pose.orientation = glm::dquat(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
    return pose;
}

TEST(MessagesTest, PosesAreEastNorthUpUnlessAskedOtherwise) {
    EXPECT_EQ(ViewerConfig().world_frame, ros::WorldFrame::Enu);
    const auto pose = poseAs(ros::WorldFrame::Enu, knownPose()).pose;
    EXPECT_NEAR(pose.position.x, -2, 1e-12);
    EXPECT_NEAR(pose.position.y, 3, 1e-12);
    EXPECT_NEAR(pose.position.z, -1, 1e-12);
    EXPECT_NEAR(std::abs(pose.orientation.z), 1, 1e-12) << "west is half a turn from east";
    EXPECT_NEAR(pose.orientation.w, 0, 1e-12);
}

TEST(MessagesTest, TheSonarInASnapshotIsInTheSameAxes) {
    types::Snapshot snapshot;
    snapshot.sonar = knownPose();
    const AnySample sample = std::make_shared<const types::Snapshot>(snapshot);
    EXPECT_NEAR(poseAs(ros::WorldFrame::Enu, sample).pose.position.y, 3, 1e-12);
    EXPECT_NEAR(poseAs(ros::WorldFrame::AsIs, sample).pose.position.y, 2, 1e-12);
    EXPECT_NEAR(poseAs(ros::WorldFrame::Ned, sample).pose.position.z, 1, 1e-12);
}

}  // namespace
}  // namespace insonify::viewer
