#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "components/dds/Endpoints.hpp"
#include "components/dds/PublisherTask.hpp"
#include "components/dds/TransformTask.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Pings.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"
#include "types/samples/Pose.hpp"

using namespace insonify;
using namespace insonify::dds;
using testing::HasSubstr;

namespace {

struct PublisherTaskTest : Loopback {
    Node node{domainId({}), "listener", 16};

    /** Returns the message that `send` causes on a topic, or fails. */
    template <class Message>
    Message received(const std::string& topic, const std::function<void()>& send) {
        Reader reader(node, ddsTopic(topic), Message::type_name, "", {}, {});
        Bytes bytes;
        uint64_t sender = 0;
        Message message;
        const bool came = becomesTrue([&] { return send(), reader.take(bytes, sender); });
        EXPECT_TRUE(came);
        if (came) ros::decode(std::span<const char>(bytes), message);
        return message;
    }
};

/** A sonar and a scene with mount and frequency. */
struct Described {
    double frequency_khz = 0;
    types::Mount mount;
    static void describe(auto& self, auto& visit) {
        visit({"frequency_khz", "kHz"}, self.frequency_khz);
        visit({"mount"}, self.mount);
    }
};
struct Sonar : framework::TaskContext {
    Sonar() : TaskContext("sonar") {
        Described described;
        described.frequency_khz = 750;
        described.mount.position = {0.5, 0, -0.25};
        config.set(described);
        refreshRecord();
    }
    framework::Properties<Described> config{this};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", ""};
};

std::string toText(const types::Diagnostics& diagnostics) {
    std::string text;
    for (const types::Diagnostic& diagnostic : diagnostics) text += diagnostic.path + " " + diagnostic.message + "\n";
    return text;
}

}  // namespace

TEST_F(PublisherTaskTest, SendsAPingAsEachMessageThatItCanBecome) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/image", message_type<ros::ProjectedSonarImage>),
                                            topicOut("in", "/raw", message_type<ros::RawSonarImage>),
                                            topicOut("in", "/ranges", message_type<ros::SonarRanges>),
                                            topicOut("in", "/detections", message_type<ros::SonarDetections>),
                                            topicOut("in", "/points", message_type<ros::PointCloud2>),
                                            topicOut("in", "/scan", message_type<ros::LaserScan>),
                                            topicOut("in", "/clock", message_type<ros::Clock>)});
    const types::SonarPtr ping = makePing(16, 50);
    const auto send = [&] { publishing.send(ping); };
    const auto image = received<ros::ProjectedSonarImage>("/image", send);
    EXPECT_EQ(image.image.beam_count, 16u);
    EXPECT_EQ(image.ranges.size(), 50u);
    EXPECT_EQ(image.image.data.size(), 16u * 50 * 4);  // float32
    EXPECT_EQ(image.header.frame_id, "sonar");
    EXPECT_EQ(ros::fromRos(image.header.stamp), ping->time);
    ros::ProjectedSonarImage expected;
    ros::SonarOptions options;
    ros::convert(*ping, options, expected);
    EXPECT_EQ(image, expected);
    EXPECT_EQ(received<ros::RawSonarImage>("/raw", send).samples_per_beam, 50u);
    EXPECT_EQ(received<ros::SonarRanges>("/ranges", send).ranges.size(), 16u);
    EXPECT_EQ(received<ros::SonarDetections>("/detections", send).two_way_travel_times.size(), 16u);
    EXPECT_GT(received<ros::PointCloud2>("/points", send).width, 0u);
    EXPECT_EQ(received<ros::LaserScan>("/scan", send).ranges.size(), 16u);
    EXPECT_EQ(ros::fromRos(received<ros::Clock>("/clock", send).clock), ping->time);
}

