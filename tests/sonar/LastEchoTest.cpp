// In realtime a ping is written no earlier than its last echo could arrive.
#include <gtest/gtest.h>

#include <thread>

#include "components/framework/execution/Activity.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::sonar {
namespace {

/** A sonar on its own thread, and the wall clock. */
struct LastEchoTest : ::testing::Test {
    void start(double range) {
        SonarConfig config = smallSonar();
        config.range = range;
        in_.port.connectTo(task_.snapshot, {});
        task_.ping.connectTo(out_.port, {});
        task_.config.set(config);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
        task_.activity().release();
    }
    /** Replaces the task's clock by a clock that the test sets. */
    void setClock(types::Time time) {
        clock_ = time.microseconds;
        task_.environment().now = [this] { return types::Time{clock_.load()}; };
        task_.environment().wall_clock = false;
    }
    /** Writes a snapshot of the current time plus a number of seconds; returns its stamp. */
    types::Time send(double ahead = 0) {
        types::Snapshot snapshot = facingWall(5);
        snapshot.time = task_.environment().now() + types::Time::fromSeconds(ahead);
        in_.port.write(std::make_shared<types::Snapshot>(snapshot));
        return snapshot.time;
    }
    /** Waits for the next ping. */
    types::SonarPtr receive() {
        types::SonarPtr ping;
        test::becomesTrue([&] { return out_.port.readNew(ping); });
        return ping;
    }

    SonarTask task_{"sonar"};
    test::Writer<types::SnapshotPtr> in_;
    test::Reader<types::SonarPtr> out_;
    std::atomic<int64_t> clock_{0};
};

TEST_F(LastEchoTest, APingIsWrittenAfterTheTwoWayTravelTimeToTheRange) {
    start(150);  // 0.2 s, longer than this picture takes
    for (int i = 0; i < 3; ++i) {
        const types::Time sent = send();
        const types::SonarPtr ping = receive();
        const types::Time received = framework::wallClock();
        ASSERT_TRUE(ping) << task_.lastError();
        EXPECT_EQ(ping->time, sent);
        EXPECT_GE((received - sent).seconds(), 2 * 150 / 1500.0);
    }
    task_.activity().hold();
    EXPECT_EQ(task_.timing().latency.count(), 3u);
    EXPECT_GE(task_.timing().latency.quantile(0), 0.198);  // within 1 %
}

TEST_F(LastEchoTest, AnOldPoseDoesNotShortenTheListening) {
    start(150);
    const types::Time taken = framework::wallClock(), sent = send(-0.5);
    const types::SonarPtr ping = receive();
    ASSERT_TRUE(ping) << task_.lastError();
    EXPECT_EQ(ping->time, sent);
    EXPECT_GE((framework::wallClock() - taken).seconds(), 2 * 150 / 1500.0);
}

TEST_F(LastEchoTest, PingsDoNotOverlapAndTheNewestSnapshotCounts) {
    setClock({10'000'000});
    start(150);
    const types::Time first_sent = send();
    ASSERT_TRUE(test::becomesTrue([&] { return !task_.snapshot.hasNew(); }));
    types::Time last;
    for (int i = 0; i < 10; ++i) {  // all while it listens
        clock_ += 10'000;
        last = send();
    }
    for (const auto& [sent, last_echo] : {std::pair(first_sent, 10'200'000), {last, 10'400'000}}) {
        types::SonarPtr ping;
        ASSERT_TRUE(test::becomesTrue([&] {
            clock_ += 1000;
            return out_.port.readNew(ping);
        }));
        EXPECT_EQ(ping->time, sent);
        EXPECT_GE(clock_, last_echo);
    }
}

TEST_F(LastEchoTest, ASonarIsExtrapolatedToTheTimeOfItsPingIfAllowed) {
    start(15);
    types::Snapshot snapshot = facingWall(5);
    snapshot.time = snapshot.sonar.time = framework::wallClock() + types::Time::fromSeconds(-0.4);
    snapshot.sonar.velocity = {0, 0, 2};
    snapshot.sonar.angular_velocity = {0, 0, 0};
    snapshot.max_extrapolation = 1;
    in_.port.write(std::make_shared<types::Snapshot>(snapshot));
    const types::SonarPtr ping = receive();
    ASSERT_TRUE(ping) << task_.lastError();
    EXPECT_GE((ping->time - snapshot.time).seconds(), 0.4);
    snapshot.max_extrapolation = 0;
    in_.port.write(std::make_shared<types::Snapshot>(snapshot));
    EXPECT_EQ(receive()->time, snapshot.time);
}

TEST_F(LastEchoTest, AStopDoesNotWaitForTheLastEchoAndWritesNoPing) {
    start(75000);  // 100 s
    send();
    while (task_.stages().empty() && task_.timing().workingSince().count() == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const types::Time asked = framework::wallClock();
    task_.activity().hold();
    EXPECT_LT((framework::wallClock() - asked).seconds(), 50);
    types::SonarPtr ping;
    EXPECT_FALSE(out_.port.readNew(ping));
    EXPECT_EQ(task_.ping.written(), 0u);
}

TEST_F(LastEchoTest, RejectsASnapshotFromTheFuture) {
    start(15);
    send(3600);
    EXPECT_TRUE(test::becomesTrue([&] { return task_.state() == framework::TaskState::RunTimeError; }));
    EXPECT_NE(task_.lastError().find("ahead of the clock"), std::string::npos);
    send();
    EXPECT_TRUE(receive());
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

}  // namespace
}  // namespace insonify::sonar
