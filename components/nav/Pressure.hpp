#pragma once
#include <optional>

#include "components/nav/ErrorModel.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Pressure.hpp"

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
        visit({"density", "kg/m^3", "of water of constant density; absent: UNESCO's standard ocean (1983)", 500, 2000},
              self.density);
        visit({"atmosphere", "Pa", "pressure of the air at the surface", 0, 1e7}, self.atmosphere);
        visit({"max_pressure", "Pa", "max reading; absent: unlimited", 1, 1e12}, self.max_pressure);
        visit({"errors", "", "of the gauge; absent: none"}, self.errors);
    }
};

/** Max depth; larger depths count as this [m]. */
constexpr double deepest = 12000;

/** Returns the depth [m] of a gauge pressure [Pa] at a latitude, in the standard ocean of 0 degC and 35 psu, accurate
 *  to 0.1 m down to 10000 dbar: N. Fofonoff and R. Millard, "Algorithms for computation of fundamental properties of
 *  seawater", UNESCO technical papers in marine science 44, 1983, after Saunders and Fofonoff (1976). */
double depthOfOcean(double pascal, double latitude_deg);

/** Returns the absolute pressure at a depth below the surface [Pa]: that of the air plus that of the water above. In
 *  water of constant density the latter is density x normal gravity x depth; otherwise it is the inverse of
 *  depthOfOcean(). Above the surface, at negative depths, the pressure is that of air of constant temperature, 288
 *  K. */
double pressureAt(double depth, const PressureConfig& config);
/** Returns the depth of an absolute pressure in the same water [m]; 0 above the surface. */
double depthAt(double pascal, const PressureConfig& config);

/** A pressure gauge with its errors. */
class PressureGauge {
public:
    explicit PressureGauge(const PressureConfig& config);
    /** Returns the reading at a pose of the gauge; never below 0. */
    types::Pressure measure(const types::Pose& gauge);

private:
    PressureConfig config_;
    WanderingBias drift_;
};

/** Returns the depth of a reading in the same water, as Rock's depth gauges report it: z of frame "pressure" in "world"
 *  [m] with the variance from noise, drift and resolution [m^2]; other fields are unknown. */
types::Pose depthSample(const types::Pressure& reading, const PressureConfig& config);

}  // namespace insonify::nav
