#include "components/sonar/multipath/Waveform.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {
namespace {

constexpr double time_bandwidth = 50;  ///< Time-bandwidth product of a chirp whose duration is not configured [1].
constexpr double alike = 1e-6;         ///< Relative difference of two numbers of the same waveform [1].

bool hasPulse(const SonarConfig& config) {
    return config.pulse && (config.pulse->bandwidth_khz || config.pulse->duration_us);
}

bool areAlike(double a, double b) { return !(std::abs(a - b) > alike * std::max(std::abs(a), std::abs(b))); }

}  // namespace

Waveform waveformOf(const SonarConfig& config, const BinGrid& grid) {
    Waveform form;
    if (config.frequency_khz) form.frequency_khz = *config.frequency_khz;
    form.duration = 2 * grid.bin_width / grid.speed_of_sound;
    if (config.pulse && config.pulse->bandwidth_khz) {
        form.bandwidth_khz = *config.pulse->bandwidth_khz;
        form.duration = config.pulse->chirp_us ? 1e-6 * *config.pulse->chirp_us
                                               : time_bandwidth / (1e3 * *config.pulse->bandwidth_khz);
        return form;
    }
    if (config.pulse && config.pulse->duration_us) form.duration = 1e-6 * *config.pulse->duration_us;
    form.bandwidth_khz = 1e-3 / form.duration;
    return form;
}

Waveform waveformOf(const types::Transmission& sent, const Waveform& own) {
    const auto known = [](double value, double otherwise) { return std::isfinite(value) ? value : otherwise; };
    return {known(sent.frequency_khz, own.frequency_khz), known(sent.bandwidth_khz, own.bandwidth_khz),
            known(sent.duration, own.duration)};
}

Mismatch mismatchOf(const Waveform& own, const Waveform& sent, double cell, double rejection_db,
                    double speed_of_sound) {
    const bool is_same_band = !std::isfinite(own.frequency_khz) || areAlike(own.frequency_khz, sent.frequency_khz);
    if (is_same_band && areAlike(own.bandwidth_khz, sent.bandwidth_khz) && areAlike(own.duration, sent.duration))
        return {};
    const double apart = is_same_band ? 0 : std::abs(own.frequency_khz - sent.frequency_khz);
    const double common = std::clamp(0.5 * (own.bandwidth_khz + sent.bandwidth_khz) - apart, 0.0,
                                     std::min(own.bandwidth_khz, sent.bandwidth_khz));
    const double share = std::max(common / sent.bandwidth_khz, std::pow(10, -rejection_db / 10));
    const double length = 0.5 * speed_of_sound * (own.duration + sent.duration);
    return {share * sent.duration / own.duration * cell / length, length};
}

Receiver::Receiver(const RenderPlan& plan)
    : plan_(plan),
      own_(waveformOf(plan.config, plan.grid)),
      cell_(hasPulse(plan.config) ? acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound).cellLength()
                                  : plan.grid.bin_width),
      summed_cell_(plan.has(Pass::Pulse) ? cell_ : plan.grid.bin_width),
      loss_(makeAbsorption(plan.config).intensityPerMetre() / 2) {}

Reception Receiver::receptionOf(const types::Transmission& sent, const types::Time& own_time) const {
    const CrosstalkConfig& config = *plan_.config.crosstalk;
    const Mismatch mismatch =
        mismatchOf(own_, waveformOf(sent, own_), cell_, config.rejection_db, plan_.grid.speed_of_sound);
    const bool knows_levels = config.source_level_db && std::isfinite(sent.source_level_db);
    const double louder_db = knows_levels ? sent.source_level_db - *config.source_level_db : 0;
    return {std::pow(10, louder_db / 10) * mismatch.intensity, mismatch.length, loss_,
            0.5 * plan_.grid.speed_of_sound * (sent.time - own_time).seconds()};
}

}  // namespace insonify::sonar
