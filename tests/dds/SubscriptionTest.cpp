// Messages that a subscription refuses.
#include <gmock/gmock.h>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Subscription.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Stamps.hpp"
#include "tests/dds/Ends.hpp"

using namespace insonify;
using namespace insonify::dds;

namespace {

constexpr types::Time arrival{77'000'000};

struct SubscriptionTest : Loopback {
    Node node{domainId({}), "judge", 16};
    SubscriberConfig config = [] {
        SubscriberConfig made;
        made.depth = 100;
        made.reliability = Reliability::Reliable;
        made.node.world_frame = ros::WorldFrame::AsIs;
        return made;
    }();
    TopicIn topic = [] {
        TopicIn made;
        made.topic = "/judged";
        return made;
    }();
    Counts counts;
    types::ThrottledWarning& dropped = counts.drops;
    Subscription subscription{node, config, topic, counts, {}};
    std::optional<Writer> writer = newWriter();
    types::Pose pose;

    std::optional<Writer> newWriter() {
        std::optional<Writer> made(std::in_place, node, "rt/judged", ros::Odometry::type_name, "", Quality{});
        EXPECT_TRUE(becomesTrue([&] { return made->hasReaders(); }));
        return made;
    }
    void send(const ros::Odometry& message) {
        Bytes bytes;
        ros::encode(message, bytes);
        ASSERT_TRUE(writer->write(bytes));
    }
    bool take() { return subscription.take(arrival, pose); }
    static ros::Odometry at(int32_t second, double x) {
        ros::Odometry message;
        message.header.stamp = {second, 0};
        message.pose.pose.position.x = x;
        return message;
    }
    uint64_t drops() const { return dropped.count(); }
};

}  // namespace

TEST_F(SubscriptionTest, KeepsTheNanosecondsOfAStampForTheResultsOfThePose) {
    ros::Odometry message = at(1, 1);
    message.header.stamp = {1, 123'456'789};
    send(message);
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.time, types::Time{1'123'456});
    ros::ProjectedSonarImage image;
    image.header.stamp = ros::toRos(pose.time);
    ros::restoreStamps(image);
    EXPECT_EQ(image.header.stamp, message.header.stamp);
    EXPECT_EQ(ros::fineStamps().exact({1, 123'457'000}), (ros::Time{1, 123'457'000})) << "of another microsecond";
}

TEST_F(SubscriptionTest, ReturnsGoodPosesInOrder) {
    for (int i = 1; i < 4; ++i) send(at(i, i));
    for (int i = 1; i < 4; ++i) {
        ASSERT_TRUE(take());
        EXPECT_EQ(pose.position.x, i);
    }
    EXPECT_FALSE(take());
    EXPECT_EQ(drops(), 0u);
}

TEST_F(SubscriptionTest, DropsAndCountsBytesThatAreNotAMessage) {
    Bytes whole;
    ros::encode(at(1, 1), whole);
    for (const size_t size : {0u, 3u, 4u, 8u, 100u, unsigned(whole.size()) - 8}) {
        const Bytes cut(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
        writer->write(cut);
    }
    Bytes strange = whole;
    strange[1] = 9;  // an unsupported encoding
    writer->write(strange);
    writer->write(whole);
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.position.x, 1);
    EXPECT_GE(drops(), 6u);
    EXPECT_THAT(dropped.last(), testing::HasSubstr("/judged: not a message of its type: byte 0: encoding 9"));
}

TEST_F(SubscriptionTest, DropsPosesThatAreNotFinite) {
    ros::Odometry bad = at(1, std::numeric_limits<double>::quiet_NaN());
    send(bad);
    bad = at(1, std::numeric_limits<double>::infinity());
    send(bad);
    bad = at(1, 0);
    bad.pose.pose.orientation = {0, 0, 0, 0};
    send(bad);
    bad.pose.pose.orientation = {0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
    send(bad);
    send(at(2, 5));
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.position.x, 5);
    EXPECT_EQ(drops(), 4u);
    EXPECT_THAT(dropped.last(), testing::HasSubstr("not finite"));
}