TEST_F(PublisherTaskTest, SendsDetectionsInTheFrameOfTheSonarWithItsFrequency) {
    auto found = std::make_shared<types::SonarDetections>();
    found->time = framework::wallClock();
    found->speed_of_sound = 1500;
    found->beam_height = {0.0175};
    found->add({0.5}, {-0.25}, 12, 0.5);
    TopicOut topic = topicOut("in", "/detections", message_type<ros::SonarDetections>);
    topic.sonar.frequency_khz = 400;
    topic.sonar.frame_id = "multibeam";
    Publishing<types::SonarDetectionsPtr> publishing({topic});
    const auto message = received<ros::SonarDetections>("/detections", [&] { publishing.send(found); });
    ros::SonarDetections expected;
    ros::SonarOptions options;
    options.frequency_khz = 400;
    options.frame_id = "multibeam";
    ros::convert(*found, options, expected);
    EXPECT_EQ(message, expected);
}

TEST_F(PublisherTaskTest, ConvertsSoundingsToTheWorldFrameAndNamesIt) {
    auto soundings = std::make_shared<types::PointCloud>();
    soundings->time = framework::wallClock();
    soundings->add({12.5, -3.25, -8}, 0.5);  // north, west, up
    Publishing<types::PointCloudPtr> publishing({topicOut("in", "/soundings", message_type<ros::PointCloud2>)},
                                                [](PublisherConfig& config) { config.world_frame_id = "odom"; });
    const auto cloud = received<ros::PointCloud2>("/soundings", [&] { publishing.send(soundings); });
    ASSERT_EQ(cloud.data.size(), 16u);
    float point[4];
    std::memcpy(point, cloud.data.data(), sizeof point);
    EXPECT_THAT(point, testing::ElementsAre(3.25f, 12.5f, -8, 0.5f)) << "east, north, up";
    EXPECT_EQ(cloud.header.frame_id, "odom");
}

TEST_F(PublisherTaskTest, ConvertsAPoseToTheWorldFrameAndNamesItsFrames) {
    types::Pose pose;
    pose.time = framework::wallClock();
    pose.position = {3, 2, 1};  // north, west, up
    for (const auto& [frame, expected] :
         {std::pair{ros::WorldFrame::Enu, ros::Point{-2, 3, 1}}, std::pair{ros::WorldFrame::Ned, ros::Point{3, -2, -1}},
          std::pair{ros::WorldFrame::AsIs, ros::Point{3, 2, 1}}}) {
        Publishing<types::Pose> publishing({topicOut("in", "/odometry", message_type<ros::Odometry>)},
                                           [&](PublisherConfig& config) { config.node.world_frame = frame; });
        const auto message = received<ros::Odometry>("/odometry", [&] { publishing.send(pose); });
        EXPECT_EQ(message.pose.pose.position, expected);
        EXPECT_EQ(message.header.frame_id, "map");
        EXPECT_EQ(message.child_frame_id, "base_link");
    }
}

TEST_F(PublisherTaskTest, SendsAPoseAsATransformOfItsFrames) {
    types::Pose pose;
    pose.time = framework::wallClock();
    pose.position = {3, 2, 1};  // north, west, up
    Publishing<types::Pose> publishing({topicOut("in", "/tf", message_type<ros::TFMessage>)});
    const auto message = received<ros::TFMessage>("/tf", [&] { publishing.send(pose); });
    ASSERT_EQ(message.transforms.size(), 1u);
    EXPECT_EQ(message.transforms[0].header.frame_id, "map");
    EXPECT_EQ(message.transforms[0].child_frame_id, "base_link");
    EXPECT_EQ(message.transforms[0].transform.translation, (ros::Vector3{-2, 3, 1}));
}

