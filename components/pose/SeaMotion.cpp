#include "components/pose/SeaMotion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::pose {
namespace {

using std::numbers::pi;

/** Exponent of Pierson and Moskowitz' spectrum about its peak, x = frequency / peak: x^-5 exp(-1.25 x^-4). */
constexpr double peak_exponent = 1.25;

/** Returns JONSWAP's mean spectrum over x, not to scale: peak enhancement 3.3, widths 0.07 and 0.09. */
double jonswapDensity(double x) {
    const double width = x <= 1 ? 0.07 : 0.09;
    const double peak = std::exp(-0.5 * std::pow((x - 1) / width, 2));
    return std::pow(x, -5) * std::exp(-peak_exponent * std::pow(x, -4)) * std::pow(3.3, peak);
}

/** Shares of JONSWAP's energy below evenly spaced points of x. Beyond the last point the density falls as x^-5. */
struct JonswapShares {
    static constexpr double low = 0.3, high = 12, step = 1e-3;
    std::vector<double> below{0};

    JonswapShares() {
        const auto count = static_cast<size_t>((high - low) / step);
        for (size_t i = 0; i < count; ++i)
            below.push_back(below.back() + step * jonswapDensity(low + (static_cast<double>(i) + 0.5) * step));
        const double all = below.back() + std::pow(high, -4) / 4;
        for (double& share : below) share /= all;
    }
    double at(double share) const {
        if (share >= below.back()) return high * std::pow((1 - share) / (1 - below.back()), -0.25);
        const auto after = std::ranges::upper_bound(below, share);
        const auto i = static_cast<size_t>(after - below.begin()) - 1;
        return low + (static_cast<double>(i) + (share - below[i]) / (below[i + 1] - below[i])) * step;
    }
};

}  // namespace

double frequencyOfShare(SeaSpectrum spectrum, double peak_frequency, double share) {
    if (spectrum == SeaSpectrum::PiersonMoskowitz)
        return peak_frequency * std::pow(peak_exponent / -std::log(share), 0.25);
    static const JonswapShares shares;
    return peak_frequency * shares.at(share);
}

void SeaMotionConfig::check(types::Diagnostics& diagnostics) const {
    if (heave_m == 0 && roll_deg == 0 && pitch_deg == 0)
        diagnostics.push_back({"", "moves nothing; give heave_m, roll_deg or pitch_deg"});
}

WaveSum::WaveSum(double rms, double period, SeaSpectrum spectrum, uint64_t seed)
    : amplitude_(rms * std::sqrt(2.0 / components)) {
    for (size_t i = 0; i < components; ++i) {
        // A random place in each share of the energy: evenly spaced frequencies would repeat the motion.
        const uint64_t word = types::hashed(seed, i, 0);
        const double share = (static_cast<double>(i) + types::unit(word >> 32)) / components;
        frequencies_.push_back(frequencyOfShare(spectrum, 2 * pi / period, share));
        phases_.push_back(2 * pi * types::unit(word & 0xffffffff));
    }
}

WaveSum::Value WaveSum::at(double time) const {
    Value sum;
    for (size_t i = 0; i < components; ++i) {
        const double angle = frequencies_[i] * time + phases_[i];
        sum.value += amplitude_ * std::cos(angle);
        sum.rate -= amplitude_ * frequencies_[i] * std::sin(angle);
    }
    return sum;
}

SeaMotion::SeaMotion(const SeaMotionConfig& config)
    : heave_(config.heave_m, config.period_s, config.spectrum, types::hashed(config.seed, 1, 0)),
      roll_(types::radians(config.roll_deg), config.period_s, config.spectrum, types::hashed(config.seed, 2, 0)),
      pitch_(types::radians(config.pitch_deg), config.period_s, config.spectrum, types::hashed(config.seed, 3, 0)) {}

void SeaMotion::move(double time, types::Pose& pose) const {
    const WaveSum::Value heave = heave_.at(time), roll = roll_.at(time), pitch = pitch_.at(time);
    pose.position.z += heave.value;
    pose.velocity.z += heave.rate;
    const glm::dquat turn =
        glm::angleAxis(pitch.value, glm::dvec3(0, 1, 0)) * glm::angleAxis(roll.value, glm::dvec3(1, 0, 0));
    pose.orientation = glm::normalize(pose.orientation * turn);
    // The rate of Ry(pitch) Rx(roll) in the rotated body.
    const glm::dvec3 own(roll.rate, pitch.rate * std::cos(roll.value), -pitch.rate * std::sin(roll.value));
    pose.angular_velocity = glm::conjugate(turn) * pose.angular_velocity + own;
}

}  // namespace insonify::pose
