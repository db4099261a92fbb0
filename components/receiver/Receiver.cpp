#include "components/receiver/Receiver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "types/geometry/Geometry.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::receiver {
namespace {

constexpr float floor_db = -3000;
constexpr double nearest = 1e-3;  ///< Min range for the gain; nearer bins have the gain of this range [m].

INSONIFY_VECTOR_CLONES
void amplify(const float* __restrict in, const double* __restrict factor, double ceiling, float* __restrict out,
             size_t count) {
    for (size_t i = 0; i < count; ++i) {
        const double x = static_cast<double>(in[i]) * factor[i];
        out[i] = static_cast<float>(x > ceiling ? ceiling : x);
    }
}

INSONIFY_VECTOR_CLONES
void toRoots(float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) values[i] = std::sqrt(values[i]);
}

INSONIFY_VECTOR_CLONES
void toLevels(const float* __restrict in, const float* __restrict offset_db, float* __restrict out, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        const float level = types::decibels(in[i]) + offset_db[i];
        const float kept = level < floor_db ? floor_db : level;
        out[i] = in[i] > 0 ? kept : in[i] == 0 ? floor_db : in[i];
    }
}

INSONIFY_VECTOR_CLONES
void clip(float* values, float ceiling, size_t count) {
    for (size_t i = 0; i < count; ++i) values[i] = values[i] > ceiling ? ceiling : values[i];
}

/** Raises values to the power of gamma. */
void bend(float* values, double gamma, size_t count) {
    if (gamma == 1) return;
    if (gamma == 0.5) return toRoots(values, count);
    for (size_t i = 0; i < count; ++i) values[i] = std::pow(values[i], static_cast<float>(gamma));
}

/** Rounds to whole numbers from 0 to `most`; NaN becomes 0. */
INSONIFY_VECTOR_CLONES
void quantise(float* values, float per_unit, float zero, float maximum, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        const float x = (values[i] - zero) * per_unit;
        const float above = x > 0 ? x : 0.0f;
        const float code = above < maximum ? above : maximum;
        values[i] = static_cast<float>(static_cast<int32_t>(code + 0.5f));
    }
}

double computePower(double decibels) { return std::pow(10.0, decibels / 10); }

/** Returns the level of the echo of a cell of medium sand at normal incidence: 10 log10(mu w dR / r^3) [dB]. */
double sandLevelDb(const types::Sonar& ping, double r) {
    const double cell = ping.beam_width.rad * (ping.binStart(1) - ping.binStart(0));
    return types::Material{}.lambert_db + 10 * std::log10(cell) - 30 * std::log10(r);
}

}  // namespace

void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db) {
    const auto getKept = [&](double time_ms) { return time_ms > 0 ? std::exp(-bin_ms / time_ms) : 0.0; };
    const double attack = getKept(config.attack_ms), release = getKept(config.release_ms);
    double level = -1;  // smoothed level of the bins so far; below 0 before the first
    for (size_t k = 0; k < means.size(); ++k) {
        const bool is_received = k >= first && means[k] >= 0;
        if (is_received && level < 0) level = means[k];
        const double kept = means[k] > level ? attack : release;
        // A sum of positive numbers, which keeps its digits where the level falls by many orders of magnitude.
        if (is_received) level = level * kept + means[k] * (1 - kept);
        const double wanted = level > 0 ? target - 10 * std::log10(level) : level < 0 ? 0 : config.max_db;
        gains_db[k] = std::clamp(wanted, -config.max_db, config.max_db);
    }
}

void CodeConfig::check(types::Diagnostics& diagnostics) const {
    if (gamma != 1 && law == CodeLaw::Log)
        diagnostics.push_back({"gamma", "is given with law log; it bends law linear and sqrt"});
}

