#include "components/nav/Imu.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "components/nav/ErrorModel.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::nav {
namespace {

constexpr uint64_t first_of_gyroscope = 0, first_of_accelerometer = 3, first_of_attitude = 100;

WanderingBias attitudeError(const ImuConfig& config, uint64_t axis) {
    const AttitudeConfig& errors = config.attitude;
    const double degrees = axis == 2 ? errors.heading_deviation_deg : errors.tilt_deviation_deg;
    return {types::radians(degrees), errors.error_time, config.sensor.randomSeed(), first_of_attitude + axis};
}

/** Returns the rotation of a rotation vector [rad]. */
glm::dquat computeTurn(const glm::dvec3& vector) {
    const double angle = glm::length(vector);
    return angle > 0 ? glm::angleAxis(angle, vector / angle) : glm::dquat(1, 0, 0, 0);
}

}  // namespace

InertialTruth inertialTruth(const Motion& motion, double gravity, const glm::dvec3& earth) {
    const glm::dquat sensor_from_world = glm::conjugate(motion.orientation);
    const glm::dvec3 coriolis = 2.0 * glm::cross(earth, motion.velocity);
    return {sensor_from_world * (motion.acceleration + coriolis + glm::dvec3(0, 0, gravity)),
            motion.angular_rate + sensor_from_world * earth};
}

Imu::Imu(const ImuConfig& config)
    : config_(config),
      gravity_(config.gravity.value_or(normalGravity(config.latitude_deg))),
      earth_(config.earth_rotation ? earthRotation(config.latitude_deg) : glm::dvec3(0)),
      gyroscope_(triad(config.gyroscope, config.sensor.randomSeed(), first_of_gyroscope)),
      accelerometer_(triad(config.accelerometer, config.sensor.randomSeed(), first_of_accelerometer)),
      attitude_errors_{attitudeError(config, 0), attitudeError(config, 1), attitudeError(config, 2)} {}

Imu::Triad Imu::triad(const AxisErrors& errors, uint64_t seed, uint64_t first_channel) {
    return {Axis(errors, seed, first_channel), Axis(errors, seed, first_channel + 1),
            Axis(errors, seed, first_channel + 2)};
}

glm::dvec3 Imu::measured(Triad& triad, const glm::dvec3& truth, const glm::dvec3& bias, const Motion& motion) {
    glm::dvec3 reported;
    for (int i = 0; i < 3; ++i)
        reported[i] = triad[static_cast<size_t>(i)].measure(truth[i], bias[i], motion.time, interval_);
    return reported;
}

void Imu::writeAttitude(const Motion& motion, types::Imu& imu) {
    glm::dvec3 error, variance;
    for (int i = 0; i < 3; ++i) {
        error[i] = attitude_errors_[static_cast<size_t>(i)].at(motion.time);
        const AttitudeConfig& errors = config_.attitude;
        const double deviation = types::radians(i == 2 ? errors.heading_deviation_deg : errors.tilt_deviation_deg);
        variance[i] = deviation * deviation;
    }
    imu.orientation = computeTurn(error) * motion.orientation;
    const glm::dmat3 world_from_sensor = glm::mat3_cast(motion.orientation);
    const glm::dmat3 in_world{{variance.x, 0, 0}, {0, variance.y, 0}, {0, 0, variance.z}};
    imu.cov_orientation = glm::transpose(world_from_sensor) * in_world * world_from_sensor;
}

types::Imu Imu::measure(const Motion& motion) {
    interval_ = std::max(motion.interval, config_.sensor.period);
    const InertialTruth truth = inertialTruth(motion, gravity_, earth_);
    types::Imu imu;
    imu.time = motion.time;
    imu.angular_velocity = measured(gyroscope_, truth.angular_rate, config_.gyroscope.bias, motion);
    imu.linear_acceleration = measured(accelerometer_, truth.specific_force, config_.accelerometer.bias, motion);
    imu.cov_angular_velocity = glm::dmat3(computeVariance(config_.gyroscope, interval_));
    imu.cov_linear_acceleration = glm::dmat3(computeVariance(config_.accelerometer, interval_));
    writeAttitude(motion, imu);
    return imu;
}

types::ImuSensors getSensors(const types::Imu& imu) {
    types::ImuSensors sensors;
    sensors.time = imu.time;
    sensors.acc = imu.linear_acceleration;
    sensors.gyro = imu.angular_velocity;
    return sensors;
}

types::Pose getOrientation(const types::Imu& imu) {
    types::Pose pose;
    pose.time = imu.time;
    pose.source_frame = "imu";
    pose.target_frame = "world";
    pose.position = glm::dvec3(types::Pose::unknown);
    pose.orientation = imu.orientation;
    pose.cov_orientation = imu.cov_orientation;
    pose.angular_velocity = imu.angular_velocity;
    pose.cov_angular_velocity = imu.cov_angular_velocity;
    return pose;
}

}  // namespace insonify::nav
