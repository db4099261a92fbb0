#include <gmock/gmock.h>

#include <atomic>
#include <future>

#include "tests/replay/Bench.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::replay {
namespace {

using testing::ElementsAre;

TEST(ReplayClockTest, PaceScalesTheWallClock) {
    Bench bench(false, {.file = {}, .pace = 2});
    test::Reader<types::Pose> poses;
    bench.clock = {1'000'000};
    bench.start("vehicle.pose", poses);
    EXPECT_TRUE(bench.task.activity().settings().periodic()) << "nothing else would run it";
    bench.updateAt(1'000'004);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10)) << "8 us of the log have passed";
    bench.updateAt(1'000'005);
    EXPECT_THAT(stampsIn(poses), ElementsAre(20));
    bench.updateAt(1'000'010);
    EXPECT_THAT(stampsIn(poses), ElementsAre(30));
}

TEST(ReplayClockTest, WithoutPaceEachCyclePlaysOneInstant) {
    Bench bench(false, {.file = {}, .pace = 0});
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.start("sonar.ping", pings);
    bench.task.update();
    EXPECT_THAT(stampsIn(poses), ElementsAre(10));
    bench.task.update();
    EXPECT_THAT(stampsIn(poses), ElementsAre(20));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10));
}

TEST(ReplayClockTest, InRealtimeAllTasksReadTheLogsTime) {
    Bench bench(false, {.file = {}, .pace = 2});
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.clock = {1'000'000};
    ASSERT_TRUE(bench.task.configure());
    const auto now = [&] { return bench.task.environment().now(); };
    EXPECT_EQ(now(), types::Time{10}) << "before the start it stands at the first sample";
    ASSERT_TRUE(bench.task.start());
    bench.clock = {1'000'004};
    EXPECT_EQ(now(), types::Time{18});
}

TEST(ReplayClockTest, WithoutPaceTheLogsTimeIsThatOfThePlayedInstant) {
    Bench bench(false, {.file = {}, .pace = 0});
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    for (const int64_t time : {10, 20, 30}) {
        bench.task.update();
        EXPECT_EQ(bench.task.environment().now(), types::Time{time});
    }
}

TEST(ReplayClockTest, StartsAtTheGivenTime) {
    Bench bench(true, {.file = {}, .from = 10e-6});
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.start("sonar.ping", pings);
    EXPECT_EQ(bench.task.nextTime(), types::Time{20});
    bench.updateAt(100);
    EXPECT_THAT(stampsIn(poses), ElementsAre(20, 30));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10, 20)) << "in the file they are after the pose at 20";
}

/** A task that waits in the clock of the system keeps no other from reading the log's time. */
TEST(ReplayClockTest, TasksReadTheClockWithoutWaitingForEachOther) {
    Bench bench(false);
    std::promise<void> enters, leaves;
    std::atomic<bool> is_slow{false};
    auto clock = bench.task.clock([&] {
        if (is_slow.exchange(false)) {
            enters.set_value();
            leaves.get_future().wait();
        }
        return bench.clock;
    });
    test::Reader<types::Pose> poses;
    bench.clock = {1'000'000};
    bench.start("vehicle.pose", poses);
    is_slow = true;
    std::future<types::Time> slow = std::async(std::launch::async, clock);
    enters.get_future().wait();
    std::future<types::Time> fast = std::async(std::launch::async, clock);
    EXPECT_EQ(fast.wait_for(test::patience), std::future_status::ready);
    leaves.set_value();
    EXPECT_EQ(slow.get(), types::Time{10});
    EXPECT_EQ(fast.get(), types::Time{10});
}

TEST(ReplayClockTest, ReportsAStartAfterTheEndBeforeAnythingStarts) {
    Bench bench(true, {.file = {}, .from = 1});
    EXPECT_THAT(test::countRefusals(bench.task), ElementsAre(testing::StartsWith("from: ")));
}

