// Positions by satellites: where the vehicle is, their errors, and none below the water.
#include <gmock/gmock.h>

#include "components/nav/SensorTask.hpp"
#include "tests/nav/Paths.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/TaskBench.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::nav {
namespace {

const types::Datum datum{54.5, 10.25, 40};

struct FixTest : test::TaskBench<FixTask, types::Pose, types::Fix> {
    FixTest() : TaskBench(&FixTask::pose, &FixTask::fix) {}
    void SetUp() override {
        if (!test::refused([] { geodetic(datum, {}); }).empty()) GTEST_SKIP() << "this build has no GeographicLib";
    }
    /** Returns where a fix is in the world. */
    static glm::dvec3 inWorld(const types::Fix& fix) {
        return types::Axes{types::WorldFrame::Enu}.rockFromWorld(eastNorthUp(datum, fix.place()));
    }
};

TEST_F(FixTest, AFixIsThePlaceOfTheAntenna) {
    startWith({.sensor = {.mount = {.position = {0.5, 0, 1}}}, .datum = datum, .water_surface = -100});
    const types::Fix fix = answerTo(poseAt(3, {100, -50, -20}, turned(90)));
    EXPECT_EQ(fix.time, types::Time::fromSeconds(3));
    EXPECT_EQ(fix.kind, types::FixKind::Autonomous);
    EXPECT_LT(glm::distance(inWorld(fix), {100, -49.5, -19}), 1e-8) << "half a metre to the west";
    EXPECT_GT(fix.latitude, 54.5) << "x is north";
    EXPECT_GT(fix.longitude, 10.25) << "y is west";
    EXPECT_NEAR(fix.altitude, 21, 1e-2);
    EXPECT_EQ(fix.deviation_latitude, 0);
}

TEST_F(FixTest, TheAntennaReceivesNothingBelowTheWater) {
    test::Reader<types::Pose> positions;
    task_.position_samples.connectTo(positions.port, framework::ConnPolicy::buffer(4));
    startWith({.sensor = {.mount = {.position = {0, 0, 0.5}}}, .datum = datum, .water_surface = 2});
    for (const auto& [z, has_fix] : {std::pair(1.49, false), std::pair(1.5, true), std::pair(3.0, true)}) {
        const types::Fix fix = answerTo(poseAt(z, {0, 0, z}));
        EXPECT_EQ(fix.time, types::Time::fromSeconds(z));
        EXPECT_EQ(fix.hasPosition(), has_fix) << z;
        EXPECT_EQ(std::isnan(fix.latitude), !has_fix);
        EXPECT_EQ(std::isnan(fix.deviation_altitude), !has_fix);
        types::Pose sample;
        ASSERT_TRUE(positions.port.readNew(sample));
        EXPECT_EQ(std::isnan(sample.position.x), !has_fix);
    }
}

TEST_F(FixTest, ErrorsHaveTheConfiguredDeviations) {
    FixReceiver receiver(
        {.datum = datum, .errors = {.horizontal = 2, .vertical = 3, .wander_horizontal = 1.5, .wander_time = 5}});
    glm::dvec3 sum(0), squares(0), steps(0), before(0);
    constexpr int count = 40'000;
    for (int i = 0; i < count; ++i) {
        const types::Pose measured = receiver.measure(poseAt(i, {10, 20, 30}));
        EXPECT_EQ(measured.cov_position[0][0], 2 * 2 + 1.5 * 1.5);
        EXPECT_EQ(measured.cov_position[2][2], 9);
        EXPECT_EQ(measured.cov_position[0][1], 0);
        const glm::dvec3 error = measured.position - glm::dvec3(10, 20, 30);
        sum += error;
        squares += error * error;
        if (i > 0) steps += (error - before) * (error - before);
        before = error;
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sum[axis] / count, 0, 0.1);
        EXPECT_NEAR(std::sqrt(squares[axis] / count), axis == 2 ? 3 : 2.5, 0.06);
    }
    // A step of white noise has twice its variance; one of the wandering 2 s^2 (1 - exp(-dt / T)).
    EXPECT_NEAR(steps.x / count, 2 * 4 + 2 * 2.25 * (1 - std::exp(-0.2)), 0.2);
}

TEST_F(FixTest, TheSameSeedAndPosesGiveTheSameBits) {
    startWith({.datum = datum, .errors = {.horizontal = 1, .vertical = 2, .wander_horizontal = 3}});
    const auto run = [&] {
        std::vector<double> readings;
        for (int i = 1; i < 50; ++i) readings.push_back(answerTo(poseAt(i, {0, 0, 10})).latitude);
        return readings;
    };
    const std::vector<double> first = run();
    ASSERT_TRUE(task_.stop() && task_.start());
    EXPECT_EQ(run(), first);
    EXPECT_NE(first[0], first[1]);
}

TEST_F(FixTest, ThePeriodSelectsFixes) {
    startWith({.sensor = {.period = 1}, .datum = datum});
    int count = 0;
    for (int i = 0; i < 100; ++i) count += !answerTo(poseAt(0.1 * i, {0, 0, 1})).time.isNull() || i == 0;
    EXPECT_EQ(count, 10);
}

TEST_F(FixTest, AWorldWithoutADatumIsRefused) {
    EXPECT_THAT(test::countRefusals(task_),
                testing::ElementsAre(testing::HasSubstr("datum: is missing; give the deployment")));
    EXPECT_FALSE(task_.configure());
    EXPECT_THAT(task_.lastError(), testing::HasSubstr("is missing"));
}

TEST_F(FixTest, ExtremePlacesGiveFiniteFixesOrNone) {
    for (const types::Datum& extreme : {types::Datum{90, 0, 0}, {-90, 77, 0}, {0, 180, 0}, {0, -180, -12'000}})
        for (const double far : {0.0, 1e-300, 1e4, 1e7, 1e300}) {
            FixReceiver receiver({.datum = extreme});
            const types::Fix fix = makeFix(receiver.measure(poseAt(1, {far, -far, far})), extreme);
            if (!fix.hasPosition()) continue;
            EXPECT_LE(std::abs(fix.latitude), 90);
            EXPECT_LE(std::abs(fix.longitude), 180);
            EXPECT_TRUE(std::isfinite(fix.altitude));
            if (far < 1e5) {
                EXPECT_NEAR(eastNorthUp(extreme, fix.place()).z, far, 1e-6);
            }
        }
    startWith({.datum = datum});
    answerTo(poseAt(1, glm::dvec3(std::nan(""))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_TRUE(answerTo(poseAt(2, {})).hasPosition());
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

}  // namespace
}  // namespace insonify::nav
