#pragma once
#include <optional>

#include "components/nav/SensorConfig.hpp"

namespace insonify::nav {

/** Errors of a pressure gauge. */
struct GaugeErrors {
    double noise = 0;
    double offset = 0;
    double drift_deviation = 0;
    double drift_time = 3600;
    double resolution = 0;

    static void describe(auto& self, auto& visit) {
        visit({"noise", "Pa", "deviation, from measurement to measurement", 0, 1e7}, self.noise);
        visit({"offset", "Pa", "constant", -1e7, 1e7}, self.offset);
        visit({"drift_deviation", "Pa", "deviation of an offset that wanders about 0", 0, 1e7}, self.drift_deviation);
        visit({"drift_time", "s", "correlation time of the drift", 1e-3, 1e9}, self.drift_time);
        visit({"resolution", "Pa", "of the readings; 0: continuous", 0, 1e7}, self.resolution);
    }
};

struct PressureConfig {
    SensorConfig sensor{};
    double water_surface = 0;
    double latitude_deg = 45;
    std::optional<double> density{};
    double atmosphere = 101325;
    std::optional<double> max_pressure{};
    GaugeErrors errors{};

    static void describe(auto& self, auto& visit) {
        SensorConfig::describe(self.sensor, visit, "of the gauge in the body",
                               "between measurements; 0: a measurement per pose");
        visit({"water_surface", "m", "its height in the world", -1e5, 1e5}, self.water_surface);
        visit({"latitude_deg", "deg", "of the world, for gravity", -90, 90}, self.latitude_deg);
        visit({"density", "kg/m^3", "of water of constant density; absent: UNESCO's standard ocean (1983)", 1, 1e5},
              self.density);
        visit({"atmosphere", "Pa", "pressure of the air at the surface", 0, 1e7}, self.atmosphere);
        visit({"max_pressure", "Pa", "max reading; absent: unlimited", 1, 1e12}, self.max_pressure);
        visit({"errors", "", "of the gauge; absent: none"}, self.errors);
    }
};

}  // namespace insonify::nav
