// /tf, /tf_static and /clock of MCAP files.
#include <gmock/gmock.h>

#include "components/log/mcap/Contents.hpp"
#include "components/ros/Cdr.hpp"
#include "tests/log/mcap/SmallFile.hpp"

namespace insonify::log::mcap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const Metadata with_mount = {
    {"insonify_mount", R"({"position": [1, 2, 3], "roll_deg": 0, "pitch_deg": 0, "yaw_deg": 90})"},
    {"insonify_body", "vehicle.pose"}};

/** Returns the messages of a topic in a file, which need not be a stream. */
template <class Message>
std::vector<Message> messagesOn(const std::filesystem::path& path, const std::string& topic) {
    File file(path);
    const Contents contents = file.contents();
    std::vector<Message> messages;
    std::vector<char> bytes;
    for (const MessageRef& at : contents.messages) {
        if (contents.channels.at(at.channel).topic != topic) continue;
        file.read(at, bytes);
        ros::decode(std::span<const char>(bytes), messages.emplace_back());
    }
    return messages;
}

std::vector<ros::TransformStamped> transformsOn(const std::filesystem::path& path, const std::string& topic) {
    std::vector<ros::TransformStamped> all;
    for (const auto& message : messagesOn<ros::TFMessage>(path, topic))
        all.insert(all.end(), message.transforms.begin(), message.transforms.end());
    return all;
}

std::vector<std::string> childrenOn(const std::filesystem::path& path, const std::string& topic) {
    std::vector<std::string> names;
    for (const auto& each : transformsOn(path, topic))
        names.push_back(each.header.frame_id + " " + each.child_frame_id);
    return names;
}

types::Pose getPose(int64_t time, const std::string& body, const std::string& world = "world") {
    types::Pose pose = smallPose(time);
    pose.source_frame = body;
    pose.target_frame = world;
    return pose;
}

struct TransformsTest : testing::Test {
    const Folder folder;
    const std::filesystem::path path = folder / "x.0.mcap";
};

