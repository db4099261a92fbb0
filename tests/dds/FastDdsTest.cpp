// A ROS 2 peer by Fast DDS, which ROS 2 uses by default; its binary is built where Debian's libfastrtps-dev is.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::dds;
using nlohmann::json;

namespace {

const std::string program = test::program("dds_fast_peer");

struct FastDdsTest : Loopback {
    void SetUp() override {
        if (!std::filesystem::exists(program)) GTEST_SKIP() << program << " is not built: it needs libfastrtps-dev";
    }
};

}  // namespace

TEST_F(FastDdsTest, ReceivesEveryPingOf128KilobytesAt40Hertz) {
    TopicOut levels = topicOut("in", "/auv/sonar", message_type<ros::ProjectedSonarImage>);
    levels.sonar.dtype = ros::ImageType::Uint8;
    Publishing<types::SonarPtr> publishing({levels},
                                           [](PublisherConfig& config) { config.depth = 200; });  // a busy machine
    Peer peer({program, "listen", "marine_acoustic_msgs::msg::dds_::ProjectedSonarImage_", "/auv/sonar", "240", "200"});
    ASSERT_TRUE(peer.meets([&] { publishing.send(greeting()); }));
    const types::SonarPtr ping = makePing(256, 500);
    for (int i = 0; i < 200; ++i) {
        publishing.send(ping);
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    const json found = peer.result();
    EXPECT_EQ(found["count"], 200);
    EXPECT_GT(found["size"], 256 * 500);
    EXPECT_THAT(publishing.task.notices(), testing::IsEmpty());
}

TEST_F(FastDdsTest, SendsPosesWithoutLoss) {
    ros::Odometry message;
    message.header = {ros::toRos(framework::wallClock()), "map"};
    const deployer::TestFolder folder;
    const auto write = [&](const char* file, const ros::Point& place) {
        message.pose.pose.position = place;
        Bytes bytes;
        ros::encode(message, bytes);
        std::ofstream(folder / file, std::ios::binary).write(bytes.data(), std::ssize(bytes));
        return (folder / file).string();
    };
    const std::string greeting = write("greeting.cdr", {0, 0, 0}), odometry = write("odometry.cdr", {1, 2, 3});
    Subscribing subscribing("/auv/odometry", PoseType::Odometry, [](SubscriberConfig& config) {
        config.reliability = Reliability::Reliable;
        config.depth = 200;
        config.topics[0].stamp = StampFrom::Arrival;
    });
    Peer peer({program, "send", "nav_msgs::msg::dds_::Odometry_", "/auv/odometry", greeting, odometry, "100"});
    for (int i = 0; i < 100; ++i) {
        const auto pose = i == 0 ? subscribing.findFirst(peer) : subscribing.next();
        ASSERT_TRUE(pose) << i;
        EXPECT_EQ(pose->position, glm::dvec3(2, -1, 3));  // from east, north, up
    }
    EXPECT_THAT(subscribing.task.notices(), testing::IsEmpty());
}
