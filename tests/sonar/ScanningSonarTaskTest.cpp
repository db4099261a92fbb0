#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/TaskBench.hpp"
#include "types/geometry/Angle.hpp"

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

TEST_F(ScanningSonarTaskTest, AHeadWithErrorsStatesTheBearingOfItsStepsAndLooksElsewhere) {
    HeadConfig wrong = sector;
    wrong.error_deg = 10;
    start(wrong);
    const auto ping = pingAt(1);
    ASSERT_TRUE(ping) << task_.lastError();
    EXPECT_NEAR(ping->bearings[0].deg(), 40, 1e-9);
    const double there = std::abs(findStandingDeg(wrong, 40));
    ASSERT_GT(std::abs(there - 40), 1) << "else this test shows nothing";
    EXPECT_NEAR(firstEcho(*ping, 0), 5 / std::cos(types::radians(std::max(there - 1.5, 0.0))), 0.16);
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

TEST_F(ScanningSonarTaskTest, StampsThatJitterEndNoScan) {
    HeadConfig just = sector;
    just.speed_deg_per_s = 400;  // 0.1 s per step
    start(just);
    std::vector<std::string> warnings;
    task_.environment().warn = [&](const std::string& text) { warnings.push_back(text); };
    EXPECT_TRUE(pingAt(1));
    for (int i = 1; i < 40; ++i)
        EXPECT_TRUE(pingAt(1 + 0.1 * i + (i % 2 == 1 ? -0.02 : 0.02))) << i << ": " << task_.lastError();
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_EQ(warnings, std::vector<std::string>{});
}

TEST_F(ScanningSonarTaskTest, InRealtimeASlowHeadIsAWarningAfterEightPeriods) {
    for (const bool is_slow : {false, true}) {
        HeadConfig just = sector;
        just.speed_deg_per_s = is_slow ? 200 : 400;  // 0.2 and 0.1 s per step
        start(just);
        task_.activity().release(), task_.activity().hold();  // in realtime; pings are not written any more
        std::vector<std::string> warnings;
        task_.environment().warn = [&](const std::string& text) { warnings.push_back(text); };
        for (int i = 0; i < 30; ++i) {
            pingAt(1 + 0.1 * i - (i == 1 ? 0.03 : 0));
            ASSERT_EQ(task_.state(), TaskState::Running) << task_.lastError();
            EXPECT_TRUE(i >= 8 || warnings.empty());
        }
        ASSERT_EQ(warnings.size(), is_slow ? 1u : 0u);
        for (const std::string& warning : warnings)
            EXPECT_EQ(warning,
                      "task: head.step_deg is 40 deg, which takes 0.2 s at 200 deg/s; the ping period is 0.1 s");
        ASSERT_TRUE(task_.stop() && task_.cleanup());
    }
}

TEST_F(ScanningSonarTaskTest, AHeadThatIsSetAndFarTooSlowIsRefusedAndTheScanContinues) {
    start(sector);
    ASSERT_TRUE(pingAt(1.0));
    ASSERT_TRUE(pingAt(1.1));
    EXPECT_THROW(task_.operation("setHead")->callText({"{speed_deg_per_s: 100}"}), std::runtime_error);
    EXPECT_TRUE(pingAt(1.2)) << task_.lastError();
    EXPECT_FALSE(task_.config->head.speed_deg_per_s.has_value());
}

TEST_F(ScanningSonarTaskTest, ScansOnAfterTheClockIsSetBackOrARecordingRepeats) {
    start(sector);
    for (const double time : {1000.0, 1001.0, 400.0, 401.0, 1.8e9, 2.0, 2.5, 1.0, 1.5})
        EXPECT_TRUE(pingAt(time)) << time << " s: " << task_.lastError();
}

}  // namespace
}  // namespace insonify::sonar