void ReceiverConfig::check(types::Diagnostics& diagnostics) const {
    if (brightness && automatic_gain)
        diagnostics.push_back(
            {"automatic_gain", "is given with brightness, which scales for a display; give one of the two"});
    if (brightness && saturation_db)
        diagnostics.push_back({"saturation_db", "is given with brightness, which ends at 1; give one of the two"});
    if (!brightness) return;
    if (tvg) diagnostics.push_back({"brightness", "is given with tvg; it compensates for spreading itself"});
    if (output != Output::Intensity)
        diagnostics.push_back({"brightness", "is given with another output; it scales output: intensity"});
}

double unclampedTvgDb(const TvgConfig& tvg, double r) {
    return tvg.log_coefficient * std::log10(r) + 2 * tvg.db_per_m * r;
}

double tvgDb(const TvgConfig& tvg, double r) { return std::min(unclampedTvgDb(tvg, r), tvg.max_db); }

std::optional<double> clampRange(const TvgConfig& tvg, double range_max) {
    double below = nearest, above = std::min(range_max, 1e6);
    if (!(unclampedTvgDb(tvg, above) > tvg.max_db)) return {};
    for (int i = 0; i < 100; ++i) {
        const double middle = (below + above) / 2;
        (unclampedTvgDb(tvg, middle) > tvg.max_db ? above : below) = middle;
    }
    return above;
}

Receiver::Receiver(const ReceiverConfig& config) : config_(config), code_(config.code.value_or(CodeConfig{})) {}

bool Receiver::isLevel() const {
    return config_.output == Output::LevelDb || config_.output == Output::ReceivedLevelDb ||
           (config_.output == Output::Code && code_.law == CodeLaw::Log);
}

bool Receiver::isNeutral() const {
    return config_.output == Output::Intensity && config_.gain_db == 0 && !config_.tvg && !config_.blanking &&
           !config_.brightness && !config_.automatic_gain && !config_.saturation_db;
}

double Receiver::gainDb(const types::Sonar& ping, double r) const {
    double gain = config_.gain_db + (config_.tvg ? tvgDb(*config_.tvg, r) : 0);
    if (config_.output == Output::ReceivedLevelDb) gain += config_.source_level_db;
    if (config_.output == Output::Code) gain -= code_.full_scale_db;
    if (config_.brightness) {
        gain += 10 * std::log10(2 * config_.brightness->gain);
        if (config_.brightness->model == Model::Physical) gain -= sandLevelDb(ping, r);
    }
    return gain;
}

void Receiver::makeTables(const types::Sonar& ping) {
    const Axis axis{ping.bin_count, ping.binWidth(), ping.binSeconds(),
                    std::isnan(ping.beam_width.rad) ? -1 : ping.beam_width.rad};  // NaN does not equal itself
    if (axis == axis_) return;
    axis_ = axis;
    range_max_ = ping.binStart(ping.bin_count);
    factor_.resize(ping.bin_count);
    offset_db_.resize(ping.bin_count);
    silent_ = 0;
    for (uint32_t k = 0; k < ping.bin_count; ++k) {
        const double gain = gainDb(ping, std::max(nearest, ping.binStart(k + 0.5)));
        factor_[k] = std::min(computePower(gain), 1e300);
        offset_db_[k] = static_cast<float>(gain);
        if (config_.blanking && ping.binStart(k) < config_.blanking->range_min * (1 - 1e-9)) silent_ = k + 1;
    }
}

double Receiver::scaleDb() const {
    if (config_.output == Output::ReceivedLevelDb) return config_.source_level_db;
    return config_.output == Output::Code ? -code_.full_scale_db : 0;
}

double Receiver::saturation() const {
    constexpr double maximum = static_cast<double>(std::numeric_limits<float>::max());
    return config_.saturation_db ? std::min(maximum, computePower(*config_.saturation_db + scaleDb())) : maximum;
}

