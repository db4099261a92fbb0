// Stale and missing poses: RunTimeError until poses return, never a snapshot of an old place.
#include <gmock/gmock.h>

#include <numbers>

#include "tests/scene/SceneTaskFiles.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::scene {
namespace {

using framework::TaskState;
using testing::HasSubstr;
using testing::Not;

struct PoseTimeoutTest : SceneTaskFiles {
    PoseTimeoutTest()
        : SceneTaskFiles(R"("scenes":[{"nodes":[]}],"nodes":[],)" + buffers("    "), framework::ConnPolicy::data()) {
        task_.environment().now = [this] { return now_; };
    }
    void startWith(std::optional<double> timeout) {
        config_.pose_timeout = timeout;
        start();
    }
    /** Runs a cycle at this time [s], with a pose of that stamp if given; returns whether there was a snapshot. */
    bool cycle(double now, std::optional<double> stamp = {}) {
        now_ = types::Time::fromSeconds(now);
        types::Pose pose;
        if (stamp) pose.time = types::Time::fromSeconds(*stamp);
        if (stamp) vehicle_.port.write(pose);
        task_.update();
        types::SnapshotPtr snapshot;
        return out_.port.readNew(snapshot);
    }

    types::Time now_ = types::Time::fromSeconds(10);
};

TEST_F(PoseTimeoutTest, MissingPosesAreAnErrorUntilTheyReturn) {
    startWith(0.5);
    EXPECT_TRUE(cycle(10.1, 10.1));
    EXPECT_FALSE(cycle(10.5));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_FALSE(cycle(10.7));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_THAT(task_.lastError(), HasSubstr("no pose in the last 0.5 s"));
    EXPECT_FALSE(cycle(20));
    EXPECT_TRUE(cycle(20.1, 20.1));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_EQ(task_.timing().errors, 1u);
}

TEST_F(PoseTimeoutTest, WaitingForTheFirstPoseIsReportedOnceAndIsNoError) {
    std::vector<std::string> reported;
    task_.environment().warn = [&](const std::string& text) { reported.push_back(text); };
    startWith(0.5);
    EXPECT_FALSE(cycle(10.4));
    EXPECT_THAT(reported, testing::IsEmpty());
    EXPECT_FALSE(cycle(10.6));
    EXPECT_FALSE(cycle(1000));
    EXPECT_THAT(reported, testing::ElementsAre("scene: scene.pose: waits for the first pose"));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_EQ(task_.timing().errors, 0u);
    EXPECT_FALSE(task_.waits()) << "in error: nobody was ever there";
    EXPECT_TRUE(cycle(1000.1, 1000.1));
}

TEST_F(PoseTimeoutTest, WaitsForMissingPosesButNotForInvalidPoses) {
    startWith(0.5);
    EXPECT_TRUE(cycle(10.1, 10.1));
    EXPECT_FALSE(task_.waits());
    EXPECT_FALSE(cycle(11));
    EXPECT_TRUE(task_.waits());
    types::Pose broken;
    broken.time = types::Time::fromSeconds(11.1);
    broken.position.x = types::Pose::unknown;
    vehicle_.port.write(broken);
    EXPECT_FALSE(cycle(11.1));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_FALSE(task_.waits());
}

TEST_F(PoseTimeoutTest, AnOldPoseGivesNoSnapshot) {
    startWith(0.5);
    EXPECT_FALSE(cycle(11, 10.4));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_FALSE(cycle(11.1, 10.5));
    EXPECT_TRUE(cycle(11.2, 10.8));
    EXPECT_EQ(task_.state(), TaskState::Running);
}

TEST_F(PoseTimeoutTest, AQuaternionThatIsNotOfUnitLengthIsReportedOnce) {
    std::vector<std::string> warnings;
    task_.environment().warn = [&](const std::string& text) { warnings.push_back(text); };
    startWith(0.5);
    types::Pose body;
    for (int i = 0; i < 3; ++i) {
        body.time = now_ = types::Time::fromSeconds(10.1 + i / 10.0);
        body.orientation = glm::dquat(1, 0, 0, i == 0 ? 0.1 : 90);
        vehicle_.port.write(body);
        task_.update();
        types::SnapshotPtr snapshot;
        ASSERT_TRUE(out_.port.readNew(snapshot)) << "it is taken all the same";
        EXPECT_NEAR(glm::length(snapshot->sonar.orientation), 1, 1e-12);
        EXPECT_EQ(warnings.size(), i == 0 ? 0u : 1u) << "0.5 % off are those of a sender in single precision";
    }
    EXPECT_THAT(warnings[0], HasSubstr("the orientation is a quaternion of length 90.01"));
}

TEST_F(PoseTimeoutTest, StampsOfAnotherClockAreReportedWithTheRemedy) {
    startWith(0.5);
    EXPECT_FALSE(cycle(110, 10));
    EXPECT_THAT(task_.lastError(), HasSubstr("have stamps 100 s behind this clock"));
    EXPECT_THAT(task_.lastError(), HasSubstr("`stamp: arrival`"));
    EXPECT_TRUE(cycle(110.1, 110.1));
    EXPECT_TRUE(cycle(110.3, 110.1));
    EXPECT_FALSE(cycle(110.7)) << "a late pose was the last";
    EXPECT_THAT(task_.lastError(), Not(HasSubstr("stamp:")));
    EXPECT_FALSE(cycle(111)) << "the sender is silent, its clock was right";
    EXPECT_THAT(task_.lastError(), Not(HasSubstr("stamp:")));
}

TEST_F(PoseTimeoutTest, HasNoDefaultTimeoutOutsideOfRealtime) {
    startWith({});
    EXPECT_TRUE(cycle(10, 10));
    EXPECT_FALSE(cycle(1000));
    EXPECT_TRUE(cycle(1000, 10));
    EXPECT_EQ(task_.timing().errors, 0u);
    EXPECT_EQ(task_.wakeAfter(), 0);
}

TEST_F(PoseTimeoutTest, TheSonarMovesWithTheBodyAndIsExtrapolatedOnRequest) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(10);
    pose.velocity = {2, 0, 0};
    pose.angular_velocity = {0, 0, 0.5};
    const auto snapshot_of = [&](std::optional<double> maximum) {
        config_.extrapolate = maximum;
        config_.mount.position = {1, 0, 0};
        config_.mount.pitch_deg = 90;  // looks down: its x is the body's -z
        task_.stop();
        startWith({});
        vehicle_.port.write(pose);
        task_.update();
        types::SnapshotPtr snapshot;
        EXPECT_TRUE(out_.port.readNew(snapshot));
        return *snapshot;
    };
    EXPECT_EQ(snapshot_of({}).max_extrapolation, 0);
    const types::Snapshot moving = snapshot_of(0.3);
    EXPECT_EQ(moving.max_extrapolation, 0.3);
    EXPECT_EQ(moving.time, pose.time);
    EXPECT_NEAR(glm::distance(moving.sonar.velocity, glm::dvec3(2, 0.5, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(moving.sonar.angular_velocity, glm::dvec3(-0.5, 0, 0)), 0, 1e-12);
}

TEST(CarriedOnTest, ExtrapolatesAPoseByItsVelocitiesUpToTheLimit) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(10);
    pose.velocity = {2, 0, 0};
    pose.angular_velocity = {0, 0, std::numbers::pi / 2};  // a quarter turn a second
    const auto at = [&](double now, double maximum) {
        return types::extrapolatePose(pose, types::Time::fromSeconds(now), maximum);
    };
    EXPECT_EQ(at(10.5, 1).position, glm::dvec3(1, 0, 0));
    EXPECT_EQ(at(10.5, 1).time.seconds(), 10.5);
    EXPECT_NEAR(glm::degrees(glm::angle(at(10.5, 1).orientation)), 45, 1e-9);
    EXPECT_EQ(at(19, 1).position, glm::dvec3(2, 0, 0)) << "at most a second";
    EXPECT_EQ(at(9, 1).position, glm::dvec3(0)) << "never back";
    pose.angular_velocity = glm::dvec3(types::Pose::unknown);
    EXPECT_EQ(at(10.5, 1).position, glm::dvec3(0)) << "a rate is unknown";
}

TEST_F(PoseTimeoutTest, AStampFarAheadIsStaleAsWell) {
    startWith(0.5);
    EXPECT_TRUE(cycle(10.1, 10.1));
    EXPECT_FALSE(cycle(5)) << "the clock was set back";
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_TRUE(cycle(5.1, 5.1));
    EXPECT_EQ(task_.state(), TaskState::Running);
}

/** A node that another vehicle's pose moves. */
TEST_F(PoseTimeoutTest, MissingPosesOfANodeAreAnError) {
    config_.file =
        write("buoy.gltf", gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"buoy"}],)" + buffers("    "))).string();
    task_.config.set(config_);
    test::Writer<types::Pose> other("other");
    framework::InputPortBase* const port = task_.makeInput("buoy.pose", other.port);
    ASSERT_NE(port, nullptr);
    other.port.connectTo(*port, framework::ConnPolicy::data());
    startWith(0.5);
    types::Pose still;
    still.time = types::Time::fromSeconds(10);
    other.port.write(still);
    EXPECT_TRUE(cycle(10.4, 10.4));
    EXPECT_FALSE(cycle(10.6, 10.6));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_THAT(task_.lastError(), HasSubstr("scene.buoy.pose: no pose in the last 0.5 s"));
    still.time = types::Time::fromSeconds(10.7);
    other.port.write(still);
    EXPECT_TRUE(cycle(10.7, 10.7));
    EXPECT_EQ(task_.state(), TaskState::Running);
}

}  // namespace
}  // namespace insonify::scene
