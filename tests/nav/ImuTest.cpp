#include <gmock/gmock.h>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/Imu.hpp"
#include "tests/nav/Allan.hpp"
#include "tests/nav/Paths.hpp"

namespace insonify::nav {
namespace {

types::Imu measured(const Motion& motion, const ImuConfig& config = {}) { return Imu(config).measure(motion); }

TEST(ImuTest, NormalGravityMatchesWgs84) {
    EXPECT_NEAR(normalGravity(0), 9.7803253359, 1e-10);
    EXPECT_NEAR(normalGravity(90), 9.8321849378, 1e-9);
    EXPECT_NEAR(normalGravity(-90), 9.8321849378, 1e-9);
    EXPECT_NEAR(normalGravity(45), 9.8061977692, 1e-8);
}

TEST(ImuTest, MeasuresGravityUpwardsAtRestInAnyAttitude) {
    const double g = normalGravity(45);
    EXPECT_LT(glm::distance(measured(atRest(1)).linear_acceleration, {0, 0, g}), 1e-12);
    EXPECT_LT(glm::distance(measured(atRest(1, turned(0, 0, 180))).linear_acceleration, {0, 0, -g}), 1e-12);
    EXPECT_LT(glm::distance(measured(atRest(1, turned(70, 90))).linear_acceleration, {-g, 0, 0}), 1e-12)
        << "it looks down: up is behind it";
    EXPECT_LT(glm::distance(measured(atRest(1, turned(20, 0, 90))).linear_acceleration, {0, g, 0}), 1e-12)
        << "starboard is down";
    EXPECT_LT(glm::length(measured(atRest(1, turned(20, 30, 40))).angular_velocity), 1e-12);
    EXPECT_EQ(measured(atRest(1), {.gravity = 3.7}).linear_acceleration.z, 3.7);
    EXPECT_EQ(measured(atRest(1), {.latitude_deg = 0}).linear_acceleration.z, normalGravity(0));
}

TEST(ImuTest, MeasuresNoForceInFreeFall) {
    const double g = normalGravity(45);
    const Path path = [&](double t) { return poseAt(t, {0, 0, -g * t * t / 2}, turned(10, 20, 30)); };
    EXPECT_LT(glm::length(measured(motionAt(path, 2, 0.01)).linear_acceleration), 1e-9);
}

TEST(ImuTest, MeasuresCentripetalAccelerationOnACircle) {
    const double radius = 6, rate = 0.5, step = 0.001;
    const types::Imu imu = measured(motionAt(circle(radius, rate), 3, step));
    EXPECT_NEAR(imu.linear_acceleration.y, radius * rate * rate, 1e-6) << "v^2 / r, to port";
    EXPECT_NEAR(imu.linear_acceleration.x, 0, 1e-6);
    EXPECT_LT(glm::distance(imu.angular_velocity, {0, 0, rate}), 1e-12);
}

TEST(ImuTest, MeasuresTheRotationOfTheEarthIfConfigured) {
    const ImuConfig config{.latitude_deg = 30, .earth_rotation = true};
    const double rate = 7.292115e-5;
    const glm::dvec3 north = measured(atRest(1), config).angular_velocity;
    EXPECT_LT(glm::distance(north, {rate * std::cos(types::radians(30)), 0, rate / 2}), 1e-15);
    const glm::dvec3 west = measured(atRest(1, turned(90)), config).angular_velocity;
    EXPECT_LT(glm::distance(west, {0, -rate * std::cos(types::radians(30)), rate / 2}), 1e-15)
        << "north is to starboard";
    const Path to_north = [](double t) { return poseAt(t, {10 * t, 0, 0}); };
    EXPECT_NEAR(measured(motionAt(to_north, 1, 0.01), config).linear_acceleration.y, 2 * rate / 2 * 10, 1e-9)
        << "Coriolis: held on its way north, the unit is pushed to the west";
}

TEST(ImuTest, NoiseHasItsDensityAndReportedCovarianceOnEveryAxis) {
    ImuConfig config;
    config.sensor.seed = 3;
    config.gyroscope.noise_density = 1e-3;
    config.accelerometer.noise_density = 2e-2;
    Imu unit(config);
    constexpr size_t count = 20'000;
    std::array<std::vector<double>, 6> series;
    types::Imu imu;
    Motion motion = atRest(1);
    motion.interval = 0.01;
    for (size_t i = 0; i < count; ++i) {
        motion.time = motion.time + types::Time::fromSeconds(0.01);
        imu = unit.measure(motion);
        for (int axis = 0; axis < 3; ++axis) {
            series[static_cast<size_t>(axis)].push_back(imu.angular_velocity[axis]);
            series[static_cast<size_t>(axis) + 3].push_back(imu.linear_acceleration[axis]);
        }
    }
    EXPECT_DOUBLE_EQ(imu.cov_angular_velocity[0][0], 1e-6 / 0.01);
    EXPECT_DOUBLE_EQ(imu.cov_linear_acceleration[2][2], 4e-4 / 0.01);
    for (size_t i = 0; i < 6; ++i)
        for (const size_t average : {1, 30})
            EXPECT_NEAR(allanDeviation(series[i], average) /
                            allanOfNoise(i < 3 ? 1e-3 : 2e-2, 0.01 * static_cast<double>(average)),
                        1, 5 / std::sqrt(2 * (count / static_cast<double>(average) - 1)));
}

TEST(ImuTest, ErrorsOfTheAttitudeHaveTheirDeviations) {
    ImuConfig config;
    config.attitude = {.tilt_deviation_deg = 0.5, .heading_deviation_deg = 2, .error_time = 0.1};
    Imu unit(config);
    glm::dvec3 squares{0};
    constexpr int count = 20'000;
    Motion motion = atRest(1, turned(90));
    types::Imu imu;
    for (int i = 0; i < count; ++i) {
        motion.time = motion.time + types::Time::fromSeconds(1);
        imu = unit.measure(motion);
        const glm::dquat error = imu.orientation * glm::conjugate(motion.orientation);
        squares += 4.0 * glm::dvec3(error.x * error.x, error.y * error.y, error.z * error.z);
    }
    const double bound = 5 * std::sqrt(2.0 / count) + 2e-3;  // plus the difference of a sine and its angle
    EXPECT_NEAR(squares.x / count / std::pow(types::radians(0.5), 2), 1, bound);
    EXPECT_NEAR(squares.y / count / std::pow(types::radians(0.5), 2), 1, bound);
    EXPECT_NEAR(squares.z / count / std::pow(types::radians(2), 2), 1, bound);
    EXPECT_NEAR(imu.cov_orientation[2][2], std::pow(types::radians(2), 2), 1e-15);
}

TEST(ImuTest, ReadingsAreLimitedByTheRange) {
    ImuConfig config;
    config.accelerometer.range = 16 * 9.81;
    config.gyroscope.range = 30;
    Motion wild = atRest(1);
    wild.acceleration = {1e200, -1e200, 0};
    wild.angular_rate = {1e200, 0, -1e200};
    const types::Imu imu = measured(wild, config);
    EXPECT_EQ(imu.linear_acceleration.x, 16 * 9.81);
    EXPECT_EQ(imu.linear_acceleration.y, -16 * 9.81);
    EXPECT_EQ(imu.angular_velocity, glm::dvec3(30, 0, -30));
}

}  // namespace
}  // namespace insonify::nav
