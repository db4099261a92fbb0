#pragma once
#include <glm/vec3.hpp>
#include <optional>

#include "components/nav/ErrorModel.hpp"
#include "components/nav/SensorConfig.hpp"

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

}  // namespace insonify::nav
