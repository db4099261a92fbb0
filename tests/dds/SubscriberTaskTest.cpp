#include <gmock/gmock.h>

#include <thread>

#include "components/dds/SubscriberTask.hpp"
#include "tests/dds/Ends.hpp"
#include "tests/support/Refused.hpp"

using namespace insonify;
using namespace insonify::dds;

namespace {

class SubscriberTaskTest : public Loopback {};

types::Pose somewhere(double x) {
    types::Pose pose;
    pose.time = framework::wallClock();
    pose.position = {x, 2, -3};
    pose.orientation = glm::normalize(glm::dquat(0.9, 0.1, -0.2, 0.3));
    pose.velocity = {0.5, 0.25, -0.125};
    pose.angular_velocity = {0.01, 0.02, 0.03};
    return pose;
}

/** Sends until both have found each other. */
void meet(Publishing<types::Pose>& publishing, Subscribing& subscribing, const types::Pose& pose) {
    types::Pose came;
    ASSERT_TRUE(becomesTrue([&] { return publishing.send(pose), subscribing.reader.port.readNew(came); }));
    subscribing.reader.port.clear();
}

}  // namespace

TEST_F(SubscriberTaskTest, APoseReturnsUnchangedInAnyFrame) {
    for (const auto frame : {ros::WorldFrame::AsIs, ros::WorldFrame::Enu, ros::WorldFrame::Ned})
        for (const auto& [type, message] :
             {std::pair(PoseType::Odometry, message_type<ros::Odometry>),
              std::pair(PoseType::PoseStamped, message_type<ros::PoseStamped>),
              std::pair(PoseType::PoseWithCovarianceStamped, message_type<ros::PoseWithCovarianceStamped>)}) {
            const bool whole = type == PoseType::Odometry;
            Publishing<types::Pose> publishing({topicOut("in", "/there", message)},
                                               [&](PublisherConfig& config) { config.node.world_frame = frame; });
            Subscribing subscribing("/there", type, [&](SubscriberConfig& config) { config.node.world_frame = frame; });
            const types::Pose sent = somewhere(1);
            publishing.send(sent);
            std::optional<types::Pose> came;
            ASSERT_TRUE(becomesTrue([&] {
                publishing.send(sent);
                came.emplace();
                return subscribing.reader.port.readNew(*came);
            }));
            EXPECT_EQ(came->time, sent.time);
            EXPECT_LT(glm::distance(came->position, sent.position), 1e-12);
            EXPECT_GT(std::abs(glm::dot(came->orientation, sent.orientation)), 1 - 1e-12);
            EXPECT_EQ(came->target_frame, "map");
            if (!whole) continue;
            EXPECT_LT(glm::distance(came->velocity, sent.velocity), 1e-12);
            EXPECT_LT(glm::distance(came->angular_velocity, sent.angular_velocity), 1e-12);
            EXPECT_EQ(came->source_frame, "base_link");
        }
}

TEST_F(SubscriberTaskTest, AMessageWakesTheTaskAtOnce) {
    Publishing<types::Pose> publishing({topicOut("in", "/there", message_type<ros::Odometry>)});
    Subscribing subscribing("/there");
    meet(publishing, subscribing, somewhere(0));
    for (int i = 1; i <= 50; ++i) {
        publishing.send(somewhere(i));
        auto pose = subscribing.next();
        while (pose && pose->position.x == 0) pose = subscribing.next();  // from the discovery
        ASSERT_TRUE(pose);
        EXPECT_EQ(pose->position.x, i);
    }
}

TEST_F(SubscriberTaskTest, WithADepthOfOneTheNewestPoseWins) {
    Publishing<types::Pose> publishing({topicOut("in", "/there", message_type<ros::Odometry>)});
    Subscribing newest("/there"), all("/there", PoseType::Odometry, [](SubscriberConfig&config) { config.depth = 5; });
    meet(publishing, newest, somewhere(0));
    meet(publishing, all, somewhere(0));
    newest.task.activity().hold();
    all.task.activity().hold();
    newest.task.update();
    all.task.update();
    newest.reader.port.clear();
    all.reader.port.clear();
    for (int i = 1; i <= 5; ++i) publishing.send(somewhere(i));
    newest.task.update();
    all.task.update();
    types::Pose pose;
    ASSERT_TRUE(newest.reader.port.readNew(pose));
    EXPECT_EQ(pose.position.x, 5);
    EXPECT_FALSE(newest.reader.port.readNew(pose));
    for (int i = 1; i <= 5; ++i) {
        ASSERT_TRUE(all.reader.port.readNew(pose));
        EXPECT_EQ(pose.position.x, i);
    }
}