void Receiver::followLevel(const types::Sonar& ping) {
    const size_t count = axis_.bin_count;
    fixed_db_.resize(count);
    means_.assign(count, 0);
    automatic_db_.resize(count);
    for (size_t k = 0; k < count; ++k)
        fixed_db_[k] = gainDb(ping, std::max(nearest, ping.binStart(static_cast<double>(k) + 0.5)));
    for (size_t i = 0; i < ping.bins.size(); ++i)
        if (ping.bins[i] >= 0) means_[i % count] += static_cast<double>(ping.bins[i]);
    for (size_t k = 0; k < count; ++k)
        means_[k] *= std::min(computePower(fixed_db_[k]), 1e200) / std::max(1u, ping.beam_count);
    receiver::followLevel(*config_.automatic_gain, means_, silent_, config_.automatic_gain->target_db + scaleDb(),
                          2e3 * ping.binSeconds(), automatic_db_);
    for (size_t k = 0; k < count; ++k) {
        const double gain = fixed_db_[k] + automatic_db_[k];
        factor_[k] = std::min(computePower(gain), 1e300);
        offset_db_[k] = static_cast<float>(gain);
    }
}

void Receiver::encode(float* received) const {
    const float maximum = maxCode();
    const auto range_db = static_cast<float>(code_.dynamic_range_db);
    if (isLevel()) return quantise(received, maximum / range_db, -range_db, maximum, axis_.bin_count);
    bend(received, code_.gamma, axis_.bin_count);
    quantise(received, maximum, 0, maximum, axis_.bin_count);
}

void Receiver::receiveBeam(const float* intensities, float* received) const {
    const size_t count = axis_.bin_count;
    if (isLevel())
        toLevels(intensities, offset_db_.data(), received, count);
    else
        amplify(intensities, factor_.data(), config_.brightness ? 1 : saturation(), received, count);
    if (isLevel() && config_.saturation_db)
        clip(received, static_cast<float>(*config_.saturation_db + scaleDb()), count);
    std::fill_n(received, silent_, isLevel() ? floor_db : 0.0f);
    const bool is_root =
        config_.output == Output::Code ? code_.law == CodeLaw::Sqrt : config_.output == Output::Amplitude;
    if (is_root) toRoots(received, count);
    if (config_.output == Output::Code) encode(received);
}

void Receiver::receive(const types::Sonar& intensities, types::Sonar& received) {
    makeTables(intensities);
    if (config_.automatic_gain) followLevel(intensities);
    received.copyHeader(intensities);
    const size_t count = axis_.bin_count;
    for (size_t beam = 0; beam < intensities.beam_count; ++beam)
        receiveBeam(intensities.bins.data() + beam * count, received.bins.data() + beam * count);
}

const char* Receiver::findDiagnostic(const types::Sonar& intensities) const {
    if (const char* why = intensities.notIntensities()) return why;
    const bool needs_width = config_.brightness && config_.brightness->model == Model::Physical;
    return needs_width && intensities.beam_width.isUnknown()
               ? "the width of its beams is unknown, which brightness needs"
               : nullptr;
}

Receiver::Flaws Receiver::getFlaws(const types::Sonar& intensities, const types::Sonar& received) const {
    Flaws flaws;
    const size_t count = axis_.bin_count, kept = count - silent_;
    flaws.blanked = count > 0 && kept == 0;
    if (flaws.blanked || config_.output != Output::Code) return flaws;
    size_t full = 0, empty = 0;
    for (size_t beam = 0; beam < received.beam_count; ++beam) {
        const auto codes = std::span(received.bins).subspan(beam * count + silent_, kept);
        full += static_cast<size_t>(std::ranges::count(codes, maxCode()));
        empty += static_cast<size_t>(std::ranges::count(codes, 0.0f));
    }
    const size_t all = kept * received.beam_count;
    flaws.saturated = all > 0 ? static_cast<double>(full) / static_cast<double>(all) : 0;
    flaws.all_zero = empty == all && std::isfinite(loudestDb(intensities));
    return flaws;
}

