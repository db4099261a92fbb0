#pragma once
// Errors of sensors: white noise and a bias that wanders, as IEEE Std 952-1997 (annex C) and O. Woodman, "An
// introduction to inertial navigation", UCAM-CL-TR-696, 2007, have them.
#include <cstdint>
#include <optional>

#include "types/Time.hpp"

namespace insonify::nav {

/** A variate of N(0, 1) for each sensor channel and moment, the same whenever it is asked for (Box and Muller 1958,
 * from types::hashed). At most 6.7 from 0. */
double normal(uint64_t seed, uint64_t channel, types::Time time);
/** A number in (0, 1), evenly distributed, likewise. */
double uniform(uint64_t seed, uint64_t channel, types::Time time);

/** A bias that wanders about 0 and forgets where it was: first-order Gauss-Markov, stationary from its start.
 *
 *  b(t + dt) = exp(-dt / time) b(t) + deviation sqrt(1 - exp(-2 dt / time)) n. Its Allan deviation has its highest
 * value, 0.618 of the deviation, at averages of 1.89 times its time. Each step's n belongs to its stamp and channel. */
class WanderingBias {
public:
    WanderingBias(double deviation, double correlation_time, uint64_t seed, uint64_t channel)
        : deviation_(deviation), correlation_time_(correlation_time), seed_(seed), channel_(channel) {}
    /** At a moment; one before the last is taken as the last. */
    double at(types::Time time);

private:
    double deviation_, correlation_time_;
    uint64_t seed_, channel_;
    double value_ = 0;
    std::optional<types::Time> last_;
};

/** One axis: what it tells of what is. In the order of a device: noise and biases, the end of its range, its steps. */
struct AxisErrors {
    double noise_density = 0;       ///< Deviation of white noise, of an average over 1 s [unit/sqrt(Hz)].
    double bias_deviation = 0;      ///< Of the wandering bias [unit].
    double bias_time = 1000;        ///< It forgets where it was [s].
    double resolution = 0;          ///< Least step; 0: none [unit].
    std::optional<double> range{};  ///< Most that it tells, either sign [unit].
};
class Axis {
public:
    Axis(const AxisErrors& errors, uint64_t seed, uint64_t channel)
        : errors_(errors),
          bias_(errors.bias_deviation, errors.bias_time, seed, 2 * channel),
          seed_(seed),
          noise_channel_(2 * channel + 1) {}
    /** What is told of `truth` with a constant bias, of a measurement that averages over `interval` [s]. */
    double measure(double truth, double constant_bias, types::Time time, double interval);
    const AxisErrors& errors() const { return errors_; }

private:
    AxisErrors errors_;
    WanderingBias bias_;
    uint64_t seed_, noise_channel_;
};

/** Variance of what an axis tells of a truth, its constant bias left out; that of its steps is a twelfth of their
 *  square [unit^2]. */
double varianceOf(const AxisErrors& errors, double interval);

}  // namespace insonify::nav
