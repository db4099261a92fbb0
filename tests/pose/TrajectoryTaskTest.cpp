#include <gmock/gmock.h>

#include <fstream>
#include <memory>

#include "components/framework/execution/Activity.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::pose {
namespace {

/** A task on a clock that the test sets; the run starts at 1 s. */
struct TrajectoryTaskTest : ::testing::Test {
    TrajectoryTaskTest() {
        auto environment = std::make_shared<framework::Environment>();
        environment->now = [this] { return time_; };
        environment->start_time = [] { return types::Time::fromSeconds(1); };
        environment->input_folder = folder_.path();
        task_.setEnvironment(environment);
        task_.pose.connectTo(out_.port, {});
    }
    types::Pose poseAt(double seconds) {
        time_ = types::Time::fromSeconds(seconds);
        task_.update();
        types::Pose pose;
        EXPECT_TRUE(out_.port.readNew(pose));
        return pose;
    }

    const Folder folder_;
    types::Time time_;
    TrajectoryTask task_{"vehicle"};
    test::Reader<types::Pose> out_;
};

TEST_F(TrajectoryTaskTest, TimesCountFromTheStartOfTheRun) {
    task_.config.set({.file = {}, .waypoints = {{.time = 0}, {.time = 2, .position = {4, 0, 0}}}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    const types::Pose pose = poseAt(1.5);
    EXPECT_DOUBLE_EQ(pose.position.x, 1);
    EXPECT_EQ(pose.time, types::Time::fromSeconds(1.5));
}

TEST_F(TrajectoryTaskTest, IsFinishedWithTheLastPoseOnTheTrajectory) {
    task_.config.set({.file = {}, .waypoints = {{.time = 0}, {.time = 1}}});
    task_.activity().configure({.period = 0.3, .trigger = {}, .cpus = {}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    poseAt(1.6);
    EXPECT_FALSE(task_.finished());
    poseAt(1.9);
    EXPECT_TRUE(task_.finished());
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    EXPECT_FALSE(task_.finished());
}

TEST_F(TrajectoryTaskTest, CountsThePosesThatItHoldsAfterTheLastStamp) {
    task_.config.set(
        {.file = {}, .waypoints = {{.time = 0, .position = {0, 0, 0}}, {.time = 2, .position = {2, 0, 0}}}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    for (const double time : {1.0, 2.0, 3.0}) poseAt(time);
    EXPECT_THAT(task_.notices(), testing::IsEmpty());
    for (const double time : {3.5, 4.0}) EXPECT_EQ(poseAt(time).position.x, 2);
    EXPECT_THAT(task_.notices(), testing::ElementsAre("the trajectory ended at 2 s; 2 poses after it are its last one "
                                                      "(loop: true repeats it)"));
}

TEST_F(TrajectoryTaskTest, WarnsOfQuaternionsOfOddLengths) {
    std::ofstream(folder_ / "t.csv") << "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1.005,0,0,0\n1,0,0,0,2,0,0,0\n";
    task_.config.set({.file = "t.csv", .waypoints = {}});
    ASSERT_TRUE(task_.configure());
    EXPECT_THAT(
        types::lines(task_.notices()),
        testing::ElementsAre(testing::StartsWith("Warning: 1 of 2 quaternions of t.csv have a length that is not 1")));
}

TEST_F(TrajectoryTaskTest, APeriodThatDividesTheTrajectoryReachesItsLastStamp) {
    task_.config.set({.file = {}, .waypoints = {{.time = 0}, {.time = 1}}});
    task_.activity().configure({.period = 1.0 / 3, .trigger = {}, .cpus = {}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    poseAt(1 + 2.0 / 3);
    EXPECT_FALSE(task_.finished());
    poseAt(2);
    EXPECT_TRUE(task_.finished());
}

TEST_F(TrajectoryTaskTest, AFixedPoseIsFinishedAfterOnePose) {
    task_.config.set({.file = {}, .waypoints = {{.time = 100, .position = {1, 2, 3}}}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    EXPECT_FALSE(task_.finished());
    EXPECT_EQ(poseAt(1).position, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(task_.finished());
}

TEST_F(TrajectoryTaskTest, ALoopRestartsAtItsFirstStamp) {
    task_.config.set(
        {.file = {},
         .waypoints = {{.time = 2}, {.time = 4, .position = {4, 0, 0}}, {.time = 6, .position = {0, 0, 0}}},
         .loop = true});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    EXPECT_EQ(poseAt(2).position.x, 0) << "before the first stamp it waits, as without a loop";
    for (const double turn : {0.0, 4.0, 400'000.0}) {
        EXPECT_DOUBLE_EQ(poseAt(1 + 3 + turn).position.x, 2) << "on its way, turn after " << turn << " s";
        EXPECT_DOUBLE_EQ(poseAt(1 + 5.5 + turn).position.x, 1);
        EXPECT_DOUBLE_EQ(poseAt(1 + 6 + turn).position.x, 0);
        EXPECT_EQ(poseAt(1 + 5.5 + turn).time, types::Time::fromSeconds(6.5 + turn)) << "stamps do not go back";
        EXPECT_FALSE(task_.finished());
    }
}

TEST_F(TrajectoryTaskTest, ALoopOfOneWaypointHoldsItsPose) {
    task_.config.set({.file = {}, .waypoints = {{.time = 0, .position = {1, 2, 3}}}, .loop = true});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    for (const double time : {1.0, 50.0, 1e6}) {
        EXPECT_EQ(poseAt(time).position, glm::dvec3(1, 2, 3));
        EXPECT_FALSE(task_.finished());
    }
}

TEST_F(TrajectoryTaskTest, FindsAFileNextToTheDeployment) {
    std::ofstream(folder_ / "trajectory.csv") << "time,x,y,z,qw,qx,qy,qz\n0,7,8,9,1,0,0,0\n";
    task_.config.set({.file = "trajectory.csv", .waypoints = {}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    EXPECT_EQ(poseAt(1).position, glm::dvec3(7, 8, 9));
}

TEST_F(TrajectoryTaskTest, AMissingFileIsADiagnosticAndAnErrorOfConfigure) {
    task_.config.set({.file = "no_such.csv", .waypoints = {}});
    EXPECT_THAT(test::countRefusals(task_), testing::ElementsAre(testing::StartsWith("file: ")));
    EXPECT_FALSE(task_.configure());
    EXPECT_NE(task_.configError(), nullptr);
}

/** A file of positions x = 0, 1, 2 m at one second's distance; `first` and the second in the unit of its times. */
void writeLine(const std::filesystem::path& file, double first, double second) {
    std::ofstream out(file);
    out.precision(19);
    out << "time,x,y,z,qw,qx,qy,qz\n";
    for (int i = 0; i < 3; ++i) out << first + i * second << "," << i << ",0,0,1,0,0,0\n";
}

TEST_F(TrajectoryTaskTest, TimesSince1970OfAnyUnitBeginWithTheRunWhereAsked) {
    for (const double unit : {1.0, 1e3, 1e6, 1e9}) {
        SCOPED_TRACE(unit);
        writeLine(folder_ / "t.csv", 1403636580.8388 * unit, unit);
        for (const TrajectoryTimes& times :
             {TrajectoryTimes{.start = TrajectoryStart::FirstPose}, TrajectoryTimes{.start_s = 1403636580.8388}}) {
            task_.config.set({.file = "t.csv", .waypoints = {}, .times = times});
            EXPECT_THAT(test::countRefusals(task_), testing::IsEmpty());
            ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
            for (const double time : {0.0, 0.25, 1.5, 2.0}) EXPECT_NEAR(poseAt(1 + time).position.x, time, 1e-6);
            EXPECT_NEAR(task_.duration(), 2, 1e-6);
            ASSERT_TRUE(task_.stop() && task_.cleanup());
        }
        task_.config.set({.file = "t.csv", .waypoints = {}});
        EXPECT_THAT(test::countRefusals(task_),
                    testing::ElementsAre(testing::AllOf(testing::HasSubstr("begins 1403636580.8"),
                                                        testing::HasSubstr("start: first_pose"),
                                                        testing::HasSubstr("start_s: 1403636580.8"))));
    }
    EXPECT_FALSE(task_.configure());
}

TEST_F(TrajectoryTaskTest, SecondsThatAreNotSince1970HaveTheUnitThatIsGiven) {
    writeLine(folder_ / "t.csv", 0, 1e9);
    task_.config.set({.file = "t.csv", .waypoints = {}, .times = {.time_unit = TimeUnit::Nanoseconds}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    EXPECT_DOUBLE_EQ(poseAt(2.5).position.x, 1.5);
    ASSERT_TRUE(task_.stop() && task_.cleanup());
    task_.config.set({.file = "t.csv", .waypoints = {}});
    EXPECT_THAT(test::countRefusals(task_), testing::ElementsAre(testing::HasSubstr("Set time_unit if")));
    for (const double end : {1e30, 1e300, -1e300}) {
        writeLine(folder_ / "t.csv", std::min(end, 0.0), std::abs(end));
        EXPECT_THAT(test::countRefusals(task_), testing::ElementsAre(testing::HasSubstr("may be up to 1e+09 s")));
    }
}

TEST_F(TrajectoryTaskTest, WarnsOfATrajectoryThatHasNotBegun) {
    const std::vector<Waypoint> late{{.time = 100}, {.time = 102, .position = {2, 0, 0}}};
    for (const bool loop : {false, true}) {
        task_.config.set({.file = {}, .waypoints = late, .loop = loop});
        ASSERT_TRUE(task_.configure());
        EXPECT_THAT(types::lines(task_.notices()),
                    testing::ElementsAre(testing::AllOf(
                        testing::StartsWith("Warning: the trajectory begins 100 s after the start of the run"),
                        testing::HasSubstr("start: first_pose"))));
        ASSERT_TRUE(task_.cleanup());
        task_.config.set({.file = {}, .waypoints = late, .loop = loop, .times = {.start = TrajectoryStart::FirstPose}});
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
        EXPECT_THAT(task_.notices(), testing::IsEmpty());
        EXPECT_DOUBLE_EQ(poseAt(2).position.x, 1);
        ASSERT_TRUE(task_.stop() && task_.cleanup());
    }
    task_.config.set({.file = {}, .waypoints = {{.time = 100}}});
    ASSERT_TRUE(task_.configure());
    EXPECT_THAT(task_.notices(), testing::IsEmpty()) << "a fixed pose has begun at any time";
}

TEST_F(TrajectoryTaskTest, TrajectoriesOfOneClockKeepTheirDistanceInTime) {
    const double clock = 345'678.25;
    task_.config.set({.file = {},
                      .waypoints = {{.time = clock + 5}, {.time = clock + 7, .position = {2, 0, 0}}},
                      .times = {.start_s = clock}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    EXPECT_DOUBLE_EQ(poseAt(1 + 6).position.x, 1);
    EXPECT_THAT(task_.notices(), testing::ElementsAre(testing::HasSubstr("begins 5 s after")));
    ASSERT_TRUE(task_.stop() && task_.cleanup());
    task_.config.set({.file = {}, .waypoints = {{.time = 1}, {.time = 2}}, .times = {.start_s = 10}});
    EXPECT_THAT(test::countRefusals(task_), testing::ElementsAre(testing::HasSubstr("ends at 2 s, before start_s")));
    task_.config.set({.file = {},
                      .waypoints = {{.time = 1}, {.time = 2}},
                      .times = {.start = TrajectoryStart::FirstPose, .start_s = 1}});
    types::Diagnostics both;
    task_.config->check(both);
    EXPECT_EQ(both.size(), 1u);
}

TEST_F(TrajectoryTaskTest, RefusesTimesThatAreNoNumbersOrOutOfOrder) {
    const auto refusals = [&](const std::string& second) {
        std::ofstream(folder_ / "t.csv") << "time,x,y,z,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n" << second << ",0,0,0,1,0,0,0\n";
        task_.config.set({.file = "t.csv", .waypoints = {}});
        return test::countRefusals(task_);
    };
    for (const char* bad : {"nan", "inf", "-inf", "1", "0.5", "-3", ""})
        EXPECT_THAT(refusals(bad), testing::ElementsAre(testing::HasSubstr("t.csv:3:1"))) << bad;
}

TEST_F(TrajectoryTaskTest, FollowsTheTimeOfTheRunAndStampsByTheClock) {
    types::Time run;
    task_.environment().run_time = [&] { return run; };
    task_.config.set({.file = {}, .waypoints = {{.time = 0}, {.time = 10, .position = {20, 0, 0}}}});
    ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    for (const double clock : {5.0, 605.0, -1000.0}) {  // it is set forward and back
        run = run + types::Time::fromSeconds(1);
        const types::Pose pose = poseAt(clock);
        EXPECT_DOUBLE_EQ(pose.position.x, 2 * run.seconds());
        EXPECT_EQ(pose.time, types::Time::fromSeconds(clock));
    }
}

}  // namespace
}  // namespace insonify::pose