TEST_F(PublisherTaskTest, PublishesTheMountToLateSubscribersAndTheFrequencyInPings) {
    TopicOut image = topicOut("in", "/image", message_type<ros::ProjectedSonarImage>),
             other = topicOut("in", "/other", message_type<ros::ProjectedSonarImage>);
    image.sonar.frame_id = "sonar_z";
    other.sonar.frequency_khz = 300;
    PublisherConfig config;
    config.topics = {topicOut("in", "/scan", message_type<ros::LaserScan>), image, other};
    config.tf_static.emplace();
    PublisherTask task("publisher");
    task.config.set(config);
    Sonar sonar;
    sonar.ping.connectTo(*task.makeInput("in", sonar.ping), framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure() && task.start());

    const Quality latched{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    Reader late(node, ddsTopic("/tf_static"), ros::TFMessage::type_name, "", latched, {});
    Bytes bytes;
    uint64_t sender = 0;
    ASSERT_TRUE(becomesTrue([&] { return late.take(bytes, sender); }));
    ros::TFMessage mounts;
    ros::decode(std::span<const char>(bytes), mounts);
    ASSERT_EQ(mounts.transforms.size(), 2u) << "a frame once";
    EXPECT_EQ(mounts.transforms[0].header.frame_id, "base_link");
    EXPECT_EQ(mounts.transforms[0].child_frame_id, "sonar");
    EXPECT_EQ(mounts.transforms[0].transform.translation, (ros::Vector3{0.5, 0, -0.25}));
    EXPECT_EQ(mounts.transforms[0].transform.rotation, (ros::Quaternion{0, 0, 0, 1}));
    EXPECT_EQ(mounts.transforms[1].child_frame_id, "sonar_z");
    EXPECT_NEAR(mounts.transforms[1].transform.rotation.x, std::sqrt(0.5), 1e-15);

    const auto send = [&] {
        sonar.ping.write(makePing(4, 4));
        task.update();
    };
    EXPECT_EQ(received<ros::ProjectedSonarImage>("/image", send).ping_info.frequency, 750e3f);
    EXPECT_EQ(received<ros::ProjectedSonarImage>("/other", send).ping_info.frequency, 300e3f) << "the topic's own";
}

TEST_F(PublisherTaskTest, WarnsOnceOfAMessageThatFastDdsWouldLose) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/large", message_type<ros::ProjectedSonarImage>)});
    std::vector<std::string> reported;
    publishing.task.environment().warn = [&](const std::string& text) { reported.push_back(text); };
    received<ros::ProjectedSonarImage>("/large", [&] { publishing.send(makePing(16, 50)); });
    EXPECT_THAT(reported, testing::IsEmpty());
    Reader reader(node, ddsTopic("/large"), ros::ProjectedSonarImage::type_name, "", {}, {});
    EXPECT_TRUE(becomesTrue([&] { return publishing.send(makePing(256, 500)), !reported.empty(); }));
    publishing.send(makePing(256, 500));
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_THAT(reported[0],
                HasSubstr("/large: its messages of 520 kB are larger than Linux's receive buffers (213 kB)"));
    EXPECT_THAT(reported[0], HasSubstr("take dtype: uint8, or raise"));
}

TEST_F(PublisherTaskTest, TheRemedyForALargeMessageDiffersFromThePresentSetting) {
    TopicOut small = topicOut("in", "/large", message_type<ros::ProjectedSonarImage>);
    small.sonar.dtype = ros::ImageType::Uint8;
    Publishing<types::SonarPtr> publishing({small});
    std::vector<std::string> reported;
    publishing.task.environment().warn = [&](const std::string& text) { reported.push_back(text); };
    Reader reader(node, ddsTopic("/large"), ros::ProjectedSonarImage::type_name, "", {}, {});
    EXPECT_TRUE(becomesTrue([&] { return publishing.send(makePing(512, 500)), !reported.empty(); }));
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_THAT(reported[0], testing::AllOf(HasSubstr("lose most of them; raise"), testing::Not(HasSubstr("dtype"))));
}

TEST_F(PublisherTaskTest, SendsAPictureAsAnImage) {
    auto picture = std::make_shared<types::Image>();
    picture->size = {4, 2};
    picture->pixel_size = 3;
    picture->row_size = 12;
    picture->frame_mode = types::ImageMode::Bgr;
    picture->frame_status = types::ImageStatus::Valid;
    picture->image.assign(24, 9);
    Publishing<types::ImagePtr> publishing({topicOut("in", "/fan", message_type<ros::Image>)});
    const auto message = received<ros::Image>("/fan", [&] { publishing.send(picture); });
    EXPECT_EQ(message.encoding, "bgr8");
    EXPECT_EQ(message.data, picture->image);
}

