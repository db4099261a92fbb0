#include <gmock/gmock.h>

#include "components/log/mcap/Reader.hpp"
#include "components/log/mcap/SampleWriter.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/log/mcap/SmallFile.hpp"
#include "tests/support/CommaLocale.hpp"
#include "tests/support/Refused.hpp"
#include "types/samples/Image.hpp"

namespace insonify::log::mcap {
namespace {

template <class T>
std::vector<T> getSamples(log::Reader& log, const std::string& stream) {
    std::vector<T> samples;
    log.forEach<T>(stream, [&](const T& sample, const SampleRef&) { samples.push_back(sample); });
    return samples;
}

void expectSame(const types::Sonar& a, const types::Sonar& b) {
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.bin_duration, b.bin_duration);
    EXPECT_EQ(a.speed_of_sound, b.speed_of_sound);
    ASSERT_EQ(a.bins.size(), b.bins.size());
    EXPECT_EQ(std::memcmp(a.bins.data(), b.bins.data(), a.bins.size() * sizeof(float)), 0);
    for (size_t i = 0; i < a.bearings.size(); ++i) EXPECT_NEAR(a.bearings[i].rad, b.bearings[i].rad, 1e-15);
    EXPECT_FLOAT_EQ(static_cast<float>(a.beam_width.rad), static_cast<float>(b.beam_width.rad));
    EXPECT_EQ(a.beam_height.isUnknown(), b.beam_height.isUnknown());
}

TEST(SampleWriterTest, PingsAndPosesAreReadBackUnchanged) {
    const Folder folder;
    smallFile(folder / "x.0.mcap");
    const auto log = openLog(folder / "x.0.mcap");
    EXPECT_TRUE(log->complete()) << log->diagnostic();
    ASSERT_EQ(log->streams().size(), 2u);
    EXPECT_EQ(log->streams()[0].name, "sonar.ping");
    EXPECT_EQ(log->streams()[1].type, "/base/samples/RigidBodyState_m");
    EXPECT_EQ(log->streams()[0].metadata.at("insonify_deployment"), "tasks:\n  a: \"b\"\n");
    ASSERT_EQ(log->samples().size(), 5u);
    EXPECT_EQ(log->samples()[0].time.microseconds, 1);
    EXPECT_EQ(log->samples()[0].received.microseconds, 10'000'001);
    const auto pings = getSamples<types::Sonar>(*log, "sonar.ping");
    for (int64_t i = 1; i <= 3; ++i) expectSame(pings.at(static_cast<size_t>(i - 1)), smallPing(i));
    const auto poses = getSamples<types::Pose>(*log, "vehicle.pose");
    EXPECT_EQ(poses.at(1).time.microseconds, 2);
    EXPECT_EQ(poses[1].position, smallPose(2).position);
    EXPECT_EQ(poses[1].orientation, smallPose(2).orientation);
    EXPECT_EQ(poses[1].target_frame, "world");
    EXPECT_TRUE(std::isnan(poses[1].velocity.x));
}

TEST(SampleWriterTest, ByDefaultPingsKeepTheirBinsAndPosesAreEastNorthUp) {
    const Folder folder;
    smallFile(folder / "x.mcap", {});
    const auto log = openLog(folder / "x.mcap");
    expectSame(getSamples<types::Sonar>(*log, "sonar.ping").at(0), smallPing(1));
    const types::Pose pose = getSamples<types::Pose>(*log, "vehicle.pose").at(0);
    EXPECT_EQ(pose.position, smallPose(1).position);
    EXPECT_NEAR(std::abs(glm::dot(pose.orientation, smallPose(1).orientation)), 1, 1e-15);
    EXPECT_EQ(ros::MessageOptions().world_frame, ros::WorldFrame::Enu);
    EXPECT_EQ(McapConfig().dtype, ros::ImageType::Float32);
}

/** Returns the messages of a stream, in order. */
template <class Message>
std::vector<Message> getMessages(log::Reader& log, const std::string& stream) {
    std::vector<Message> messages;
    log.forEachRef(stream, [&](const SampleRef& at) { ros::decode(log.toBytes(at), messages.emplace_back()); });
    return messages;
}

TEST(SampleWriterTest, FramesThatTfRefusesAreRefused) {
    McapConfig config;
    config.frame_id = "/sonar";
    config.streams = {{"sonar.ping", {{}, "my sonar", {}}}, {"vehicle.pose", {{}, {}, ""}}};
    EXPECT_THAT(test::countRefusals(config),
                testing::ElementsAre(testing::HasSubstr("frame_id: is \"/sonar\"; must be a name without spaces"),
                                     testing::HasSubstr("streams.sonar.ping.frame_id: is \"my sonar\""),
                                     testing::HasSubstr("streams.vehicle.pose.child_frame_id: is \"\"")));
}

TEST(SampleWriterTest, AStreamMayHaveItsOwnTopicFramesAndFrequency) {
    const Folder folder;
    McapConfig config;
    config.streams = {{"sonar.ping", {"/auv/sonar", "sonar_link", {}}}, {"vehicle.pose", {"auv/pose", "odom", "auv"}}};
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
    {
        SampleWriter log(folder / "x.mcap", config);
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", {{"insonify_frequency_khz", "750"}});
        const size_t pose = log.addStream<types::Pose>("vehicle.pose");
        const size_t other = log.addStream<types::Sonar>("/other/sonar.ping");
        log.write(ping, {2}, smallPing(1));
        log.write(pose, {2}, smallPose(1));
        log.write(other, {2}, smallPing(1));
    }
    const Reader log(folder / "x.mcap");
    EXPECT_EQ(log.channel(0).topic, "/auv/sonar");
    EXPECT_EQ(log.channel(1).topic, "/auv/pose");
    EXPECT_EQ(log.channel(2).topic, "/other/sonar/ping");
    EXPECT_EQ(log.streams()[2].name, "/other/sonar.ping");
    const auto open = openLog(folder / "x.mcap");
    const auto ping = getMessages<ros::ProjectedSonarImage>(*open, "sonar.ping").at(0);
    EXPECT_EQ(ping.header.frame_id, "sonar_link");
    EXPECT_EQ(ping.ping_info.frequency, 750e3f);
    const auto pose = getMessages<ros::Odometry>(*open, "vehicle.pose").at(0);
    EXPECT_EQ(pose.header.frame_id, "odom");
    EXPECT_EQ(pose.child_frame_id, "auv");
    EXPECT_EQ(getMessages<ros::ProjectedSonarImage>(*open, "/other/sonar.ping").at(0).ping_info.frequency, 0);
}

TEST(SampleWriterTest, NamespaceAndFramePrefixApplyToTopicsAndFrames) {
    const Folder folder;
    McapConfig config;
    config.names.setNamespace("auv1");
    config.names.setFramePrefix("auv1");
    config.streams = {{"a.ping", {"near", "link", {}}}, {"b.ping", {"/far", {}, {}}}, {"b.pose", {{}, "odom", {}}}};
    {
        SampleWriter log(folder / "x.mcap", config);
        for (const char* stream : {"a.ping", "b.ping"})
            log.write(log.addStream<types::Sonar>(stream), {2}, smallPing(1));
        for (const char* stream : {"a.pose", "b.pose"})
            log.write(log.addStream<types::Pose>(stream), {2}, smallPose(1));
    }
    const Reader raw(folder / "x.mcap");
    EXPECT_EQ(raw.channel(0).topic, "/auv1/near");
    EXPECT_EQ(raw.channel(1).topic, "/far");
    EXPECT_EQ(raw.channel(2).topic, "/auv1/a/pose");
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(getMessages<ros::ProjectedSonarImage>(*log, "a.ping").at(0).header.frame_id, "auv1/link");
    EXPECT_EQ(getMessages<ros::ProjectedSonarImage>(*log, "b.ping").at(0).header.frame_id, "auv1/sonar");
    const auto pose = getMessages<ros::Odometry>(*log, "a.pose").at(0);
    EXPECT_EQ(pose.header.frame_id, "world");
    EXPECT_EQ(pose.child_frame_id, "auv1/body");
    EXPECT_EQ(getMessages<ros::Odometry>(*log, "b.pose").at(0).header.frame_id, "odom");
}

TEST(SampleWriterTest, ReadsAFrequencyInAnyLocale) {
    const test::CommaLocale german;
    if (!german.isThere()) GTEST_SKIP() << german.why();
    const Folder folder;
    {
        SampleWriter log(folder / "x.mcap", {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", {{"insonify_frequency_khz", "0.5"}});
        log.write(ping, {2}, smallPing(1));
    }
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(getMessages<ros::ProjectedSonarImage>(*log, "sonar.ping").at(0).ping_info.frequency, 500);
}

TEST(SampleWriterTest, AStreamIsFoundByItsConfiguredTopic) {
    const Folder folder;
    McapConfig config;
    config.streams["receiver.ping"].topic = "/auv/sonar";
    {
        SampleWriter log(folder / "x.mcap", config);
        const size_t given = log.addStream<types::Sonar>("receiver.ping");
        log.addStream<types::Sonar>("sonar.ping");
        log.write(given, {2}, smallPing(1));
    }
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(log->findIndex("/auv/sonar"), 0u);
    EXPECT_EQ(log->findIndex("receiver.ping"), 0u);
    EXPECT_EQ(log->findIndex("/sonar/ping"), 1u);
    EXPECT_FALSE(log->find("/auv/pose"));
    EXPECT_EQ(getSamples<types::Sonar>(*log, "/auv/sonar").size(), 1u);
}

TEST(SampleWriterTest, TwoStreamsOnOneTopicAreRefused) {
    const Folder folder;
    McapConfig config;
    config.streams["receiver.ping"].topic = "/sonar/ping";
    SampleWriter log(folder / "x.mcap", config);
    log.addStream<types::Sonar>("receiver.ping");
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { log.addStream<types::Sonar>("sonar.ping"); }),
                testing::HasSubstr("sonar.ping: its topic /sonar/ping belongs to another stream"));
}

TEST(SampleWriterTest, ReportsInvalidAndDuplicateTopics) {
    McapConfig config;
    config.streams["a.ping"].topic = "/auv/1sonar";
    config.streams["b.ping"].topic = "/auv/sonar";
    config.streams["c.ping"].topic = "auv/sonar";
    EXPECT_THAT(test::countRefusals(config),
                testing::ElementsAre(testing::StartsWith("streams.a.ping.topic: "),
                                     "streams.c.ping.topic: is /auv/sonar, the topic of b.ping; must be another"));
}

TEST(SampleWriterTest, NanosecondsOfAReadStampAreKept) {
    const Folder folder;
    ros::fineStamps().note({7, 123'456'789});
    {
        SampleWriter log(folder / "x.mcap", {});
        log.write(log.addStream<types::Sonar>("sonar.ping"), {9'000'000}, smallPing(7'123'456));
    }
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(getMessages<ros::ProjectedSonarImage>(*log, "sonar.ping").at(0).header.stamp,
              (ros::Time{7, 123'456'789}));
    const Reader raw(folder / "x.mcap");
    EXPECT_EQ(raw.message(raw.samples().at(0)).publish_ns, 7'123'456'789u);
}

TEST(SampleWriterTest, AStreamIsFoundByItsTopic) {
    const Folder folder;
    smallFile(folder / "x.mcap");
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(log->find("/sonar/ping"), log->find("sonar.ping"));
    EXPECT_EQ(log->find("/sonar/pong"), nullptr);
    EXPECT_EQ(copyLog({folder / "x.mcap"}, folder / "y.0.log", {.selection = {.streams = {"/sonar/ping"}}}).samples,
              3u);
}

TEST(SampleWriterTest, ReadsOtherOrdersAndAxesAsWritten) {
    const Folder folder;
    McapConfig config;
    config.order = ros::ImageOrder::BeamMajor;
    config.frame = ros::SensorFrame::XForward;
    config.world_frame = ros::WorldFrame::Ned;
    smallFile(folder / "x.mcap", config);
    const auto log = openLog(folder / "x.mcap");
    expectSame(getSamples<types::Sonar>(*log, "sonar.ping").at(0), smallPing(1));
    EXPECT_EQ(getSamples<types::Pose>(*log, "vehicle.pose").at(0).orientation, smallPose(1).orientation);
}

TEST(SampleWriterTest, EveryTypeOfALogHasItsMessage) {
    const Folder folder;
    {
        SampleWriter log(folder / "x.mcap", {});
        const auto add = [&]<class T>(const std::string& name, const T& sample) {
            log.write(log.addStream<T>(name, {}), {5}, sample);
        };
        add("a.double", 0.25);
        add("a.float", 0.5f);
        add("a.int", int32_t{-3});
        add("a.long", int64_t{-4});
        add("a.bool", true);
        add("a.text", std::string("word"));
        add("a.angle", types::Angle{0.75});
        add("a.time", types::Time{1'500'000});
        types::Image image;
        image.time = {4};
        image.size = {2, 1};
        image.pixel_size = 3;
        image.row_size = 6;
        image.frame_mode = types::ImageMode::Bgr;
        image.image = {1, 2, 3, 4, 5, 6};
        add("a.image", image);
        types::SonarBeam beam;
        beam.time = {4};
        beam.bearing = {0.1};
        beam.sampling_interval = 1e-4;
        beam.speed_of_sound = 1500;
        beam.beam = {0, 255};
        add("a.beam", beam);
    }
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(getSamples<double>(*log, "a.double"), std::vector{0.25});
    EXPECT_EQ(getSamples<float>(*log, "a.float"), std::vector{0.5f});
    EXPECT_EQ(getSamples<int32_t>(*log, "a.int"), std::vector{-3});
    EXPECT_EQ(getSamples<int64_t>(*log, "a.long"), std::vector{int64_t{-4}});
    EXPECT_EQ(getSamples<bool>(*log, "a.bool"), std::vector{true});
    EXPECT_EQ(getSamples<std::string>(*log, "a.text"), std::vector<std::string>{"word"});
    EXPECT_EQ(getSamples<types::Angle>(*log, "a.angle").at(0).rad, 0.75);
    EXPECT_EQ(getSamples<types::Time>(*log, "a.time").at(0).microseconds, 1'500'000);
    EXPECT_EQ(getSamples<types::Image>(*log, "a.image").at(0).image, (std::vector<uint8_t>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(getSamples<types::Sonar>(*log, "a.beam").at(0).bins, (std::vector<float>{0, 1}));
    EXPECT_FALSE(check(folder / "x.mcap").diagnostic);
}

TEST(SampleWriterTest, ASampleWithoutAMessageIsAnError) {
    const Folder folder;
    SampleWriter log(folder / "x.mcap", {});
    const size_t stream = log.addStream<types::Image>("fan.image", {});
    types::Image jpeg;
    jpeg.frame_mode = types::ImageMode{258};
    EXPECT_THAT(test::computeError<std::runtime_error>([&] { log.write(stream, {1}, jpeg); }),
                testing::EndsWith("x.mcap: a sample of fan.image cannot be written as a message: a picture of mode 258 "
                                  "with 0 bytes a pixel is not known: mono8, mono16, rgb8 and bgr8 are"));
}

TEST(SampleWriterTest, ALogOfSeveralFilesIsOneBagAndEachFileIsReadableAlone) {
    const Folder folder;
    {
        SampleWriter log(folder / "x.0.mcap", {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", {{"insonify_seed", "7"}});
        log.write(ping, {1'000'001}, smallPing(1));
        log.next(folder / "x.1.mcap");
        log.write(ping, {3'000'000}, smallPing(2));
        log.write(ping, {2'000'000}, smallPing(3));
        EXPECT_EQ(log.kept(), 1u);
    }
    for (const auto& [file, count] : {std::pair{"x.0.mcap", 1u}, std::pair{"x.1.mcap", 2u}}) {
        EXPECT_FALSE(check(folder / file).diagnostic) << file;
        const auto log = openLog(folder / file);
        EXPECT_EQ(log->samples().size(), count);
        EXPECT_EQ(log->streams().at(0).metadata.at("insonify_seed"), "7");
    }
    const std::vector<char> bytes = toBytes(folder / "metadata.yaml");
    const std::string bag(bytes.begin(), bytes.end());
    EXPECT_THAT(bag, testing::HasSubstr("    - \"x.0.mcap\"\n    - \"x.1.mcap\"\n"));
    EXPECT_THAT(bag, testing::HasSubstr("  duration:\n    nanoseconds: 1999999000\n"));
    EXPECT_THAT(bag, testing::HasSubstr("nanoseconds_since_epoch: 1000001000\n  message_count: 6\n"));
    EXPECT_THAT(bag, testing::HasSubstr("name: \"/sonar/ping\"\n        type: marine_acoustic_msgs/msg/"));
}

TEST(SampleWriterTest, EachFileHasTheStreamsMetadataAndTheDeploymentOnce) {
    const Folder folder, other;
    const Metadata first = {{"insonify_deployment", "tasks: {}"}, {"insonify_seed", "7"}, {"rock_task_model", "a::T"}},
                   second = {{"insonify_seed", "7"}, {"own", "x"}};
    {
        SampleWriter log(folder / "x.0.mcap", {});
        log.write(log.addStream<types::Sonar>("a.ping", first), {1}, smallPing(1));
        log.write(log.addStream<types::Sonar>("b.ping", second), {1}, smallPing(1));
        log.next(folder / "x.1.mcap");
        log.flush();
    }
    copyLog({folder / "x.0.mcap"}, other / "y.0.mcap");
    for (const auto& file : {folder / "x.0.mcap", folder / "x.1.mcap", other / "y.0.mcap"}) {
        const auto log = openLog(file);
        ASSERT_EQ(log->streams().size(), 2u) << file;
        EXPECT_EQ(log->streams()[0].metadata, first) << file;
        EXPECT_EQ(log->streams()[1].metadata, second) << file;
    }
}

TEST(SampleWriterTest, TheMetadataOfAnotherBagIsNotOverwritten) {
    const Folder folder;
    smallFile(folder / "x.0.mcap");
    smallFile(folder / "x.0.mcap");  // the same file again
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { smallFile(folder / "y.0.mcap"); }),
                testing::HasSubstr("describes another bag, of \"x.0.mcap\"; give \"y.0.mcap\" a "
                                   "folder of its own, as in bag/y.0.mcap"));
}

TEST(SampleWriterTest, MoreThanAChunkIsReadBack) {
    const Folder folder;
    const std::string text(1 << 20, 'x');
    {
        SampleWriter log(folder / "x.mcap", {});
        const size_t stream = log.addStream<std::string>("a.text", {});
        for (int64_t i = 0; i < 10; ++i) log.write(stream, {i}, text);
        EXPECT_GT(log.kept(), 3u);
    }
    const auto log = openLog(folder / "x.mcap");
    EXPECT_EQ(getSamples<std::string>(*log, "a.text"), std::vector(10, text));
    EXPECT_FALSE(check(folder / "x.mcap").diagnostic);
}

TEST(SampleWriterTest, ReportsAFullDisk) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.mcap");
    SampleWriter log(folder / "x.mcap", {});
    log.write(log.addStream<std::string>("a.text", {}), {1}, std::string("x"));
    EXPECT_THROW(log.flush(), std::runtime_error);
}

}  // namespace
}  // namespace insonify::log::mcap
