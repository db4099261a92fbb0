// Stale and missing poses: RunTimeError until poses are back, never a snapshot of an old place.
#include <gmock/gmock.h>

#include <numbers>

#include "components/framework/Activity.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::scene {
namespace {

using framework::TaskState;
using testing::HasSubstr;

class PoseTimeoutTest : public SceneFiles {
protected:
    PoseTimeoutTest() {
        config_.file = write("empty.gltf", gltf(R"("scenes":[{"nodes":[]}],"nodes":[],)" + buffers("    "))).string();
        vehicle_.port.connectTo(task_.pose, framework::ConnPolicy::data());
        task_.snapshot.connectTo(out_.port, framework::ConnPolicy::buffer(8));
        task_.environment().now = [this] { return now_; };
    }
    void start(std::optional<double> timeout) {
        config_.pose_timeout = timeout;
        task_.config.set(config_);
        ASSERT_TRUE(task_.configure()) << task_.lastError();
        ASSERT_TRUE(task_.start());
    }
    /** A cycle at this time [s], with a pose of that stamp where one is given; whether there was a snapshot. */
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
    SceneConfig config_;
    SceneTask task_{"scene"};
    test::Writer<types::Pose> vehicle_{"vehicle"};
    test::Reader<types::SnapshotPtr> out_;
};

TEST_F(PoseTimeoutTest, PosesThatStayAwayAreAnErrorUntilTheyAreBack) {
    start(0.5);
    EXPECT_TRUE(cycle(10.1, 10.1));
    EXPECT_FALSE(cycle(10.5));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_FALSE(cycle(10.7));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_THAT(task_.lastError(), HasSubstr("no pose of the last 0.5 s"));
    EXPECT_FALSE(cycle(20));
    EXPECT_TRUE(cycle(20.1, 20.1));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_EQ(task_.timing().errors, 1u);
}

TEST_F(PoseTimeoutTest, APoseThatNeverCameIsMissingFromTheStartOn) {
    start(0.5);
    EXPECT_FALSE(cycle(10.4));
    EXPECT_EQ(task_.state(), TaskState::Running);
    EXPECT_FALSE(cycle(10.6));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
}

TEST_F(PoseTimeoutTest, APoseThatIsOldWhenItComesGivesNoSnapshot) {
    start(0.5);
    EXPECT_FALSE(cycle(11, 10.4));
    EXPECT_EQ(task_.state(), TaskState::RunTimeError);
    EXPECT_FALSE(cycle(11.1, 10.5));
    EXPECT_TRUE(cycle(11.2, 10.8));
    EXPECT_EQ(task_.state(), TaskState::Running);
}

TEST_F(PoseTimeoutTest, WithoutATimeoutThereIsNoneOutsideOfRealtime) {
    start({});
    EXPECT_TRUE(cycle(10, 10));
    EXPECT_FALSE(cycle(1000));
    EXPECT_TRUE(cycle(1000, 10));
    EXPECT_EQ(task_.timing().errors, 0u);
    EXPECT_EQ(task_.wakeAfter(), 0);
}

TEST_F(PoseTimeoutTest, APoseIsCarriedOnByItsVelocitiesOnlyWhereAskedAndSoFar) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(10);
    pose.velocity = {2, 0, 0};
    pose.angular_velocity = {0, 0, std::numbers::pi / 2};  // a quarter turn a second
    const auto at = [&](double now, std::optional<double> most) {
        task_.stop();
        config_.extrapolate = most;
        start({});
        now_ = types::Time::fromSeconds(now);
        vehicle_.port.write(pose);
        task_.update();
        types::SnapshotPtr snapshot;
        EXPECT_TRUE(out_.port.readNew(snapshot));
        return snapshot->sonar;
    };
    EXPECT_EQ(at(10.5, {}).position, glm::dvec3(0));
    EXPECT_EQ(at(10.5, {}).time.seconds(), 10);
    EXPECT_EQ(at(10.5, 1).position, glm::dvec3(1, 0, 0));
    EXPECT_EQ(at(10.5, 1).time.seconds(), 10.5);
    EXPECT_NEAR(glm::degrees(glm::angle(at(10.5, 1).orientation)), 45, 1e-9);
    EXPECT_EQ(at(19, 1).position, glm::dvec3(2, 0, 0)) << "at most a second";
    EXPECT_EQ(at(9, 1).position, glm::dvec3(0)) << "never back";
    pose.angular_velocity = glm::dvec3(types::Pose::unknown);
    EXPECT_EQ(at(10.5, 1).position, glm::dvec3(0)) << "a rate is unknown";
}

}  // namespace
}  // namespace insonify::scene
