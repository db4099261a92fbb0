#include "components/nav/ErrorModel.hpp"

#include <algorithm>
#include <cmath>

#include "types/text/Hash.hpp"

namespace insonify::nav {
namespace {

uint64_t getBits(uint64_t seed, uint64_t channel, types::Time time) {
    return types::hashed(seed, channel, static_cast<uint64_t>(time.microseconds));
}

/** Returns the max reading: the last whole step within the range. */
double lastStep(const AxisErrors& errors) {
    return errors.resolution > 0 ? errors.resolution * std::floor(*errors.range / errors.resolution) : *errors.range;
}

}  // namespace

double normal(uint64_t seed, uint64_t channel, types::Time time) { return types::normal(getBits(seed, channel, time)); }

double uniform(uint64_t seed, uint64_t channel, types::Time time) {
    return types::unit(getBits(seed, channel, time) >> 32);
}

double WanderingBias::at(types::Time time) {
    if (deviation_ == 0) return 0;
    if (!last_) {
        value_ = deviation_ * normal(seed_, channel_, time);
        last_ = time;
    } else if (time > *last_) {
        const double kept = std::exp(-(time - *last_).seconds() / correlation_time_);
        value_ = kept * value_ + deviation_ * std::sqrt(1 - kept * kept) * normal(seed_, channel_, time);
        last_ = time;
    } else if (time < *last_) {
        last_ = time;  // the clock was set back
    }
    return value_;
}

double Axis::measure(double truth, double constant_bias, types::Time time, double interval) {
    double reported = truth + constant_bias + bias_.at(time);
    if (errors_.noise_density > 0)
        reported += errors_.noise_density / std::sqrt(interval) * normal(seed_, noise_channel_, time);
    if (errors_.resolution > 0) reported = errors_.resolution * std::round(reported / errors_.resolution);
    return errors_.range ? std::clamp(reported, -lastStep(errors_), lastStep(errors_)) : reported;
}

double computeVariance(const AxisErrors& errors, double interval) {
    const double noise = errors.noise_density > 0 ? errors.noise_density * errors.noise_density / interval : 0;
    return noise + errors.bias_deviation * errors.bias_deviation + errors.resolution * errors.resolution / 12;
}

}  // namespace insonify::nav
