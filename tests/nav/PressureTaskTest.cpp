#include <gmock/gmock.h>

#include "components/nav/SensorTask.hpp"
#include "tests/nav/Paths.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::nav {
namespace {

struct PressureTaskTest : test::TaskBench<PressureTask, types::Pose, types::Pressure> {
    PressureTaskTest() : TaskBench(&PressureTask::pose, &PressureTask::pressure) {}
};

TEST_F(PressureTaskTest, MeasuresEachPoseAtOnceAtItsPlaceInTheBody) {
    startWith({.sensor = {.mount = {.position = {0, 0, -0.5}}}, .density = 1000});
    const types::Pressure reported = answerTo(poseAt(3, {1, 2, -10}, turned(0, 0, 180)));
    EXPECT_EQ(reported.time, types::Time::fromSeconds(3));
    EXPECT_EQ(reported.pascal, static_cast<float>(pressureAt(9.5, {.density = 1000}))) << "upside down it is on top";
}

TEST_F(PressureTaskTest, WritesTheDepthAsRocksTypeToo) {
    test::Reader<types::Pose> reader;
    task_.depth_samples.connectTo(reader.port, framework::ConnPolicy::buffer(4));
    startWith({});
    answerTo(poseAt(1, {0, 0, -10}));
    types::Pose sample;
    ASSERT_TRUE(reader.port.readNew(sample));
    EXPECT_NEAR(sample.position.z, -10, 1e-3);
}

TEST_F(PressureTaskTest, TheSameSeedAndPosesGiveTheSameBits) {
    startWith({.errors = {.noise = 50, .drift_deviation = 100}});
    const auto run = [&] {
        std::vector<float> readings;
        for (int i = 1; i < 50; ++i) readings.push_back(answerTo(poseAt(i, {0, 0, -10})).pascal);
        return readings;
    };
    const std::vector<float> first = run();
    ASSERT_TRUE(task_.stop() && task_.start());
    EXPECT_EQ(run(), first);
    EXPECT_NE(first[0], first[1]);
}

TEST_F(PressureTaskTest, WarnsOnceBelowItsDeepestWater) {
    std::vector<std::string> warnings;
    task_.environment().warn = [&](const std::string& text) { warnings.push_back(text); };
    startWith({.density = 1000});
    const float reading = answerTo(poseAt(1, {0, 0, -13'000})).pascal;
    EXPECT_EQ(reading, static_cast<float>(pressureAt(deepest, {.density = 1000})));
    answerTo(poseAt(2, {0, 0, -14'000}));
    EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("pose: is deeper than 12000 m")));
}

TEST_F(PressureTaskTest, RejectsAPoseThatIsNotFiniteUntilAValidPose) {
    startWith({});
    answerTo(poseAt(1, glm::dvec3(std::nan(""))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_EQ(answerTo(poseAt(2, {})).pascal, 101325.0f);
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

}  // namespace
}  // namespace insonify::nav
