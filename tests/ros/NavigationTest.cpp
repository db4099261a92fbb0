// Measurements of navigation sensors as messages, in the axes of each world.
#include <gmock/gmock.h>

#include <cmath>

#include "components/ros/Poses.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::ros {
namespace {

constexpr double unknown = types::Pose::unknown;

/** A unit that looks west, 90 degrees to port of north, at rest except for a turn to port. */
types::Imu smallImu() {
    types::Imu imu;
    imu.time = {2'000'001};
    imu.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 0, 1));
    imu.cov_orientation = {{0.01, 0, 0}, {0, 0.02, 0}, {0, 0, 0.03}};
    imu.angular_velocity = {0.1, 0.2, 0.3};
    imu.cov_angular_velocity = {{1, 0.5, 0}, {0.5, 2, 0}, {0, 0, 3}};
    imu.linear_acceleration = {0.25, -0.5, 9.75};
    imu.cov_linear_acceleration = {{4, 0, 0}, {0, 5, 0}, {0, 0, 6}};
    return imu;
}

Imu makeImu(const auto& sample, WorldFrame frame) {
    Imu message;
    convert(sample, frame, "imu", message);
    return message;
}

/** Returns the unit's x axis in the message's world. */
glm::dvec3 ahead(const Imu& message) {
    const Quaternion& q = message.orientation;
    return glm::dquat(q.w, q.x, q.y, q.z) * glm::dvec3(1, 0, 0);
}

TEST(NavigationTest, AnImuHasTheSameAttitudeInEveryWorld) {
    EXPECT_LT(glm::distance(ahead(makeImu(smallImu(), WorldFrame::AsIs)), {0, 1, 0}), 1e-15);
    EXPECT_LT(glm::distance(ahead(makeImu(smallImu(), WorldFrame::Enu)), {-1, 0, 0}), 1e-15);
    EXPECT_LT(glm::distance(ahead(makeImu(smallImu(), WorldFrame::Ned)), {0, -1, 0}), 1e-15);
}

TEST(NavigationTest, AnImuMeasuresInTheAxesOfItsBody) {
    const Imu enu = makeImu(smallImu(), WorldFrame::Enu), ned = makeImu(smallImu(), WorldFrame::Ned);
    EXPECT_EQ(enu.header.frame_id, "imu");
    EXPECT_EQ(enu.header.stamp, (Time{2, 1000}));
    EXPECT_EQ(enu.linear_acceleration, (Vector3{0.25, -0.5, 9.75}));
    EXPECT_EQ(ned.linear_acceleration, (Vector3{0.25, 0.5, -9.75})) << "z down: gravity is felt upwards";
    EXPECT_EQ(ned.angular_velocity, (Vector3{0.1, -0.2, -0.3}));
    EXPECT_EQ(ned.angular_velocity_covariance[1], -0.5);
    EXPECT_NEAR(enu.orientation_covariance[0], 0.01, 1e-15) << "about east, along which it looks";
    EXPECT_NEAR(enu.orientation_covariance[4], 0.02, 1e-15);
}

TEST(NavigationTest, RestoresAnImuFromEveryWorld) {
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned}) {
        const types::Imu imu = smallImu();
        types::Imu again;
        convert(makeImu(imu, frame), frame, again);
        EXPECT_LT(glm::length(again.orientation - imu.orientation), 1e-15);
        EXPECT_EQ(again.angular_velocity, imu.angular_velocity);
        EXPECT_EQ(again.linear_acceleration, imu.linear_acceleration);
        for (int i = 0; i < 3; ++i) {
            EXPECT_LT(glm::distance(again.cov_orientation[i], imu.cov_orientation[i]), 1e-15);
            EXPECT_EQ(again.cov_angular_velocity[i], imu.cov_angular_velocity[i]);
            EXPECT_EQ(again.cov_linear_acceleration[i], imu.cov_linear_acceleration[i]);
        }
    }
}

TEST(NavigationTest, RocksSensorsHaveNoAttitude) {
    types::ImuSensors sensors, again;
    sensors.acc = {1, 2, 3};
    const Imu message = makeImu(sensors, WorldFrame::Enu);
    EXPECT_EQ(message.orientation_covariance[0], -1);
    EXPECT_EQ(message.orientation, Quaternion{});
    EXPECT_EQ(message.angular_velocity_covariance[0], -1) << "a rate that is not known";
    EXPECT_EQ(message.linear_acceleration_covariance[0], 0) << "known, of unknown covariance";
    convert(message, WorldFrame::Enu, again);
    EXPECT_EQ(again.acc, sensors.acc);
    EXPECT_TRUE(std::isnan(again.gyro.x) && std::isnan(again.mag.x));
}

/** A DVL with a lost beam that moves ahead and to port, and rises. */
types::Dvl smallDvl() {
    types::Dvl dvl;
    dvl.velocity = {3, 4, 0.5};
    dvl.cov_velocity = {{1, 0.5, 0.25}, {0.5, 2, 0}, {0.25, 0, 3}};
    dvl.altitude = 10;
    dvl.beam_directions = {{0.5, 0.25, -1}, {-0.5, 0.25, -1}, {-0.5, -0.25, -1}, {0.5, -0.25, -1}};
    dvl.beam_ranges = {11, 12, unknown, 14};
    dvl.beam_velocities = {0.25, 0.5, unknown, -1};
    dvl.beam_velocity_variances = {1, 2, unknown, 4};
    return dvl;
}

