#include "components/acoustics/Pulse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

/** End of the search for sidelobes and of the integral of h [u]. Beyond it h falls at least as fast as u^-2. */
constexpr double far_u = 500;
constexpr double step_u = 0.01;

Weighting getWeighting(PulseWindow window) {
    switch (window) {
        case PulseWindow::None: return Weighting::Uniform;
        case PulseWindow::Hann: return Weighting::Hann;
        case PulseWindow::Hamming: return Weighting::Hamming;
        case PulseWindow::Taylor: return Weighting::Taylor;
    }
    return Weighting::Uniform;
}

}  // namespace

void RingDownConfig::check(types::Diagnostics& diagnostics) const {
    if (!level_db) diagnostics.push_back({"level_db", "is missing; give the level at range 0 [dB]"});
    if (!decay_db_per_m) diagnostics.push_back({"decay_db_per_m", "is missing; give how fast the level falls [dB/m]"});
}

double RingDownConfig::mean(double low, double high) const {
    const double rate = decay_db_per_m.value() * std::numbers::ln10 / 10;
    const double fallen = -std::expm1(-rate * (high - low)) / (rate * (high - low));
    return std::pow(10, *level_db / 10) * std::exp(-rate * low) * fallen;
}

void PulseConfig::check(types::Diagnostics& diagnostics) const {
    if (bandwidth_khz && duration_us)
        diagnostics.push_back({"duration_us", "is given together with bandwidth_khz; give one of the two"});
    if (chirp_us && !bandwidth_khz)
        diagnostics.push_back({"chirp_us", "is given without bandwidth_khz; a tone is no chirp"});
    if (!bandwidth_khz && !duration_us)
        diagnostics.push_back({"", "has no length; give bandwidth_khz of a chirp, or duration_us of a tone"});
    if (window && !bandwidth_khz) diagnostics.push_back({"window", "is given without bandwidth_khz; a tone has none"});
}

Pulse::Pulse(const PulseConfig& config, double speed_of_sound) {
    if (config.bandwidth_khz) {
        unit_ = speed_of_sound / (2e3 * *config.bandwidth_khz);
        taper_ = Taper(getWeighting(config.window.value_or(PulseWindow::None)));
    } else {
        unit_ = speed_of_sound * config.duration_us.value() * 1e-6 / 2;
    }
}

double Pulse::response(double distance) const {
    const double field = amplitude(distance);
    return field * field;
}

double Pulse::amplitude(double distance) const {
    const double u = distance / unit_;
    return isTone() ? (std::abs(u) <= 0.5 ? 1 : 0) : taper_->amplitude(u);
}

double Pulse::mean(double low, double high) const {
    if (isTone()) return std::max(0.0, std::min(high, unit_ / 2) - std::max(low, -unit_ / 2)) / (high - low);
    const int parts = 16 + static_cast<int>(16 * (high - low) / unit_);  // lobes are a unit wide
    double sum = 0;
    for (int i = 0; i < parts; ++i) sum += response(low + (high - low) * (i + 0.5) / parts);
    return sum / parts;
}

double Pulse::resolution() const { return isTone() ? unit_ : unit_ * taper_->halfPowerWidth(); }

double Pulse::cellLength() const {
    if (isTone()) return unit_;
    double sum = 0;
    for (double u = step_u / 2; u < far_u; u += step_u) sum += taper_->power(u);
    return 2 * unit_ * sum * step_u;
}

std::optional<double> Pulse::peakSidelobeDb() const {
    if (isTone()) return {};
    double u = taper_->halfPowerWidth() / 2;
    while (taper_->power(u + step_u) < taper_->power(u)) u += step_u;  // the first minimum
    double highest = 0;
    for (; u < 50; u += step_u / 4) highest = std::max(highest, taper_->power(u));
    return 10 * std::log10(highest);
}

double Pulse::extent(double floor_db) const {
    if (isTone()) return unit_ / 2;
    const double floor = std::pow(10, -std::abs(floor_db) / 10);
    double u = far_u;
    while (u > 0 && taper_->power(u) < floor) u -= step_u / 8;
    return unit_ * u;
}

}  // namespace insonify::acoustics
