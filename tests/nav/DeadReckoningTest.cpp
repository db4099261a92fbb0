// Dead reckoning with sensors without errors returns to its start, by velocities and by accelerations.
#include <gtest/gtest.h>

#include "components/nav/Dvl.hpp"
#include "components/nav/ErrorModel.hpp"
#include "components/nav/Imu.hpp"
#include "components/nav/Pressure.hpp"
#include "components/pose/Trajectory.hpp"
#include "tests/nav/Paths.hpp"

namespace insonify::nav {
namespace {

/** A survey of two minutes that ends at its start: a figure of eight at 1 m/s, rolling and diving. */
pose::Trajectory survey() {
    std::vector<pose::Waypoint> waypoints;
    for (int i = 0; i <= 120; ++i) {
        const double angle = 2 * std::numbers::pi * i / 120;
        const double x = 20 * std::sin(angle), y = 10 * std::sin(2 * angle);
        const double heading = std::atan2(20 * std::cos(2 * angle), 20 * std::cos(angle));
        waypoints.push_back({.time = static_cast<double>(i),
                             .position = {x, y, -6 + std::sin(3 * angle)},
                             .roll_deg = 5 * std::sin(20 * angle),
                             .pitch_deg = 3 * std::cos(13 * angle),
                             .yaw_deg = heading * 180 / std::numbers::pi});
    }
    return pose::Trajectory(waypoints, true);
}

/** Returns motions at 100 Hz along the survey. */
std::vector<Motion> computeMotions(const pose::Trajectory& path, const types::Mount& mount) {
    MotionTracker tracker(mount);
    std::vector<Motion> motions;
    for (int i = 0; i <= 12'000; ++i) {
        types::Pose body = path.at(i * 0.01);
        body.time = {1'000'000 + i * 10'000};
        if (const auto motion = tracker.take(body)) motions.push_back(*motion);
    }
    return motions;
}

TEST(DeadReckoningTest, VelocitiesAndAttitudesLeadBackToTheStart) {
    const std::vector<Motion> motions = computeMotions(survey(), {});
    const Dvl log({});
    const Bottom bottom(-20.0);
    Imu unit({});
    glm::dvec3 place = motions[0].position, before{0};
    double farthest = 0;
    for (size_t i = 0; i < motions.size(); ++i) {
        types::Dvl reported;
        log.measure(motions[i], bottom, reported);
        ASSERT_TRUE(reported.hasBottomLock());
        const glm::dvec3 velocity = unit.measure(motions[i]).orientation * reported.velocity;
        if (i > 0) place += 0.005 * (before + velocity);
        before = velocity;
        farthest = std::max(farthest, glm::distance(place, motions[i].position));
    }
    EXPECT_LT(farthest, 1e-4) << "on the way";
    EXPECT_LT(glm::distance(place, motions.back().position), 1e-4);
    EXPECT_LT(glm::distance(place, motions.front().position), 0.05) << "two poses short of the whole way";
}

TEST(DeadReckoningTest, AccelerationsAndRatesLeadBackToTheStart) {
    const types::Mount mount{.position = {0.4, -0.1, 0.2}, .roll_deg = 3, .pitch_deg = -2, .yaw_deg = 30};
    const std::vector<Motion> motions = computeMotions(survey(), mount);
    Imu unit({});
    const glm::dvec3 gravity(0, 0, -normalGravity(45));
    glm::dquat attitude = motions[0].orientation;
    glm::dvec3 place = motions[0].position, velocity = motions[0].velocity;
    types::Imu before = unit.measure(motions[0]);
    double maximum = 0;
    for (size_t i = 1; i < motions.size(); ++i) {
        const types::Imu now = unit.measure(motions[i]);
        const glm::dvec3 turn = 0.005 * (before.angular_velocity + now.angular_velocity);
        const glm::dvec3 force_before = attitude * before.linear_acceleration;
        if (const double angle = glm::length(turn); angle > 0)
            attitude = glm::normalize(attitude * glm::angleAxis(angle, turn / angle));
        const glm::dvec3 acceleration = (force_before + attitude * now.linear_acceleration) / 2.0 + gravity;
        place += 0.01 * velocity + 0.5e-4 * acceleration;
        velocity += 0.01 * acceleration;
        before = now;
        maximum = std::max(maximum, glm::distance(place, motions[i].position));
    }
    const double misalignment = 2 * std::acos(std::min(1.0, std::abs(glm::dot(attitude, motions.back().orientation))));
    std::cout << "inertial: at most " << maximum << " m off, attitude " << misalignment << " rad\n";
    EXPECT_LT(misalignment, 1e-4);
    EXPECT_LT(maximum, 1) << "two minutes without any aid";
}

TEST(DeadReckoningTest, PressuresMatchTheDepthOfThePath) {
    const PressureConfig config;
    PressureGauge gauge(config);
    const pose::Trajectory path = survey();
    for (int i = 1; i < 120; ++i) {
        types::Pose body = path.at(i);
        body.time = types::Time::fromSeconds(i);
        EXPECT_NEAR(depthSample(gauge.measure(body), config).position.z, body.position.z, 1e-3);
    }
}

}  // namespace
}  // namespace insonify::nav