TEST_F(PublisherTaskTest, MakesNoMessageForATopicWithoutReaders) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/nobody", message_type<ros::LaserScan>)});
    auto crooked = std::make_shared<types::Sonar>(*makePing(4, 4));
    crooked->bearings[1] = types::Angle{0.1234};  // cannot become a LaserScan
    publishing.send(crooked);
    EXPECT_THAT(publishing.task.notices(), testing::IsEmpty());
}

TEST_F(PublisherTaskTest, DropsAndCountsSamplesThatDoNotFitTheMessage) {
    Publishing<types::SonarPtr> publishing({topicOut("in", "/scan", message_type<ros::LaserScan>),
                                            topicOut("in", "/image", message_type<ros::RawSonarImage>)});
    std::vector<std::string> reported;
    publishing.task.environment().warn = [&](const std::string& text) { reported.push_back(text); };
    auto crooked = std::make_shared<types::Sonar>(*makePing(4, 4));
    crooked->bearings[1] = types::Angle{0.1234};
    Reader reader(node, ddsTopic("/scan"), ros::LaserScan::type_name, "", {}, {});
    ASSERT_TRUE(becomesTrue([&] { return publishing.send(crooked), !publishing.task.notices().empty(); }));
    publishing.send(crooked);
    EXPECT_EQ(publishing.task.state(), framework::TaskState::Running);
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_THAT(reported[0], HasSubstr("publisher: 1 message dropped; the last: /scan: the beams are not at equal"));
    EXPECT_THAT(publishing.task.notices(),
                testing::UnorderedElementsAre(HasSubstr("2 messages dropped: /scan: the beams")));
    EXPECT_EQ(received<ros::RawSonarImage>("/image", [&] { publishing.send(crooked); }).image.beam_count, 4u);
}

TEST_F(PublisherTaskTest, ConfiguredFramesReplaceThoseOfThePose) {
    types::Pose pose;
    pose.time = framework::wallClock();
    pose.target_frame = "world";
    pose.source_frame = "body";
    TopicOut plain = topicOut("in", "/plain", message_type<ros::Odometry>),
             named = topicOut("in", "/named", message_type<ros::Odometry>);
    named.child_frame_id = "auv";
    named.sonar.frame_id = "odom";
    Publishing<types::Pose> publishing({plain, named});
    const auto send = [&] { publishing.send(pose); };
    EXPECT_EQ(received<ros::Odometry>("/plain", send).header.frame_id, "world");
    EXPECT_EQ(received<ros::Odometry>("/plain", send).child_frame_id, "body");
    EXPECT_EQ(received<ros::Odometry>("/named", send).header.frame_id, "odom");
    EXPECT_EQ(received<ros::Odometry>("/named", send).child_frame_id, "auv");
    Publishing<types::Pose> mapped({topicOut("in", "/mapped", message_type<ros::PoseStamped>)},
                                   [](PublisherConfig& config) { config.world_frame_id = "map"; });
    EXPECT_EQ(received<ros::PoseStamped>("/mapped", [&] { mapped.send(pose); }).header.frame_id, "map");
}

TEST_F(PublisherTaskTest, ReportsAFrameWithTwoKindsOfAxes) {
    const TopicOut image = topicOut("in", "/image", message_type<ros::ProjectedSonarImage>);
    TopicOut scan = topicOut("in", "/scan", message_type<ros::LaserScan>);
    EXPECT_THAT(Publishing<types::SonarPtr>({image, scan}).task.notices(),
                testing::ElementsAre(HasSubstr("frame_id sonar has x ahead on /scan and z ahead on /image")));
    scan.sonar.frame_id = "sonar_x";
    EXPECT_THAT(Publishing<types::SonarPtr>({image, scan}).task.notices(), testing::IsEmpty());
}

