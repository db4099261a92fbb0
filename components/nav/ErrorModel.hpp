#pragma once
// Errors of sensors: white noise and a wandering bias, after IEEE Std 952-1997 (annex C) and O. Woodman, "An
// introduction to inertial navigation", UCAM-CL-TR-696, 2007.
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::nav {

/** The configuration that all sensors share: mount, period of measurements, and seed of the errors. */
struct SensorConfig {
    types::Mount mount{};
    std::optional<uint64_t> seed = {};  ///< None: 1. A deployment gives each task its own seed.
    double period = 0;

    uint64_t randomSeed() const { return seed.value_or(1); }

    /** Describes the keys of all sensors, with a sensor's descriptions of its mount and its period. */
    static void describe(auto& self, auto& visit, const char* mount, const char* period) {
        visit({"mount", "", mount}, self.mount);
        visit({"seed", "1",
               "of the random numbers: the same seed and poses give the same errors; absent: a hash of the "
               "deployment's seed and the task's name"},
              self.seed);
        visit({"period", "s", period, 0, 1e6}, self.period);
    }
};

/** Returns the normal gravity on the ellipsoid of WGS 84 at a latitude [deg], positive down [m/s^2]: Somigliana's
 *  closed formula, NIMA TR 8350.2, 3rd edition, equation 4-1. Its growth with depth, about 2.2e-6 m/s^2 per metre, is
 *  omitted. */
inline double normalGravity(double latitude_deg) {
    constexpr double at_equator = 9.7803253359, k = 0.00193185265241, eccentricity_squared = 0.00669437999013;
    const double sine = std::sin(types::radians(latitude_deg));
    return at_equator * (1 + k * sine * sine) / std::sqrt(1 - eccentricity_squared * sine * sine);
}

/** Returns the rotation of the earth at a latitude [deg] in the world, x north, y west, z up; WGS 84 [rad/s]. */
inline glm::dvec3 earthRotation(double latitude_deg) {
    constexpr double rate = 7.292115e-5;
    const double latitude = types::radians(latitude_deg);
    return {rate * std::cos(latitude), 0, rate * std::sin(latitude)};
}

/** Returns a variate of N(0, 1), at most 6.7 from 0, that depends only on seed, channel and time (Box and Muller 1958,
 *  from types::hashed). */
double normal(uint64_t seed, uint64_t channel, types::Time time);
/** Returns a uniform variate in (0, 1) that depends only on seed, channel and time. */
double uniform(uint64_t seed, uint64_t channel, types::Time time);

/** A bias that wanders about 0: a first-order Gauss-Markov process, stationary from its start.
 *
 *  b(t + dt) = exp(-dt / time) b(t) + deviation sqrt(1 - exp(-2 dt / time)) n. Its Allan deviation has its max value,
 *  0.618 of the deviation, at averages of 1.89 times its time. The n of each step depends on its stamp and channel. */
class WanderingBias {
public:
    WanderingBias(double deviation, double correlation_time, uint64_t seed, uint64_t channel)
        : deviation_(deviation), correlation_time_(correlation_time), seed_(seed), channel_(channel) {}
    /** Returns the bias at a time; times before the last call's time give its value. */
    double at(types::Time time);

private:
    double deviation_, correlation_time_;
    uint64_t seed_, channel_;
    double value_ = 0;
    std::optional<types::Time> last_;
};

/** Errors of one axis of a sensor. */
struct AxisErrors {
    double noise_density = 0;       ///< Deviation of white noise, of an average over 1 s [unit/sqrt(Hz)].
    double bias_deviation = 0;      ///< Deviation of the wandering bias [unit].
    double bias_time = 1000;        ///< Correlation time of the wandering bias [s].
    double resolution = 0;          ///< Step of the readings [unit]; 0: continuous.
    std::optional<double> range{};  ///< Max magnitude of the readings [unit].
};
/** One axis of a sensor. Applies errors in the order of a device: noise and biases, resolution, range. */
class Axis {
public:
    Axis(const AxisErrors& errors, uint64_t seed, uint64_t channel)
        : errors_(errors),
          bias_(errors.bias_deviation, errors.bias_time, seed, 2 * channel),
          seed_(seed),
          noise_channel_(2 * channel + 1) {}
    /** Returns the reading for `truth` with a constant bias, of a measurement that averages over `interval` [s]. */
    double measure(double truth, double constant_bias, types::Time time, double interval);
    const AxisErrors& errors() const { return errors_; }

private:
    AxisErrors errors_;
    WanderingBias bias_;
    uint64_t seed_, noise_channel_;
};

/** Returns the variance of an axis' readings, without the constant bias [unit^2]. The steps of the resolution
 *  contribute a twelfth of their square. */
double computeVariance(const AxisErrors& errors, double interval);

}  // namespace insonify::nav
