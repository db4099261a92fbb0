#include <gmock/gmock.h>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/SensorTask.hpp"
#include "tests/nav/Paths.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::nav {
namespace {

struct ImuTaskTest : test::TaskBench<ImuTask, types::Pose, types::Imu> {
    ImuTaskTest() : TaskBench(&ImuTask::pose, &ImuTask::imu) {}

    ImuConfig noisy() {
        ImuConfig config;
        config.gyroscope = {{{.noise_density = 1e-3, .bias_deviation = 1e-4}}};
        config.accelerometer = {{{.noise_density = 1e-2, .bias_deviation = 1e-3}}};
        config.attitude.heading_deviation_deg = 1;
        return config;
    }
    /** Returns the measurements of a second on a circle, with stamps from `first` on. */
    std::vector<types::Imu> reported(double first = 0) {
        std::vector<types::Imu> all;
        for (int i = 0; i < 100; ++i) {
            const double time = 1 + i * 0.01;
            if (time < first) continue;
            if (const types::Imu imu = answerTo(circle(5, 0.4)(time)); !imu.time.isNull()) all.push_back(imu);
        }
        return all;
    }
};

TEST_F(ImuTaskTest, MeasuresEachPoseWhenTheNextHasArrived) {
    startWith({});
    EXPECT_TRUE(answerTo(poseAt(1, {})).time.isNull());
    EXPECT_TRUE(answerTo(poseAt(1.01, {})).time.isNull());
    const types::Imu imu = answerTo(poseAt(1.02, {}));
    EXPECT_EQ(imu.time, types::Time::fromSeconds(1.01));
    EXPECT_NEAR(imu.linear_acceleration.z, normalGravity(45), 1e-9);
}

TEST_F(ImuTaskTest, WarnsThatPosesAreTooFarApart) {
    std::vector<std::string> reported;
    const auto environment = std::make_shared<framework::Environment>();
    environment->warn = [&](const std::string& text) { reported.push_back(text); };
    task_.setEnvironment(environment);
    startWith({});
    for (const double time : {1, 3, 5, 7}) EXPECT_TRUE(answerTo(poseAt(time, {})).time.isNull());
    EXPECT_THAT(reported, testing::ElementsAre(testing::StartsWith("task: poses 2 s apart give no motion")));
}

TEST_F(ImuTaskTest, RocksSamplesHaveTheSameValues) {
    test::Reader<types::ImuSensors> sensors;
    test::Reader<types::Pose> orientations;
    task_.calibrated_sensors.connectTo(sensors.port, framework::ConnPolicy::buffer(4));
    task_.orientation_samples.connectTo(orientations.port, framework::ConnPolicy::buffer(4));
    startWith(noisy());
    answerTo(circle(5, 0.4)(1));
    answerTo(circle(5, 0.4)(1.01));
    const types::Imu imu = answerTo(circle(5, 0.4)(1.02));
    types::ImuSensors sensor;
    types::Pose orientation;
    ASSERT_TRUE(sensors.port.readNew(sensor) && orientations.port.readNew(orientation));
    EXPECT_EQ(sensor.acc, imu.linear_acceleration);
    EXPECT_EQ(sensor.gyro, imu.angular_velocity);
    EXPECT_TRUE(std::isnan(sensor.mag.x));
    EXPECT_EQ(orientation.orientation, imu.orientation);
    EXPECT_TRUE(std::isnan(orientation.position.x));
    EXPECT_EQ(orientation.time, imu.time);
}

TEST_F(ImuTaskTest, TheSameSeedAndPosesGiveTheSameBits) {
    startWith(noisy());
    const std::vector<types::Imu> first = reported();
    ASSERT_EQ(first.size(), 98u);
    ASSERT_TRUE(task_.stop() && task_.start());
    const std::vector<types::Imu> again = reported();
    ASSERT_EQ(again.size(), first.size());
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(again[i].angular_velocity, first[i].angular_velocity);
        EXPECT_EQ(again[i].linear_acceleration, first[i].linear_acceleration);
        EXPECT_EQ(again[i].orientation, first[i].orientation);
    }
    ImuConfig other = noisy();
    other.sensor.seed = 2;
    task_.stop();
    startWith(other);
    EXPECT_NE(reported()[0].angular_velocity, first[0].angular_velocity);
}

TEST_F(ImuTaskTest, NoiseWithoutBiasesDependsOnlyOnTheStamp) {
    ImuConfig config;
    config.gyroscope.noise_density = 1e-3;
    startWith(config);
    const types::Imu last = reported().back();
    ASSERT_TRUE(task_.stop() && task_.start());
    EXPECT_EQ(reported(1.5).back().angular_velocity, last.angular_velocity);
}

TEST_F(ImuTaskTest, APeriodGivesFewerSamples) {
    ImuConfig config;
    config.sensor.period = 0.05;
    startWith(config);
    EXPECT_EQ(reported().size(), 20u);
}

TEST_F(ImuTaskTest, RejectsAPoseThatIsNotFiniteUntilAValidPose) {
    startWith({});
    answerTo(poseAt(1, {}));
    answerTo(poseAt(1.01, {}));
    EXPECT_TRUE(answerTo(poseAt(1.02, glm::dvec3(std::nan("")))).time.isNull());
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_THAT(task_.lastError(), testing::HasSubstr("not finite"));
    EXPECT_TRUE(answerTo(poseAt(1.02, {}, glm::dquat(0, 0, 0, 0))).time.isNull()) << "no length";
    EXPECT_EQ(answerTo(poseAt(1.03, {})).time, types::Time::fromSeconds(1.01));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

}  // namespace
}  // namespace insonify::nav
