#pragma once
#include <array>

#include "components/nav/ImuConfig.hpp"
#include "components/nav/Motion.hpp"
#include "types/Imu.hpp"

namespace insonify::nav {

/** The true inputs of an inertial unit, in its axes. */
struct InertialTruth {
    glm::dvec3 specific_force;  ///< Acceleration minus gravity: at rest +g upwards [m/s^2].
    glm::dvec3 angular_rate;    ///< Rate of the unit, relative to inertial space if the earth rotates [rad/s].
};
/** Returns the true inputs of an inertial unit.
 *  @param gravity positive down [m/s^2]
 *  @param earth rate of the earth in the world, 0 for a world at rest [rad/s] */
InertialTruth inertialTruth(const Motion& motion, double gravity, const glm::dvec3& earth);

/** An inertial unit with its errors: attitude, angular rate and specific force. */
class Imu {
public:
    explicit Imu(const ImuConfig& config);
    /** Returns a measurement. Its covariances contain noise, wandering biases and steps; that of the attitude contains
     *  the attitude errors. */
    types::Imu measure(const Motion& motion);

private:
    using Triad = std::array<Axis, 3>;
    static Triad triad(const AxisErrors& errors, uint64_t seed, uint64_t first_channel);
    glm::dvec3 measured(Triad& triad, const glm::dvec3& truth, const glm::dvec3& bias, const Motion& motion);
    void writeAttitude(const Motion& motion, types::Imu& imu);

    ImuConfig config_;
    double gravity_;
    glm::dvec3 earth_;
    Triad gyroscope_, accelerometer_;
    std::array<WanderingBias, 3> attitude_errors_;  ///< About the axes of the world [rad].
    double interval_ = 0;                           ///< Averaging time of a measurement [s].
};

/** Returns the measurement without the attitude, as Rock's type. */
types::ImuSensors sensorsOf(const types::Imu& imu);
/** Returns attitude and angular rate as Rock's pose of frame "imu" in "world"; its position is unknown. */
types::Pose orientationOf(const types::Imu& imu);

}  // namespace insonify::nav