TEST_F(SubscriberTaskTest, InvalidMessagesDoNotDisplaceAGoodPose) {
    Publishing<types::Pose> publishing({topicOut("in", "/there", message_type<ros::Odometry>)});
    Subscribing subscribing("/there");
    meet(publishing, subscribing, somewhere(0));
    subscribing.task.activity().hold();
    subscribing.task.update();
    subscribing.reader.port.clear();
    publishing.send(somewhere(7));
    types::Pose lost = somewhere(8);
    lost.position.x = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 50; ++i) publishing.send(lost);
    types::Pose pose;
    ASSERT_TRUE(becomesTrue([&] { return subscribing.task.update(), subscribing.reader.port.readNew(pose); }));
    EXPECT_EQ(pose.position.x, 7);
}

TEST_F(SubscriberTaskTest, RefusesLockstepWithAReason) {
    SubscriberTask task("subscriber");
    task.environment().lockstep = true;
    EXPECT_THAT(test::countRefusals(task), testing::Contains(testing::HasSubstr("set schedule: realtime")));
}

/** Returns each topic's report of the absence of poses. */
TEST_F(SubscriberTaskTest, ReportsATopicWithoutAPoseTogetherWithTheDomainsTopics) {
    const auto absence = [](const std::string& topic, PoseType type, Reliability reliability) {
        Node node(domainId({}), "asking", 16);
        SubscriberConfig config;
        config.reliability = reliability;
        TopicIn in;
        in.topic = topic;
        in.type = type;
        Counts counts;
        const Subscription subscription(node, config, in, counts, {});
        std::string text;
        becomesTrue([&] {
            text = subscription.absence(node);
            return node.published().size() >= 2 && text.find("none of whose") == text.npos;
        });
        return text;
    };
    Publishing<types::Pose> publishing({topicOut("in", "/auv2/odometry", message_type<ros::Odometry>),
                                        topicOut("in", "/auv2/depth", message_type<ros::PoseStamped>)});
    EXPECT_THAT(absence("/auv/odometry", PoseType::Odometry, Reliability::BestEffort),
                testing::AllOf(testing::HasSubstr("nobody publishes /auv/odometry (nav_msgs/Odometry, domain "),
                               testing::HasSubstr("there are /auv2/odometry (nav_msgs/Odometry)"),
                               testing::Not(testing::HasSubstr("depth"))));
    EXPECT_THAT(absence("/auv2/depth", PoseType::Odometry, Reliability::BestEffort),
                testing::HasSubstr("is published as geometry_msgs/PoseStamped; set `type`"));
    EXPECT_THAT(absence("/auv2/odometry", PoseType::Odometry, Reliability::BestEffort),
                testing::HasSubstr("has 1 publishers, which send nothing that can be used"));
}

TEST_F(SubscriberTaskTest, WarnsOnceOfTheAbsenceOfAPose) {
    std::vector<std::string> warnings;
    Subscribing subscribing("/nowhere");
    subscribing.task.activity().hold();
    types::Time later = framework::wallClock();
    subscribing.task.environment().now = [&] { return later; };
    subscribing.task.environment().warn = [&](const std::string& text) { warnings.push_back(text); };
    ASSERT_TRUE(subscribing.task.stop());
    ASSERT_TRUE(subscribing.task.start());
    for (int second = 0; second < 8; ++second) {
        subscribing.task.update();
        later = later + types::Time::fromSeconds(1);
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], testing::HasSubstr("subscriber.pose: no pose yet: nobody publishes /nowhere"));
}

/** A live publisher whose clock is set by ten minutes, back and forward. Stamps ahead of our clock are refused. */
TEST_F(SubscriberTaskTest, PosesGoOnWhenThePublishersClockIsSetByTenMinutes) {
    Publishing<types::Pose> publishing({topicOut("in", "/stepping", message_type<ros::Odometry>)});
    Subscribing subscribing("/stepping", PoseType::Odometry);
    meet(publishing, subscribing, somewhere(0));
    double x = 0;
    /** Returns how long it took until a pose of a clock that is set by `step` came [s]; 3 s: none came. */
    const auto untilOneComes = [&](double step) {
        const types::Time begin = framework::wallClock(), limit = types::Time::fromSeconds(3);
        x += 1;
        while (framework::wallClock() - begin < limit) {
            types::Pose sent = somewhere(x), came;
            sent.time = sent.time + types::Time::fromSeconds(step);
            publishing.send(sent);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            while (subscribing.reader.port.readNew(came))
                if (came.position.x == x) return (framework::wallClock() - begin).seconds();
        }
        return 3.0;
    };
    EXPECT_LT(untilOneComes(0), 1);
    EXPECT_LT(untilOneComes(-600), 2.5) << "set back: after a second of poses that may be late ones";
    EXPECT_LT(untilOneComes(0), 1) << "and right again";
    EXPECT_EQ(untilOneComes(600), 3) << "ahead of our clock: refused, with a warning";
    EXPECT_LT(untilOneComes(0), 1) << "the refused ones have left no trace";
}