TEST_F(SubscriptionTest, DropsStampsThatGoBackUntilTheirSenderIsGone) {
    send(at(10, 1));
    send(at(9, 2));
    send(at(10, 3));  // an equal stamp does not go back
    ASSERT_TRUE(take());
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.position.x, 3);
    EXPECT_FALSE(take());
    EXPECT_EQ(drops(), 1u);
    writer.reset();
    writer = newWriter();  // a restarted simulator
    send(at(1, 4));
    ASSERT_TRUE(becomesTrue([&] { return take(); }));
    EXPECT_EQ(pose.position.x, 4);
    EXPECT_EQ(drops(), 1u);
}

TEST_F(SubscriptionTest, AcceptsAClockThatWasSetBackAfterASecond) {
    const auto take_at = [&](double later) {
        return subscription.take(arrival + types::Time::fromSeconds(later), pose);
    };
    send(at(10, 1));
    send(at(2, 2));
    send(at(3, 3));
    send(at(4, 4));
    ASSERT_TRUE(take_at(0));
    EXPECT_FALSE(take_at(0.5));
    EXPECT_EQ(drops(), 3u);
    send(at(5, 5));
    send(at(6, 6));
    ASSERT_TRUE(take_at(1.5));
    EXPECT_EQ(pose.position.x, 5);
    ASSERT_TRUE(take_at(1.5));
    EXPECT_EQ(drops(), 3u);
}

TEST_F(SubscriptionTest, DropsAStampFarAheadOfTheClockAndBlocksNobody) {
    const auto clock = static_cast<int32_t>(arrival.seconds());
    send(at(clock + 1000, 1));
    send(at(clock, 2));
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.position.x, 2);
    EXPECT_EQ(drops(), 1u);
    EXPECT_THAT(dropped.last(), testing::HasSubstr("ahead of the clock"));
}

TEST_F(SubscriptionTest, DoesNotTakeAMessageFarTooLarge) {
    writer->write(Bytes(3 << 20, 'x'));
    writer->write(Bytes((64 << 10) + 4, 'x'));
    send(at(1, 1));
    ASSERT_TRUE(becomesTrue([&] { return take(); }));
    EXPECT_EQ(pose.position.x, 1);
    EXPECT_FALSE(take());
    EXPECT_EQ(drops(), 2u);
    EXPECT_THAT(dropped.last(), testing::HasSubstr("/judged: empty, or larger than any message of its type"));
}

TEST_F(SubscriptionTest, ReportsMoreMessagesAfterManyInvalidMessages) {
    for (int i = 0; i < 90; ++i) writer->write(Bytes(10, 'x'));
    send(at(1, 1));
    EXPECT_FALSE(take());
    EXPECT_TRUE(subscription.more());
    EXPECT_TRUE(take());
    EXPECT_EQ(drops(), 90u);
}

TEST_F(SubscriptionTest, CanStampAPoseWithItsArrival) {
    TopicIn strange = topic;
    strange.stamp = StampFrom::Arrival;
    Subscription other(node, config, strange, counts, {});
    send(at(1, 1));
    ASSERT_TRUE(becomesTrue([&] { return other.take(arrival, pose); }) || (send(at(2, 2)), other.take(arrival, pose)));
    EXPECT_EQ(pose.time, arrival);
}

TEST_F(SubscriptionTest, CountsDifferentInvalidMessagesAsOneReason) {
    const std::string nonsense(40, 'x');
    for (size_t size = 1; size < 40; ++size) {
        const Bytes bytes(nonsense.begin(), nonsense.begin() + static_cast<ptrdiff_t>(size));
        writer->write(bytes);
    }
    send(at(1, 1));
    ASSERT_TRUE(take());
    EXPECT_EQ(dropped.byReason().size(), 1u);
}

TEST_F(SubscriptionTest, StampsAMessageWithoutAStampWithItsArrival) {
    send(at(0, 1));
    ASSERT_TRUE(take());
    EXPECT_EQ(pose.time, arrival);
}

TEST_F(SubscriptionTest, NormalisesOrientations) {
    ros::Odometry message = at(1, 1);
    message.pose.pose.orientation = {0, 0, 3, 3};  // a quarter turn
    message.twist.twist.linear.x = 2;
    send(message);
    ASSERT_TRUE(take());
    EXPECT_DOUBLE_EQ(glm::length(pose.orientation), 1);
    EXPECT_NEAR(glm::distance(pose.velocity, glm::dvec3(0, 2, 0)), 0, 1e-12);
}
