#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "components/viewer/Messages.hpp"
#include "components/viewer/Publisher.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"
#include "tests/viewer/Bench.hpp"

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

TEST(MessagesTest, PosesAreEastNorthUpByDefault) {
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

// -- messages that Foxglove's panels draw --------------------------------------------------------------------------

template <class Message>
Message decoded(const Bytes& bytes) {
    Message message;
    ros::decode(*bytes, message);
    return message;
}

TEST(MessagesTest, APoseIsATransformOfTheBodyInTheWorld) {
    types::Pose pose = knownPose();
    pose.source_frame = "body";
    pose.target_frame = "world";
    Messages messages({}, ros::WorldFrame::Enu);
    const auto [transforms] = decoded<foxglove::FrameTransforms>(messages.encode(pose, Form::Transforms));
    ASSERT_EQ(transforms.size(), 1u);
    EXPECT_EQ(transforms[0].parent_frame_id, "world");
    EXPECT_EQ(transforms[0].child_frame_id, "body");
    EXPECT_EQ(transforms[0].timestamp.sec, 5);
    EXPECT_NEAR(transforms[0].translation.y, 3, 1e-12);
    EXPECT_NEAR(std::abs(transforms[0].rotation.z), 1, 1e-12);

    types::Snapshot snapshot;
    snapshot.sonar = pose;
    ros::SonarOptions options;
    options.frame_id = "fls";
    Messages of_scene(options, ros::WorldFrame::Enu);
    const AnySample sample = std::make_shared<const types::Snapshot>(snapshot);
    EXPECT_EQ(
        decoded<foxglove::FrameTransforms>(of_scene.encode(sample, Form::Transforms)).transforms[0].child_frame_id,
        "fls")
        << "the frame of points and pictures";
}

TEST(MessagesTest, APingIsAPictureOfTheFanAndPoints) {
    Messages messages({}, ros::WorldFrame::Enu);
    const AnySample ping = types::SonarPtr(blockPing());
    const auto picture = decoded<ros::Image>(messages.encode(ping, Form::Picture));
    ASSERT_EQ(picture.data.size(), size_t{picture.width} * picture.height);
    EXPECT_NEAR(picture.width, FanPicture::longest_side, 1);
    // 90 degrees and 15 m: 21.2 m wide, 15 m high; the sonar is below the middle.
    const double pixel = 15 * std::sqrt(2) / picture.width;
    const auto at = [&](double range, double bearing_deg) {
        const double bearing = types::radians(bearing_deg);
        const auto column = static_cast<size_t>(picture.width / 2.0 - range * std::sin(bearing) / pixel);
        const auto row = static_cast<size_t>(picture.height - range * std::cos(bearing) / pixel);
        return picture.data[row * picture.width + column];
    };
    for (const double bearing : {-16.0, 0.0, 10.5}) EXPECT_EQ(at(6.75, bearing), 255) << bearing;
    for (const auto& [range, bearing] : {std::pair(5.7, 0.0), {7.8, 0.0}, {6.75, -18.5}, {6.75, 13.0}, {6.0, 60.0}})
        EXPECT_EQ(at(range, bearing), 0) << range << " " << bearing;

    const auto points = decoded<ros::PointCloud2>(messages.encode(ping, Form::Points));
    EXPECT_EQ(points.width, 100u) << "ten beams of ten bins";
    EXPECT_EQ(points.header.frame_id, "sonar");
}

TEST(MessagesTest, RosbagsComputesTheSameHashesOfFoxglovesMessages) {
    if (!pythonHas("rosbags"))
        GTEST_SKIP() << "SKIPPED: the Python package rosbags is missing; scripts/setup installs it";
    const Folder folder;
    std::ofstream list(folder / "list");
    int count = 0;
    const auto add = [&]<class T>(const T& message) {
        const std::string number = std::to_string(count++);
        std::vector<char> bytes;
        ros::encode(message, bytes);
        std::ofstream(folder / (number + ".msg")) << ros::describeSchema<T>();
        std::ofstream(folder / (number + ".cdr")).write(bytes.data(), static_cast<int64_t>(bytes.size()));
        list << number << ' ' << T::type_name << ' ' << ros::typeHash<T>() << std::endl;
    };
    foxglove::SceneUpdate update;
    foxglove::SceneEntity& entity = update.entities.emplace_back();
    entity.metadata.emplace_back();
    entity.arrows.emplace_back();
    entity.cubes.emplace_back();
    entity.spheres.emplace_back();
    entity.cylinders.emplace_back();
    entity.lines.emplace_back().points.resize(2);
    entity.triangles.emplace_back().indices = {0, 1, 2};
    entity.texts.emplace_back().text = "text";
    entity.models.emplace_back().data = {1, 2, 3};
    update.deletions.emplace_back();
    add(update);
    add(entity);
    add(update.deletions[0]);
    add(entity.lifetime);
    add(entity.metadata[0]);
    add(entity.arrows[0]);
    add(entity.cubes[0]);
    add(entity.spheres[0]);
    add(entity.cylinders[0]);
    add(entity.lines[0]);
    add(entity.triangles[0]);
    add(entity.texts[0]);
    add(entity.models[0]);
    add(entity.texts[0].color);
    add(foxglove::FrameTransforms{{{}}});
    add(foxglove::FrameTransform{});
    EXPECT_THAT(
        pythonSays(test::sourceFile("tests/ros/read_messages.py ") + folder.path().string(), folder.path() / "answer"),
        testing::StartsWith("16 messages as announced\n"));
}

}  // namespace
}  // namespace insonify::viewer
