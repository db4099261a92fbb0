#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/ScanningSonarTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/TaskBench.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

using framework::TaskState;

struct ScanningSonarTaskTest : test::TaskBench<ScanningSonarTask, types::SnapshotPtr, types::SonarPtr> {
    ScanningSonarTaskTest() : TaskBench(&ScanningSonarTask::snapshot, &ScanningSonarTask::ping) {}
    void start(const HeadConfig& head) {
        ScanningSonarConfig config;
        config.sonar.range = 15;
        config.sonar.bin_count = 100;
        config.sonar.device = "software";
        config.head = head;
        startWith(config);
    }
    /** Returns the ping of the wall 5 m north, from a vehicle with this heading; null without a ping. */
    types::SonarPtr pingAt(double seconds, double yaw_deg = 0) {
        types::Snapshot snapshot = facingWall(5);
        snapshot.geometry = wall_;
        snapshot.time = types::Time::fromSeconds(seconds);
        snapshot.sonar.orientation = glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1));
        return answerTo(std::make_shared<types::Snapshot>(snapshot));
    }

    types::GeometryPtr wall_ = wallAt(5);
};

constexpr HeadConfig sector{.left_deg = 40, .right_deg = -40, .step_deg = 40, .continuous = {}, .speed_deg_per_s = {}};

TEST_F(ScanningSonarTaskTest, EachPingLooksAtItsBearing) {
    start(sector);
    for (double bearing : {40.0, 0.0, -40.0, 0.0, 40.0}) {
        const auto ping = pingAt(1);
        ASSERT_TRUE(ping) << task_.lastError();
        ASSERT_EQ(ping->beam_count, 1u);
        EXPECT_NEAR(ping->bearings[0].deg(), bearing, 1e-9);
        EXPECT_NEAR(ping->beam_width.deg(), 3, 1e-9);
        EXPECT_NEAR(ping->beam_height.deg(), 35, 1e-9);
        // The nearest point of the wall is at the beam's northern edge.
        EXPECT_NEAR(firstEcho(*ping, 0), 5 / std::cos(types::radians(std::max(std::abs(bearing) - 1.5, 0.0))), 0.16);
    }
}

TEST_F(ScanningSonarTaskTest, EveryPingHasItsOwnPose) {
    start(sector);
    // The vehicle turns to starboard by the angle by which the head looks to port: the beam stays on the wall.
    EXPECT_NEAR(firstEcho(*pingAt(1, -40), 0), 5, 0.16);
    EXPECT_NEAR(firstEcho(*pingAt(2, 0), 0), 5, 0.16);
    EXPECT_NEAR(firstEcho(*pingAt(3, 40), 0), 5, 0.16);
}

TEST_F(ScanningSonarTaskTest, DecreasingTimeIsARunTimeErrorUntilItIncreases) {
    start(sector);
    ASSERT_TRUE(pingAt(2));
    EXPECT_FALSE(pingAt(1));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_EQ(task_.lastError(), "the snapshot is older than the one before");
    const auto next = pingAt(2);
    ASSERT_TRUE(next);
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_NEAR(next->bearings[0].deg(), 0, 1e-9);
    EXPECT_TRUE(pingAt(2)) << "an equal time";
    EXPECT_TRUE(pingAt(2 + 5 * 86400.0)) << "a leap of five days";
}

TEST_F(ScanningSonarTaskTest, RejectsAStepThatTheHeadCannotMakeInThePingPeriod) {
    HeadConfig slow = sector;
    slow.speed_deg_per_s = 100;  // 0.4 s per step
    start(slow);
    ASSERT_TRUE(pingAt(1.0));
    EXPECT_FALSE(pingAt(1.1));
    EXPECT_EQ(task_.state(), TaskState::Exception);
    EXPECT_THAT(task_.lastError(),
                ::testing::HasSubstr("task.head.step_deg: is 40 deg, which takes 0.4 s at 100 deg/s; "
                                     "the ping period is 0.1 s"));
}

TEST_F(ScanningSonarTaskTest, AcceptsAStepThatTheHeadJustMakes) {
    HeadConfig just = sector;
    just.speed_deg_per_s = 100;
    start(just);
    EXPECT_TRUE(pingAt(1.0));
    EXPECT_TRUE(pingAt(1.4));
}

TEST_F(ScanningSonarTaskTest, AScanStartsAnewAtTheLeftLimitWithEachStart) {
    start(sector);
    pingAt(1);
    pingAt(2);
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    EXPECT_NEAR(pingAt(0.5)->bearings[0].deg(), 40, 1e-9);
}

TEST(RegisterTasksTest, DeploymentsKnowBothSonars) {
    framework::Registry registry;
    registerTasks(registry);
    EXPECT_TRUE(registry.make("sonar::SonarTask", "fls"));
    EXPECT_TRUE(registry.make("sonar::ScanningSonarTask", "msis"));
}

TEST_F(ScanningSonarTaskTest, SettingTheRangeDoesNotTurnTheHeadBackButSettingTheHeadDoes) {
    start(sector);
    ASSERT_TRUE(pingAt(1));
    task_.operation("setRange")->callText({"10"});
    EXPECT_NEAR(pingAt(1)->bearings[0].deg(), 0, 1e-9);
    task_.operation("setHead")->callText({"{left_deg: 20, right_deg: -20}"});
    EXPECT_NEAR(pingAt(1)->bearings[0].deg(), 20, 1e-9);
}

TEST_F(ScanningSonarTaskTest, ScansOnAfterTheClockIsSetBackOrARecordingRepeats) {
    start(sector);
    for (const double time : {1000.0, 1001.0, 400.0, 401.0, 1.8e9, 2.0, 2.5, 1.0, 1.5})
        EXPECT_TRUE(pingAt(time)) << time << " s: " << task_.lastError();
}

}  // namespace
}  // namespace insonify::sonar