TEST(NavigationTest, ADvlLooksAlongTheZAxisOfItsMessage) {
    Dvl message;
    convert(smallDvl(), "dvl", message);
    EXPECT_EQ(message.velocity, (Vector3{3, -4, -0.5})) << "x ahead, y to starboard, z down";
    EXPECT_EQ(message.velocity_covar, (std::array<double, 9>{1, -0.5, -0.25, -0.5, 2, 0, -0.25, 0, 3}));
    EXPECT_EQ(message.velocity_mode, Dvl::bottom);
    EXPECT_DOUBLE_EQ(message.course_gnd, std::atan2(-4, 3));
    EXPECT_DOUBLE_EQ(message.speed_gnd, 5);
    EXPECT_EQ(message.num_good_beams, 3);
    EXPECT_TRUE(message.beam_ranges_valid && message.beam_velocities_valid);
    EXPECT_EQ(message.beam_unit_vec[0], (Vector3{0.5, -0.25, 1}));
    EXPECT_TRUE(std::isnan(message.range[2]) && std::isnan(message.beam_velocity[2]));
    EXPECT_THAT(message.beam_quality, testing::ElementsAre(1, 1, 0, 1));
    EXPECT_THAT(message.beam_velocity_covar, testing::ElementsAre(1, 2, -1, 4));
    EXPECT_THAT(message.range_covar, testing::Each(-1));
}

TEST(NavigationTest, ADvlWithoutBottomLockHasNoVelocity) {
    types::Dvl dvl = smallDvl();
    dvl.velocity = glm::dvec3(unknown);
    dvl.cov_velocity = types::Pose::unknownMatrix();
    Dvl message;
    convert(dvl, "dvl", message);
    EXPECT_FALSE(message.beam_velocities_valid);
    EXPECT_TRUE(std::isnan(message.velocity.x)) << "nobody is to take it for standing still";
    EXPECT_EQ(message.velocity_covar[0], -1);
    types::Dvl again;
    convert(message, again);
    EXPECT_FALSE(again.hasBottomLock());
    EXPECT_EQ(again.goodBeams(), 3u);
}

TEST(NavigationTest, RefusesADvlWithMoreOrOtherBeams) {
    types::Dvl dvl = smallDvl();
    Dvl message;
    dvl.beam_ranges.push_back(1);
    EXPECT_THROW(convert(dvl, "dvl", message), std::invalid_argument);
    dvl = smallDvl();
    dvl.beam_directions.resize(5);
    EXPECT_THROW(convert(dvl, "dvl", message), std::invalid_argument);
    convert(types::Dvl{}, "dvl", message);
    EXPECT_EQ(message.num_good_beams, 0);
}

TEST(NavigationTest, APressureIsInPascal) {
    FluidPressure message;
    convert(types::Pressure{201'325.5f, {2'000'000}}, "gauge", message);
    EXPECT_EQ(message.fluid_pressure, 201'325.5);
    EXPECT_EQ(message.variance, 0);
    EXPECT_EQ(message.header.frame_id, "gauge");
    types::Pressure again;
    convert(message, again);
    EXPECT_EQ(again.pascal, 201'325.5f);
    EXPECT_EQ(again.time, types::Time{2'000'000});
}

TEST(NavigationTest, AFixIsOnTheEllipsoidWithItsCovarianceEastNorthUp) {
    types::Fix fix;
    fix.time = {2'000'000};
    fix.kind = types::FixKind::Autonomous;
    fix.latitude = 54.5;
    fix.longitude = -10.25;
    fix.altitude = 3;
    fix.geoidal_separation = 40;
    fix.deviation_latitude = 2;
    fix.deviation_longitude = 3;
    fix.deviation_altitude = 5;
    NavSatFix message;
    convert(fix, "gps", message);
    EXPECT_EQ(message.header.frame_id, "gps");
    EXPECT_EQ(message.altitude, 43);
    EXPECT_THAT(message.position_covariance, testing::ElementsAre(9, 0, 0, 0, 4, 0, 0, 0, 25));
    EXPECT_EQ(message.position_covariance_type, 2);
    types::Fix again;
    convert(message, again);
    EXPECT_EQ(again.place(), fix.place());
    EXPECT_EQ(again.deviation_longitude, 3);
    fix.deviation_altitude = unknown;
    convert(fix, "gps", message);
    EXPECT_EQ(message.position_covariance_type, 0);
    convert(message, again);
    EXPECT_TRUE(std::isnan(again.deviation_latitude));
}

TEST(NavigationTest, TheKindOfAFixIsItsStatus) {
    using Kind = types::FixKind;
    const std::pair<Kind, int> all[] = {{Kind::NoSolution, -1}, {Kind::Autonomous, 0}, {Kind::Differential, 1},
                                        {Kind::Invalid, -1},    {Kind::RtkFixed, 2},   {Kind::RtkFloat, 2},
                                        {Kind::Autonomous2d, 0}};
    for (const auto& [kind, status] : all) {
        types::Fix fix;
        fix.kind = kind;
        fix.latitude = fix.longitude = 1;
        NavSatFix message;
        convert(fix, "gps", message);
        EXPECT_EQ(message.status.status, status);
        types::Fix again;
        convert(message, again);
        EXPECT_EQ(again.hasPosition(), fix.hasPosition());
    }
    types::Fix nowhere;
    nowhere.kind = Kind::Autonomous;
    NavSatFix message;
    convert(nowhere, "gps", message);
    EXPECT_EQ(message.status.status, -1) << "its latitude is unknown";
    message.status.status = -2;
    convert(message, nowhere);
    EXPECT_EQ(nowhere.kind, Kind::NoSolution) << "unknown, of newer messages";
}

}  // namespace
}  // namespace insonify::ros