TEST(ReplayClockTest, InALoopStampsContinueAndTimeNeverRunsBackwards) {
    Bench bench(true, {.file = {}, .loop = true});
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    std::vector<int64_t> instants;
    for (int i = 0; i < 7; ++i) {
        instants.push_back(bench.task.nextTime()->microseconds);
        bench.updateAt(instants.back());
    }
    EXPECT_THAT(instants, ElementsAre(10, 20, 30, 40, 50, 60, 70));
    EXPECT_FALSE(bench.task.finished());
    std::vector<double> places;
    std::vector<int64_t> stamps;
    for (types::Pose pose; poses.port.readNew(pose);) {
        places.push_back(pose.position.x);
        stamps.push_back(pose.time.microseconds);
    }
    EXPECT_EQ(stamps, instants);
    EXPECT_THAT(places, ElementsAre(10, 20, 30, 10, 20, 30, 10));
}

TEST(ReplayClockTest, SeekJumpsInTheLogWhileTimeContinues) {
    Bench bench;
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    bench.updateAt(10);
    bench.updateAt(20);
    bench.task.seek(0);
    EXPECT_EQ(bench.task.nextTime(), types::Time{30});
    bench.updateAt(30);
    bench.task.seek(20e-6);
    bench.updateAt(40);
    std::vector<double> places;
    for (types::Pose pose; poses.port.readNew(pose);) places.push_back(pose.position.x);
    EXPECT_THAT(places, ElementsAre(10, 20, 10, 30));
    EXPECT_TRUE(bench.task.finished());
}

TEST(ReplayClockTest, ASeekOutsideOfTheLogIsRefused) {
    Bench bench;
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    bench.updateAt(10);
    for (const double place : {-1.0, 22e-6, 1e300, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(bench.task.seek(place), std::runtime_error) << place;
    EXPECT_EQ(bench.task.nextTime(), types::Time{20}) << "it continues at its place";
}

TEST(ReplayClockTest, ASeekAfterAPauseContinuesFromNowWithoutABurst) {
    Bench bench(false, {.file = {}, .pace = 2});
    test::Reader<types::Pose> poses;
    bench.clock = {1'000'000};
    bench.start("vehicle.pose", poses);
    bench.updateAt(1'000'010);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10, 20, 30));
    bench.clock = {1'001'000};
    bench.task.seek(0);
    bench.updateAt(1'001'000);
    EXPECT_THAT(stampsIn(poses), ElementsAre(2010));
    bench.task.seek(0);
    bench.updateAt(1'001'005);
    EXPECT_THAT(stampsIn(poses), ElementsAre(2020)) << "the pause is not part of a gap";
}

TEST(ReplayClockTest, PausedLogTimeAdvancesByStep) {
    for (const double pace : {0.0, 2.0}) {
        Bench bench(false, {.file = {}, .pace = pace});
        test::Reader<types::Pose> poses;
        bench.connect("vehicle.pose", poses);
        bench.clock = {1'000'000};
        bench.task.configure();
        EXPECT_THROW(bench.task.pause(true), std::runtime_error) << "it does not run yet";
        bench.task.start();
        EXPECT_THROW(bench.task.step(), std::runtime_error) << "it is not paused";
        bench.task.update();
        EXPECT_THAT(stampsIn(poses), ElementsAre(10));
        bench.task.pause(true);
        EXPECT_TRUE(bench.task.playback()->paused);
        bench.updateAt(1'500'000);
        EXPECT_THAT(stampsIn(poses), ElementsAre());
        bench.task.step();
        EXPECT_THAT(stampsIn(poses), ElementsAre(20));
        EXPECT_EQ(bench.task.environment().now(), types::Time{20});
        bench.updateAt(2'000'000);
        EXPECT_THAT(stampsIn(poses), ElementsAre()) << "one step, one instant";
        bench.task.pause(false);
        EXPECT_FALSE(bench.task.playback()->paused);
        bench.updateAt(2'000'005);
        EXPECT_THAT(stampsIn(poses), ElementsAre(30));
    }
}

TEST(ReplayClockTest, InLockstepTheLogCannotBePaused) {
    Bench bench;
    bench.task.configure();
    bench.task.start();
    EXPECT_THROW(bench.task.pause(true), std::runtime_error);
}

}  // namespace
}  // namespace insonify::replay
