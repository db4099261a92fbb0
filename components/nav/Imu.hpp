#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <optional>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/Motion.hpp"
#include "types/samples/Imu.hpp"

namespace insonify::nav {

/** Errors of three equal axes. */
struct TriadConfig : AxisErrors {
    glm::dvec3 bias{0};
};

struct GyroscopeConfig : TriadConfig {
    static void describe(auto& self, auto& visit) {
        visit({"noise_density", "rad/s/sqrt(Hz)", "density of white noise: the angular random walk", 0, 1},
              self.noise_density);
        visit({"bias", "rad/s", "constant", -10, 10}, self.bias);
        visit({"bias_deviation", "rad/s", "of the wandering bias; the Allan deviation is at most 0.618 of it", 0, 1},
              self.bias_deviation);
        visit({"bias_time", "s", "correlation time of the wandering bias", 1e-3, 1e9}, self.bias_time);
        visit({"resolution", "rad/s", "of the readings; 0: continuous", 0, 1}, self.resolution);
        visit({"range", "rad/s", "max magnitude of the readings; absent: unlimited", 1e-6, 1e6}, self.range);
    }
};

struct AccelerometerConfig : TriadConfig {
    static void describe(auto& self, auto& visit) {
        visit({"noise_density", "m/s^2/sqrt(Hz)", "density of white noise: the velocity random walk", 0, 10},
              self.noise_density);
        visit({"bias", "m/s^2", "constant", -100, 100}, self.bias);
        visit({"bias_deviation", "m/s^2", "of the wandering bias; the Allan deviation is at most 0.618 of it", 0, 10},
              self.bias_deviation);
        visit({"bias_time", "s", "correlation time of the wandering bias", 1e-3, 1e9}, self.bias_time);
        visit({"resolution", "m/s^2", "of the readings; 0: continuous", 0, 10}, self.resolution);
        visit({"range", "m/s^2", "max magnitude of the readings; absent: unlimited", 1e-3, 1e6}, self.range);
    }
};

/** Wandering errors of the attitude that the unit computes, about level axes and about the vertical. */
struct AttitudeConfig {
    double tilt_deviation_deg = 0;
    double heading_deviation_deg = 0;
    double error_time = 60;

    static void describe(auto& self, auto& visit) {
        visit({"tilt_deviation_deg", "deg", "of the error about each of the world's level axes", 0, 90},
              self.tilt_deviation_deg);
        visit({"heading_deviation_deg", "deg", "of the error about the vertical", 0, 180}, self.heading_deviation_deg);
        visit({"error_time", "s", "correlation time of these errors", 1e-3, 1e9}, self.error_time);
    }
};

struct ImuConfig {
    SensorConfig sensor{};
    double latitude_deg = 45;
    std::optional<double> gravity{};
    bool earth_rotation = false;
    GyroscopeConfig gyroscope{};
    AccelerometerConfig accelerometer{};
    AttitudeConfig attitude{};

    static void describe(auto& self, auto& visit) {
        SensorConfig::describe(self.sensor, visit, "of the unit in the body",
                               "between measurements; 0: a measurement per pose");
        visit({"latitude_deg", "deg", "of the world, for gravity and the rotation of the earth", -90, 90},
              self.latitude_deg);
        visit({"gravity", "m/s^2", "instead of WGS 84's normal gravity", 0, 1000}, self.gravity);
        visit({"earth_rotation", "",
               "the gyroscope measures the rotation of the earth, and the accelerometer the Coriolis force"},
              self.earth_rotation);
        visit({"gyroscope", "", "its errors; absent: none"}, self.gyroscope);
        visit({"accelerometer", "", "its errors; absent: none"}, self.accelerometer);
        visit({"attitude", "", "errors of the attitude; absent: none"}, self.attitude);
    }
};

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
types::ImuSensors getSensors(const types::Imu& imu);
/** Returns attitude and angular rate as Rock's pose of frame "imu" in "world"; its position is unknown. */
types::Pose getOrientation(const types::Imu& imu);

}  // namespace insonify::nav
