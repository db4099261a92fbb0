#pragma once
#include <array>

#include "components/nav/ImuConfig.hpp"
#include "components/nav/Motion.hpp"
#include "types/Imu.hpp"

namespace insonify::nav {

/** What an inertial unit without errors feels, in its axes. */
struct InertialTruth {
    glm::dvec3 specific_force;  ///< Acceleration less gravity: at rest +g upwards [m/s^2].
    glm::dvec3 angular_rate;    ///< Of the unit, against the stars where the earth turns [rad/s].
};
/** @param gravity positive down [m/s^2]; @param earth rate of the earth in the world, 0 for a world at rest [rad/s]. */
InertialTruth inertialTruth(const Motion& motion, double gravity, const glm::dvec3& earth);

/** An inertial unit with its errors: attitude, angular rate and specific force. */
class Imu {
public:
    explicit Imu(const ImuConfig& config);
    /** Covariances are those of noise, wandering biases and steps; that of the attitude of its errors. */
    types::Imu measure(const Motion& motion);

private:
    using Triad = std::array<Axis, 3>;
    static Triad triad(const AxisErrors& errors, uint64_t seed, uint64_t first_channel);
    glm::dvec3 measured(Triad& triad, const glm::dvec3& truth, const glm::dvec3& bias, const Motion& motion);
    void tellAttitude(const Motion& motion, types::Imu& imu);

    ImuConfig config_;
    double gravity_;
    glm::dvec3 earth_;
    Triad gyroscope_, accelerometer_;
    std::array<WanderingBias, 3> attitude_errors_;  ///< About the axes of the world [rad].
    double interval_ = 0;                           ///< That a measurement averages over [s].
};

/** Without the attitude, as Rock has it. */
types::ImuSensors sensorsOf(const types::Imu& imu);
/** The attitude and the angular rate, as Rock has them: of frame "imu" in "world"; its place is unknown. */
types::Pose orientationOf(const types::Imu& imu);

}  // namespace insonify::nav
