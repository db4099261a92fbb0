// tf as sent by ROS 2 nodes: by PyPI's cyclonedds, and by writers of the test.
#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "components/dds/TransformTask.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"
#include "tests/support/Listening.hpp"
#include "tests/support/Refused.hpp"

using namespace insonify;
using namespace insonify::dds;
using testing::Contains;
using testing::HasSubstr;

namespace {

struct TransformTaskTest : Loopback, protected test::Listening<TransformTask> {
    TransformTaskTest() : Listening("tf") {}

    void startWith(std::vector<FrameOut> frames, const std::function<void(TransformConfig&)>& change = {}) {
        TransformConfig config;
        config.frames = std::move(frames);
        if (change) change(config);
        start(config, config.frames);
    }
};

/** A sender of transforms. */
struct Sender {
    explicit Sender(const std::string& topic = "/tf")
        : writer(node, ddsTopic(topic), ros::TFMessage::type_name, "", Quality{.transient_local = true}) {}
    void send(const std::vector<ros::TransformStamped>& transforms) {
        Bytes bytes;
        ros::encode(ros::TFMessage{transforms}, bytes);
        writer.write(bytes);
    }
    static ros::TransformStamped place(const std::string& parent, const std::string& child, double x) {
        return {{ros::toRos(framework::wallClock()), parent}, child, {{x, 0, 0}, {}}};
    }
    Node node{domainId({}), "sender", 16};
    Writer writer;
};

}  // namespace

TEST_F(TransformTaskTest, APeersChainOfMovingAndStaticLinksBecomesPoses) {
    if (!Peer::available()) GTEST_SKIP() << "PyPI's cyclonedds is not in " << python();
    startWith({{"pose", "base_link"}, {"arm", "arm"}});
    const Peer peer("transforms 2");
    types::Pose before;
    for (int i = 0; i < 20; ++i) {
        const auto pose = next(0), arm = next(1);
        ASSERT_TRUE(pose && arm) << i;
        EXPECT_NEAR(pose->position.y, -10, 1e-9) << "east is to starboard of north";
        EXPECT_NEAR(pose->position.z, -3, 1e-9);
        EXPECT_NEAR(arm->position.z, -2.5, 1e-9);
        EXPECT_LT(glm::distance(pose->orientation * glm::dvec3(1, 0, 0), {1, 0, 0}), 1e-9) << "it looks north";
        EXPECT_EQ(pose->source_frame, "base_link");
        EXPECT_EQ(pose->target_frame, "map");
        EXPECT_LE(pose->time, framework::wallClock());
        const double seconds = (pose->time - before.time).seconds();
        EXPECT_TRUE(i == 0 || std::abs((pose->position.x - before.position.x) / seconds - 2) < 1e-3);
        EXPECT_GT(pose->time, before.time);
        before = *pose;
    }
}

TEST_F(TransformTaskTest, ReportsTheLinkThatInterruptsAChain) {
    if (!Peer::available()) GTEST_SKIP() << "PyPI's cyclonedds is not in " << python();
    startWith({{"pose", "base_link"}});
    const Peer peer("transforms 2 0");
    EXPECT_TRUE(reports("missing: pose: no transforms lead from base_link to map, only to odom"));
    Sender sender;
    EXPECT_TRUE(becomesTrue([&] {
        sender.send({Sender::place("map", "odom", 5)});
        return readers[0].port.readNewest(*std::make_unique<types::Pose>()) == framework::FlowStatus::NewData;
    }));
    EXPECT_TRUE(reports("missing: pose: odom in map was not published for a second"));
}

TEST_F(TransformTaskTest, SendsAStaticChainTenTimesASecond) {
    startWith({{"pose", "pier"}});
    Sender sender("/tf_static");
    sender.send({Sender::place("map", "quay", 5), Sender::place("quay", "pier", 2)});
    const auto first = next(), second = next();
    ASSERT_TRUE(first && second);
    EXPECT_NEAR(first->position.y, -7, 1e-12);
    EXPECT_GE(second->time - first->time, types::Time{100'000});
}

TEST_F(TransformTaskTest, CountsRefusedTransformsAndContinues) {
    startWith({{"pose", "base_link"}},
              [](TransformConfig& config) { config.node.world_frame = ros::WorldFrame::AsIs; });
    Sender sender;
    auto lost = Sender::place("map", "other", 1);
    lost.transform.translation.x = std::numeric_limits<double>::quiet_NaN();
    std::optional<types::Pose> pose;
    EXPECT_TRUE(becomesTrue([&] {
        sender.writer.write(Bytes(10, 'x'));
        sender.send({lost, Sender::place("map", "base_link", 3)});
        types::Pose came;
        if (readers[0].port.readNew(came)) pose = came;
        return pose.has_value();
    }));
    EXPECT_EQ(pose.value_or(types::Pose{}).position, glm::dvec3(3, 0, 0));
    EXPECT_TRUE(reports("dropped: other: translation and rotation are not finite"));
    EXPECT_TRUE(reports("dropped: a message is not of its type"));
}

TEST_F(TransformTaskTest, CanStampTransformsWithTheirArrival) {
    startWith({{"pose", "base_link"}}, [](TransformConfig& config) { config.stamp = StampFrom::Arrival; });
    Sender sender;
    auto old = Sender::place("map", "base_link", 3);
    old.header.stamp = {5, 0};  // of a simulation's time
    std::optional<types::Pose> pose;
    const types::Time before = framework::wallClock();
    EXPECT_TRUE(becomesTrue([&] {
        sender.send({old});
        types::Pose came;
        if (readers[0].port.readNew(came)) pose = came;
        return pose.has_value();
    }));
    EXPECT_GE(pose.value_or(types::Pose{}).time, before);
}

TEST_F(TransformTaskTest, ReportsWrongPropertiesWithTheirPlace) {
    TransformTask other("other");
    TransformConfig config;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::StartsWith("frames: ")));
    config.frames = {{"a", "map"}, {"a", "base_link"}};
    config.topic = "a b";
    EXPECT_THAT(test::countRefusals(config),
                testing::ElementsAre(testing::StartsWith("topic: "), HasSubstr("is map, the world_frame_id itself"),
                                     HasSubstr("is a a second time")));
    other.config.set(config);
    other.environment().lockstep = true;
    EXPECT_THAT(test::countRefusals(other), testing::Contains(HasSubstr("set schedule: realtime")));
}
