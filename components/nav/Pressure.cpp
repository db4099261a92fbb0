#include "components/nav/Pressure.hpp"

#include <algorithm>
#include <cmath>

#include "components/nav/ErrorModel.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::nav {
namespace {

constexpr uint64_t noise_channel = 300, drift_channel = 301;
constexpr double max_water_pressure =
    1.3e8;  ///< Above the pressure at max depth; up to it depth grows with pressure [Pa].

/** Returns the inverse of depthOfOcean() at a depth, by bisection [Pa]. */
double pressureOfOcean(double depth, double latitude_deg) {
    double low = 0, high = max_water_pressure;
    while (high - low > 1e-6) {
        const double middle = (low + high) / 2;
        (depthOfOcean(middle, latitude_deg) < depth ? low : high) = middle;
    }
    return (low + high) / 2;
}

double pascalPerMetre(const PressureConfig& config) { return *config.density * normalGravity(config.latitude_deg); }

}  // namespace

double depthOfOcean(double pascal, double latitude_deg) {
    const double sine = std::sin(types::radians(latitude_deg)), x = sine * sine, p = pascal / 1e4;  // p in dbar
    const double gravity = 9.780318 * (1 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p;
    return (((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity;
}

double pressureAt(double depth, const PressureConfig& config) {
    constexpr double scale_height = 8434;  // of air at 288.15 K [m]
    if (depth <= 0) return config.atmosphere * std::exp(depth / scale_height);
    const double known = std::min(depth, deepest);
    return config.atmosphere +
           (config.density ? pascalPerMetre(config) * known : pressureOfOcean(known, config.latitude_deg));
}

double depthAt(double pascal, const PressureConfig& config) {
    const double of_water = std::clamp(pascal - config.atmosphere, 0.0, max_water_pressure);
    const double depth =
        config.density ? of_water / pascalPerMetre(config) : depthOfOcean(of_water, config.latitude_deg);
    return std::clamp(depth, 0.0, deepest);
}

PressureGauge::PressureGauge(const PressureConfig& config)
    : config_(config),
      drift_(config.errors.drift_deviation, config.errors.drift_time, config.sensor.randomSeed(), drift_channel) {}

types::Pressure PressureGauge::measure(const types::Pose& gauge) {
    const GaugeErrors& errors = config_.errors;
    double pascal = pressureAt(config_.water_surface - gauge.position.z, config_);
    pascal += errors.offset + drift_.at(gauge.time) +
              errors.noise * normal(config_.sensor.randomSeed(), noise_channel, gauge.time);
    const double maximum = config_.max_pressure.value_or(1e12);
    if (errors.resolution > 0) pascal = errors.resolution * std::round(pascal / errors.resolution);
    pascal = std::clamp(pascal, 0.0,
                        errors.resolution > 0 ? errors.resolution * std::floor(maximum / errors.resolution) : maximum);
    return {static_cast<float>(pascal), gauge.time};
}

types::Pose depthSample(const types::Pressure& reading, const PressureConfig& config) {
    const double pascal = static_cast<double>(reading.pascal), depth = depthAt(pascal, config);
    const double pascal_per_metre = pressureAt(1, config) - pressureAt(0, config);
    const GaugeErrors& errors = config.errors;
    const auto in_metres = [&](double deviation) { return std::pow(deviation / pascal_per_metre, 2); };
    types::Pose pose;
    pose.time = reading.time;
    pose.source_frame = "pressure";
    pose.target_frame = "world";
    pose.position = {types::Pose::unknown, types::Pose::unknown, config.water_surface - depth};
    pose.cov_position[2][2] =
        in_metres(errors.noise) + in_metres(errors.drift_deviation) + in_metres(errors.resolution) / 12;
    return pose;
}

}  // namespace insonify::nav
