#pragma once
// Errors of sensors: white noise and a wandering bias, after IEEE Std 952-1997 (annex C) and O. Woodman, "An
// introduction to inertial navigation", UCAM-CL-TR-696, 2007.
#include <cstdint>
#include <optional>

#include "types/Time.hpp"

namespace insonify::nav {

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
double varianceOf(const AxisErrors& errors, double interval);

}  // namespace insonify::nav
