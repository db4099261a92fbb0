#include <gmock/gmock.h>

#include "components/nav/SensorTask.hpp"
#include "tests/nav/Paths.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::nav {
namespace {

struct DvlTaskTest : test::TaskBench<DvlTask, types::Pose, types::DvlPtr> {
    DvlTaskTest() : TaskBench(&DvlTask::pose, &DvlTask::dvl) {}

    void connectScene() { scene_.port.connectTo(task_.snapshot, {}); }
    void show(types::Snapshot snapshot) { scene_.port.write(std::make_shared<types::Snapshot>(std::move(snapshot))); }
    /** Returns the measurement at the middle of three poses a tenth of a second apart, the last at `time`. */
    types::DvlPtr reported(double time, const Path& path) {
        answerTo(path(time - 0.2));
        answerTo(path(time - 0.1));
        return answerTo(path(time));
    }
    const Path ahead_ = [](double time) { return poseAt(time, {1.5 * time, 0, -5}); };
    test::Writer<types::SnapshotPtr> scene_;
};

TEST_F(DvlTaskTest, MeasuresOverALevelBottomWithoutAScene) {
    startWith({.bottom_height = -17.0});
    const types::DvlPtr dvl = reported(1, ahead_);
    ASSERT_TRUE(dvl);
    EXPECT_EQ(dvl->time, types::Time::fromSeconds(0.9));
    EXPECT_LT(glm::distance(dvl->velocity, {1.5, 0, 0}), 1e-9);
    EXPECT_NEAR(dvl->altitude, 12, 1e-9);
}

TEST_F(DvlTaskTest, DoesNotStartWithoutABottom) {
    task_.config.set(DvlConfig{});
    ASSERT_TRUE(task_.configure());
    EXPECT_FALSE(task_.start());
    EXPECT_THAT(task_.lastError(), testing::HasSubstr("connect a scene's snapshot, or set bottom_height"));
}

TEST_F(DvlTaskTest, MeasuresOverTheFloorOfASceneFromItsPlaceInTheBody) {
    connectScene();
    startWith({.sensor = {.mount = {.position = {0.5, 0, -1}, .yaw_deg = 90}}});
    show(test::makeSnapshot(test::makeScene({test::ground(-17)})));
    const types::DvlPtr dvl = reported(1, ahead_);
    ASSERT_TRUE(dvl);
    EXPECT_LT(glm::distance(dvl->velocity, {0, -1.5, 0}), 1e-9) << "its x axis looks to port";
    EXPECT_NEAR(dvl->altitude, 11, 1e-9);
}

TEST_F(DvlTaskTest, BeforeTheFirstSnapshotAndAboveTheSurfaceThereIsNoBottomLock) {
    connectScene();
    startWith({});
    EXPECT_FALSE(reported(1, ahead_)->hasBottomLock());
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-17)}));
    snapshot.water_surface = -6;
    show(snapshot);
    EXPECT_FALSE(reported(2, ahead_)->hasBottomLock());
    snapshot.water_surface = 0;
    show(snapshot);
    EXPECT_TRUE(reported(3, ahead_)->hasBottomLock());
}

TEST_F(DvlTaskTest, WritesTheVelocityAsRocksTypeToo) {
    test::Reader<types::Pose> reader;
    task_.velocity_samples.connectTo(reader.port, framework::ConnPolicy::buffer(4));
    startWith({.bottom_height = -17.0, .errors = {.velocity_noise = 0.01}});
    const types::DvlPtr dvl = reported(1, ahead_);
    types::Pose sample;
    ASSERT_TRUE(dvl && reader.port.readNew(sample));
    EXPECT_EQ(sample.velocity, dvl->velocity);
    EXPECT_EQ(sample.cov_velocity, dvl->cov_velocity);
    EXPECT_EQ(sample.source_frame, "dvl");
    EXPECT_TRUE(std::isnan(sample.position.x));
}

TEST_F(DvlTaskTest, APeriodGivesFewerSamplesAndTheSameSeedTheSameBits) {
    const auto run = [&] {
        std::vector<glm::dvec3> velocities;
        for (int i = 0; i < 200; ++i)
            if (const types::DvlPtr dvl = answerTo(ahead_(1 + i * 0.01))) velocities.push_back(dvl->velocity);
        return velocities;
    };
    startWith({.sensor = {.period = 0.125}, .bottom_height = -17.0, .errors = {.velocity_noise = 0.01}});
    const std::vector<glm::dvec3> first = run();
    EXPECT_EQ(first.size(), 16u);
    ASSERT_TRUE(task_.stop() && task_.start());
    EXPECT_EQ(run(), first);
}

TEST_F(DvlTaskTest, RejectsAPoseThatIsNotFiniteUntilAValidPose) {
    startWith({.bottom_height = -17.0});
    EXPECT_FALSE(answerTo(poseAt(1, glm::dvec3(INFINITY))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_TRUE(reported(2, ahead_));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

TEST_F(DvlTaskTest, RejectsAnEmptyIntervalOfAltitudes) {
    EXPECT_THAT(test::countRefusals(DvlConfig{.min_altitude = 5, .max_altitude = 5}),
                testing::ElementsAre(testing::StartsWith("min_altitude: ")));
}

}  // namespace
}  // namespace insonify::nav