/** A type that is not a sample. */
struct Unknown {
    static constexpr const char* type_name = "/unknown";
};

TEST_F(PublisherTaskTest, ReportsWrongPortsAndTypesBeforeTheRun) {
    PublisherTask task("publisher");
    PublisherConfig config;
    config.topics = {topicOut("ping", "/a", message_type<ros::Odometry>),
                     topicOut("none", "/b", message_type<ros::Image>)};
    task.config.set(config);
    test::Writer<types::SonarPtr> sonar;
    test::Writer<std::shared_ptr<const Unknown>> unknown;
    EXPECT_THROW(task.makeInput("other", sonar.port), types::ConfigError);
    EXPECT_THROW(task.makeInput("ping", unknown.port), types::ConfigError);
    ASSERT_NE(task.makeInput("ping", sonar.port), nullptr);
    types::Diagnostics diagnostics;
    task.check(diagnostics);
    EXPECT_THAT(toText(diagnostics), HasSubstr("topics[0].type is nav_msgs/Odometry; "));
    EXPECT_THAT(toText(diagnostics), HasSubstr("can be marine_acoustic_msgs/ProjectedSonarImage, "));
    EXPECT_THAT(toText(diagnostics), HasSubstr("topics[1].port is none; no connection leads to publisher.none"));
}

TEST_F(PublisherTaskTest, ReportsNamesThatRosRefuses) {
    PublisherConfig config;
    config.node.node_name = "a b";
    config.node.gid_size = 20;
    config.topics = {topicOut("", "/a", message_type<ros::Image>), topicOut("x", "/a", message_type<ros::Image>),
                     topicOut("x", "a-b", message_type<ros::Image>)};
    types::Diagnostics diagnostics;
    config.check(diagnostics);
    EXPECT_EQ(diagnostics.size(), 5u) << toText(diagnostics);
}

TEST_F(PublisherTaskTest, TopicsAndFramesGetTheNamespaceOfTheVehicle) {
    types::RosNames names;
    names.setNamespace("auv1");
    names.setFramePrefix("auv1");
    names.remaps = {{"publisher", "there", "/remapped"}, {"other", "sonar", "/never"}};
    types::Pose pose;
    pose.time = framework::wallClock();
    {
        Publishing<types::Pose> publishing({topicOut("in", "odometry", message_type<ros::Odometry>),
                                            topicOut("in", "there", message_type<ros::PoseStamped>),
                                            topicOut("in", "/tf", message_type<ros::TFMessage>)},
                                           {}, names);
        const auto send = [&] { publishing.send(pose); };
        const auto odometry = received<ros::Odometry>("/auv1/odometry", send);
        EXPECT_EQ(odometry.header.frame_id, "map");
        EXPECT_EQ(odometry.child_frame_id, "auv1/base_link");
        EXPECT_EQ(received<ros::PoseStamped>("/remapped", send).header.frame_id, "map");
        const auto transforms = received<ros::TFMessage>("/tf", send);
        ASSERT_EQ(transforms.transforms.size(), 1u);
        EXPECT_EQ(transforms.transforms[0].header.frame_id, "map");
        EXPECT_EQ(transforms.transforms[0].child_frame_id, "auv1/base_link");
        EXPECT_THAT(publishing.task.notices(), testing::IsEmpty()) << "/tf is shared";
        pose.source_frame = "auv1/hull";  // from a sender that has added the prefix already
        EXPECT_EQ(received<ros::Odometry>("/auv1/odometry", send).child_frame_id, "auv1/hull");
    }
    Publishing<types::SonarPtr> publishing(
        {topicOut("in", "sonar", message_type<ros::ProjectedSonarImage>),
         topicOut("in", "/scan", message_type<ros::LaserScan>)},
        [](PublisherConfig& config) { config.frame_id = "fls"; }, names);
    const auto send = [&] { publishing.send(makePing(16, 50)); };
    EXPECT_EQ(received<ros::ProjectedSonarImage>("/auv1/sonar", send).header.frame_id, "auv1/fls");
    EXPECT_EQ(received<ros::LaserScan>("/scan", send).header.frame_id, "auv1/fls");
    EXPECT_THAT(publishing.task.notices(),
                testing::Contains("not in the namespace /auv1, because their names begin with a slash: /scan"));
}