double Receiver::loudestDb(const types::Sonar& intensities) const {
    double loudest = -std::numeric_limits<double>::infinity();
    for (size_t beam = 0; beam < intensities.beam_count; ++beam)
        for (size_t k = silent_; k < axis_.bin_count; ++k)
            if (const float level = intensities.bins[beam * axis_.bin_count + k]; level > 0)
                loudest =
                    std::max(loudest, 10 * std::log10(static_cast<double>(level)) + static_cast<double>(offset_db_[k]));
    return loudest;
}

double Receiver::lowestDb() const {
    const double half = 0.5 / static_cast<double>(maxCode());
    if (code_.law == CodeLaw::Log) return (half - 1) * code_.dynamic_range_db;
    return (code_.law == CodeLaw::Sqrt ? 20 : 10) * std::log10(half);
}

std::string Receiver::text(const Flaws& flaws, const types::Sonar& intensities) const {
    if (flaws.blanked)
        return fmt::format("silences everything: blanking.range_min is {:g} m, the range ends at {:.4g} m",
                           config_.blanking->range_min, range_max_);
    const double loudest = loudestDb(intensities);
    if (flaws.all_zero)
        return fmt::format(
            "gives code 0 in every bin: the loudest is {:.3g} dB below full_scale_db, {:g} dB, and codes begin {:.3g} "
            "dB below it; raise gain_db, or lower full_scale_db",
            -loudest, code_.full_scale_db, -lowestDb());
    return fmt::format(
        "saturates: {:.3g} % of the codes are {:g}, and the loudest bin is {:.3g} dB above full_scale_db, {:g} dB; "
        "lower gain_db, or raise full_scale_db",
        100 * flaws.saturated, maxCode(), loudest, code_.full_scale_db);
}

namespace {

/** Reports a value that its bounds permit but no sonar has, and that usually is a typo: a picture of it is all white
 *  or all black. */
void noteUnusual(const char* property, double value, double low, double high, const char* unit, types::Notices& all) {
    if (value < low || value > high)
        all.push_back(types::warning(
            fmt::format("{} is {:g} {}; receivers have {:g} to {:g}, so echoes are probably saturated or lost",
                        property, value, unit, low, high)));
}

}  // namespace

types::Notices Receiver::notices() const {
    types::Notices all;
    noteUnusual("gain_db", config_.gain_db, -100, 150, "dB", all);
    if (const auto& tvg = config_.tvg) {
        noteUnusual("tvg.log_coefficient", tvg->log_coefficient, 0, 80, "dB", all);
        noteUnusual("tvg.db_per_m", tvg->db_per_m, 0, 5, "dB/m", all);
        noteUnusual("tvg.max_db", tvg->max_db, -100, 250, "dB", all);
    }
    if (config_.code && config_.output == Output::Code)
        noteUnusual("code.full_scale_db", config_.code->full_scale_db, -250, 150, "dB", all);
    if (const auto& automatic = config_.automatic_gain) {
        noteUnusual("automatic_gain.target_db", automatic->target_db, -250, 150, "dB", all);
        noteUnusual("automatic_gain.max_db", automatic->max_db, 0, 150, "dB", all);
    }
    if (config_.saturation_db) noteUnusual("saturation_db", *config_.saturation_db, -250, 150, "dB", all);
    if (config_.output == Output::ReceivedLevelDb)
        noteUnusual("source_level_db", config_.source_level_db, 0, 260, "dB", all);
    if (const auto r = config_.tvg ? clampRange(*config_.tvg, range_max_) : std::nullopt)
        all.push_back(
            fmt::format("tvg reaches its max_db of {:g} dB at {:.4g} m and stays there", config_.tvg->max_db, *r));
    if (config_.code && config_.output != Output::Code)
        all.push_back("code is configured, but only output: code uses it");
    return all;
}

}  // namespace insonify::receiver