TEST_F(TransformsTest, AreNeitherSamplesNorStreams) {
    {
        SampleWriter log(path, {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", with_mount);
        log.write(ping, {1}, smallPing(1));
        const size_t pose = log.addStream<types::Pose>("vehicle.pose");
        log.write(pose, {1}, smallPose(1));
        const size_t late = log.addStream<double>("late.number", {{"own", "x"}});
        log.write(late, {2}, 2.5);
        log.flush();
        EXPECT_EQ(log.kept(), 3u);
    }
    EXPECT_THAT(childrenOn(path, "/tf"), ElementsAre("world body"));
    EXPECT_THAT(childrenOn(path, "/tf_static"), ElementsAre("body sonar"));
    EXPECT_EQ(messagesOn<ros::Clock>(path, "/clock").size(), 1u) << "of one time";
    EXPECT_FALSE(check(path).diagnostic);
    EXPECT_EQ(check(path).samples, 3u);
    const auto log = openLog(path);
    ASSERT_EQ(log->streams().size(), 3u);
    EXPECT_EQ(log->streams()[2].name, "late.number");
    EXPECT_EQ(log->streams()[2].metadata, (Metadata{{"own", "x"}}));
    std::vector<double> numbers;
    log->forEach<double>("late.number", [&](double number, const SampleRef&) { numbers.push_back(number); });
    EXPECT_THAT(numbers, ElementsAre(2.5))
        << "each sample belongs to its stream, also after topics that are not streams";
    EXPECT_EQ(log->find("/tf"), nullptr);
}

TEST_F(TransformsTest, LaterMetadataBelongsToItsStreams) {
    {
        SampleWriter log(path, {});
        log.write(log.addStream<types::Pose>("vehicle.pose"), {1}, smallPose(1));
        log.write(log.addStream<types::Sonar>("sonar.ping", {{"own", "x"}}), {2}, smallPing(2));
    }
    const auto log = openLog(path);
    EXPECT_EQ(log->streams().at(1).metadata, (Metadata{{"own", "x"}}));
}

TEST_F(TransformsTest, AreNotWrittenIfSwitchedOff) {
    McapConfig config;
    config.transforms = false;
    smallFile(path, config);
    File file(path);
    EXPECT_EQ(file.contents().channels.size(), 2u);
    std::filesystem::create_directory(folder / "copy");
    copyLog({path}, folder / "copy/y.0.mcap");
    File copy(folder / "copy/y.0.mcap");
    EXPECT_EQ(copy.contents().channels.size(), 2u) << "a cut has the same as its log";
}

TEST_F(TransformsTest, AFramePrefixAppliesToABodyWithoutAName) {
    McapConfig config;
    ASSERT_TRUE(config.names.setFramePrefix("auv1"));
    {
        SampleWriter log(path, config);
        log.write(log.addStream<types::Pose>("vehicle.pose"), {1}, getPose(1, "", ""));
    }
    EXPECT_THAT(childrenOn(path, "/tf"), ElementsAre("map auv1/base_link"));
}

TEST_F(TransformsTest, AStreamKeepsItsTopic) {
    McapConfig config;
    config.streams["vehicle.pose"].topic = "/tf";
    smallFile(path, config);
    EXPECT_THAT(messagesOn<ros::Odometry>(path, "/tf").size(), 2u);
    EXPECT_EQ(messagesOn<ros::Clock>(path, "/clock").size(), 3u);
    EXPECT_EQ(openLog(path)->find("/tf")->name, "vehicle.pose");
}

TEST_F(TransformsTest, AFrameHasOneParentAndOnlyValidPoses) {
    {
        SampleWriter log(path, {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", with_mount),
                     other = log.addStream<types::Sonar>("other.ping", {{"insonify_mount", "{broken"}}),
                     truth = log.addStream<types::Pose>("truth.pose"),
                     pose = log.addStream<types::Pose>("vehicle.pose"),
                     unnamed = log.addStream<types::Pose>("unnamed.pose"),
                     third = log.addStream<types::Pose>("third.pose");
        log.write(ping, {1}, smallPing(1));
        log.write(other, {1}, smallPing(1));
        log.write(truth, {1}, getPose(1, "truth"));
        types::Pose lost = getPose(1, "body");
        lost.position.x = types::Pose::unknown;
        log.write(pose, {1}, lost);
        lost = getPose(2, "body");
        lost.orientation = {0, 0, 0, 0};
        log.write(pose, {2}, lost);
        log.write(third, {2}, getPose(2, "world", "world"));
        log.write(pose, {3}, getPose(3, "body"));
        log.write(pose, {4}, getPose(3, "body"));
        log.write(third, {4}, getPose(4, "body"));
        log.write(third, {4}, getPose(4, "sonar"));
        log.write(unnamed, {5}, getPose(5, "", ""));
    }
    EXPECT_THAT(childrenOn(path, "/tf"), ElementsAre("world truth", "world body", "map base_link"));
    EXPECT_THAT(childrenOn(path, "/tf_static"), ElementsAre("body sonar")) << "for the body in the pings";
    const auto mount = transformsOn(path, "/tf_static").at(0).transform;
    EXPECT_EQ(mount.translation, (ros::Vector3{1, 2, 3}));
}

TEST_F(TransformsTest, APoseOfTheSonarItselfHasTheAxesOfItsPings) {
    {
        SampleWriter log(path, {});
        log.addStream<types::Sonar>("sonar.ping", with_mount);
        const size_t pose = log.addStream<types::Pose>("sonar.pose"), body = log.addStream<types::Pose>("vehicle.pose");
        types::Pose ahead = getPose(1, "sonar");
        ahead.orientation = {1, 0, 0, 0};
        log.write(pose, {1}, ahead);
        log.write(body, {1}, getPose(1, "body"));
    }
    EXPECT_THAT(childrenOn(path, "/tf"), ElementsAre("world sonar", "world body"));
    EXPECT_THAT(childrenOn(path, "/tf_static"), IsEmpty()) << "a frame has one parent";
    const auto q = transformsOn(path, "/tf").at(0).transform.rotation;
    const glm::dvec3 z = glm::dquat(q.w, q.x, q.y, q.z) * glm::dvec3(0, 0, 1),
                     x = glm::dquat(q.w, q.x, q.y, q.z) * glm::dvec3(1, 0, 0);
    EXPECT_NEAR(z.y, 1, 1e-12) << "ahead is north, which is y of ENU";
    EXPECT_NEAR(x.z, 1, 1e-12) << "x is up";
}

TEST_F(TransformsTest, MountsAreInEachFileOfALogAndWithoutPosesBelowBaseLink) {
    {
        SampleWriter log(path, {});
        const size_t ping = log.addStream<types::Sonar>("sonar.ping", with_mount);
        log.write(ping, {1'000}, smallPing(1));
        log.write(ping, {2'000}, smallPing(2));
        log.next(folder / "x.1.mcap");
        log.write(ping, {3'000}, smallPing(3));
    }
    EXPECT_THAT(childrenOn(path, "/tf_static"), ElementsAre("base_link sonar"));
    EXPECT_THAT(childrenOn(folder / "x.1.mcap", "/tf_static"), ElementsAre("base_link sonar"));
    EXPECT_THAT(childrenOn(path, "/tf"), IsEmpty());
    for (const char* name : {"x.0.mcap", "x.1.mcap"}) EXPECT_FALSE(check(folder / name).diagnostic) << name;
    File file(path);
    uint64_t first = UINT64_MAX, mounts = 0;
    const Contents contents = file.contents();
    for (const MessageRef& at : contents.messages) {
        first = std::min(first, at.log_ns);
        if (contents.channels.at(at.channel).topic == "/tf_static") mounts = at.log_ns;
    }
    EXPECT_EQ(mounts, first) << "available from the start";
}

}  // namespace
}  // namespace insonify::log::mcap