TEST_F(PublisherTaskTest, RefusesRemapsToTheSameTopic) {
    types::RosNames names;
    names.remaps = {{"", "/a", "/b"}};
    PublisherTask task("publisher");
    task.environment().names = names;
    PublisherConfig config;
    config.topics = {topicOut("in", "/a", message_type<ros::Clock>), topicOut("in", "/b", message_type<ros::Clock>)};
    task.config.set(config);
    EXPECT_FALSE(task.configure());
    ASSERT_TRUE(task.configError());
    EXPECT_THAT(toText(task.configError()->diagnostics()), HasSubstr("topics[1].topic is /b a second time"));
}

TEST_F(PublisherTaskTest, PublishesTheMountBetweenPrefixedFrames) {
    PublisherTask task("publisher");
    Sonar sonar;
    task.environment().names.setFramePrefix("auv1");
    PublisherConfig config;
    config.topics = {topicOut("in", "/scan", message_type<ros::LaserScan>)};
    config.tf_static.emplace();
    task.config.set(config);
    sonar.ping.connectTo(*task.makeInput("in", sonar.ping), framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure());
    const Quality latched{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    Reader reader(node, "rt/tf_static", ros::TFMessage::type_name, "", latched, {});
    Bytes bytes;
    uint64_t sender = 0;
    ASSERT_TRUE(becomesTrue([&] { return reader.take(bytes, sender); }));
    ros::TFMessage message;
    ros::decode(std::span<const char>(bytes), message);
    ASSERT_EQ(message.transforms.size(), 1u);
    EXPECT_EQ(message.transforms[0].header.frame_id, "auv1/base_link");
    EXPECT_EQ(message.transforms[0].child_frame_id, "auv1/sonar");
}

TEST(FrameNames, ThatTfRefusesAreRefusedWithTheirPlace) {
    for (const std::string bad : {"/sonar", "my sonar", "", "a\tb", "sonar\n"}) {
        PublisherConfig config;
        config.topics = {topicOut("in", "/sonar", message_type<ros::Odometry>)};
        config.frame_id = bad;
        config.world_frame_id = bad;
        config.tf_static.emplace().frame_id = bad;
        config.topics[0].sonar.frame_id = bad;
        config.topics[0].child_frame_id = bad;
        types::Diagnostics diagnostics;
        config.check(diagnostics);
        std::vector<std::string> places;
        for (const types::Diagnostic& each : diagnostics) {
            places.push_back(each.path);
            EXPECT_THAT(each.message, HasSubstr("is \"" + bad + "\"; must be a name without spaces"));
        }
        std::vector<std::string> wrong{"frame_id", "world_frame_id", "tf_static.frame_id", "topics[0].child_frame_id"};
        if (!bad.empty()) wrong.push_back("topics[0].frame_id");  // empty: the task's
        EXPECT_THAT(places, testing::UnorderedElementsAreArray(wrong)) << bad;
        TransformConfig read;
        read.frames.resize(1);
        read.world_frame_id = read.frames[0].frame_id = bad;
        diagnostics.clear();
        read.check(diagnostics);
        EXPECT_EQ(std::ranges::count(diagnostics, "frames[0].frame_id", &types::Diagnostic::path) +
                      std::ranges::count(diagnostics, "world_frame_id", &types::Diagnostic::path),
                  3);  // and the same frame twice
    }
    types::Diagnostics none;
    for (const char* good : {"sonar", "auv/base_link", "sonar-1.front"}) ros::checkFrame("frame_id", good, none);
    EXPECT_TRUE(none.empty());
}
