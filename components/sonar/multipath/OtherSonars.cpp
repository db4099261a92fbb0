#include "components/sonar/multipath/OtherSonars.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double time_bandwidth = 50;  ///< Time-bandwidth product of a chirp whose duration is not configured [1].
constexpr double alike = 1e-6;         ///< Relative difference of two numbers of the same waveform [1].

bool hasPulse(const SonarConfig& config) {
    return config.pulse && (config.pulse->bandwidth_khz || config.pulse->duration_us);
}

bool areAlike(double a, double b) { return !(std::abs(a - b) > alike * std::max(std::abs(a), std::abs(b))); }

}  // namespace

SentPower::SentPower(const SonarConfig& config)
    : conical_(config.beam_geometry == BeamGeometry::Conical),
      half_height_(types::radians(config.beam_height_deg) / 2),
      beams_(makeBeams(config)) {
    if (!config.beam_pattern) return;
    pattern_.emplace(config);
    has_azimuth_ = config.beam_pattern->transmit.azimuth.has_value();
    has_elevation_ = config.beam_pattern->transmit.elevation.has_value();
}

double SentPower::towards(const glm::dvec3& direction) const {
    if (conical_ && direction.x < 0) return 0;
    const BeamAngles at = beamAngles(direction, conical_);
    const double across = has_azimuth_ ? pattern_->sentAzimuth(at.azimuth) : beams_.spans(at.azimuth);
    const double along =
        has_elevation_ ? pattern_->sentElevation(at.elevation) : std::abs(at.elevation) <= half_height_;
    return across * along;
}

Waveform waveform(const SonarConfig& config, const BinGrid& grid) {
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

Waveform waveform(const types::Transmission& sent, const Waveform& own) {
    const auto known = [](double value, double otherwise) { return std::isfinite(value) ? value : otherwise; };
    return {known(sent.frequency_khz, own.frequency_khz), known(sent.bandwidth_khz, own.bandwidth_khz),
            known(sent.duration, own.duration)};
}

Mismatch computeMismatch(const Waveform& own, const Waveform& sent, double cell, double rejection_db,
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
      own_(waveform(plan.config, plan.grid)),
      cell_(hasPulse(plan.config) ? acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound).cellLength()
                                  : plan.grid.bin_width),
      summed_cell_(plan.has(Pass::Pulse) ? cell_ : plan.grid.bin_width),
      loss_(makeAbsorption(plan.config).intensityPerMetre() / 2) {}

Reception Receiver::reception(const types::Transmission& sent, const types::Time& own_time) const {
    const CrosstalkConfig& config = *plan_.config.crosstalk;
    const Mismatch mismatch =
        computeMismatch(own_, waveform(sent, own_), cell_, config.rejection_db, plan_.grid.speed_of_sound);
    const bool knows_levels = config.source_level_db && std::isfinite(sent.source_level_db);
    const double louder_db = knows_levels ? sent.source_level_db - *config.source_level_db : 0;
    return {std::pow(10, louder_db / 10) * mismatch.intensity, mismatch.length, loss_,
            0.5 * plan_.grid.speed_of_sound * (sent.time - own_time).seconds()};
}

DirectSound::DirectSound(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), receiver_(plan), shape_(echoShape(plan)) {
    setScene(geometry);
}

void DirectSound::setScene(const types::Geometry& geometry) { paths_.emplace(plan_.config, geometry); }

double DirectSound::receivedBy(const Beam& beam, const BeamAngles& from, double range) const {
    const auto& pattern = plan_.directivity;
    const double off = std::remainder(from.azimuth - beam.centre, 2 * std::numbers::pi);
    const double across = pattern && pattern->hasAzimuth() && !pattern->hasBoxes()
                              ? pattern->receivedAzimuth(from.azimuth, beam.centre, pattern->zoneAt(range))
                              : off >= beam.low - beam.centre && off < beam.high - beam.centre;
    const double along = pattern && pattern->hasElevation()
                             ? pattern->receivedElevation(from.elevation)
                             : std::abs(from.elevation) <= types::radians(plan_.config.beam_height_deg) / 2;
    return across * along;
}

bool DirectSound::spread(double range, double length) {
    const BinGrid& grid = plan_.grid;
    const double reach = length > 0 ? length / 2 : shape_ ? shape_->reach() : 0;
    const double first = std::max(0.0, binAt(range - reach, grid.bin_width));
    const double last = std::min(grid.bin_count - 1.0, binAt(range + reach, grid.bin_width));
    shares_.clear();
    if (!(first <= last)) return false;
    first_bin_ = static_cast<size_t>(first);
    for (double k = first; k <= last; ++k) {
        const double low = k * grid.bin_width - range, high = low + grid.bin_width;
        if (length > 0)
            shares_.push_back(std::max(0.0, std::min(high, reach) - std::max(low, -reach)) / grid.bin_width);
        else
            shares_.push_back(shape_ ? shape_->mean(low, high) : 1);
    }
    return true;
}

bool DirectSound::addPath(const types::Transmission& sent, const Reception& received, const TargetPath& path,
                          types::Sonar& ping) {
    const double range = received.offset + path.length / 2;
    if (!(range >= plan_.grid.range_min) || !spread(range, received.length)) return false;
    const bool conical = plan_.features.has(Feature::Conical);
    if (conical && path.direction.x < 0) return false;
    const double power = sent.radiation->towards(glm::conjugate(sent.sonar.orientation) * path.from_point);
    const double intensity =
        received.level * power * path.power * std::exp(-received.loss * path.length) / (path.length * path.length);
    const BeamAngles from = beamAngles(path.direction, conical);
    bool has_echo = false;
    for (size_t beam = 0; intensity > 0 && beam < plan_.beams.size(); ++beam) {
        const double gain = receivedBy(plan_.beams[beam], from, path.length);
        if (!(gain > 0)) continue;
        has_echo = true;
        float* bins = &ping.bins[beam * ping.bin_count + first_bin_];
        for (size_t i = 0; i < shares_.size(); ++i)
            bins[i] = static_cast<float>(
                std::min(double{bins[i]} + intensity * gain * shares_[i], double{std::numeric_limits<float>::max()}));
    }
    return has_echo;
}

size_t DirectSound::add(const types::Snapshot& snapshot, types::Sonar& ping) {
    // A path may be longer by the time that the pulse was sent before the ping.
    received_.clear();
    double earliest = 0;
    for (const auto& sent : snapshot.transmissions) {
        received_.push_back(receiver_.reception(*sent, snapshot.time));
        earliest = std::max(earliest, -received_.back().offset);
    }
    paths_->place(snapshot, plan_.grid.range_max + earliest);
    size_t has_echo = 0;
    for (size_t i = 0; i < received_.size(); ++i) {
        const auto& sent = snapshot.transmissions[i];
        bool any = false;
        for (const TargetPath& path : paths_->pathsTo(sent->sonar.position))
            any |= addPath(*sent, received_[i], path, ping);
        has_echo += any ? 1 : 0;
    }
    return has_echo;
}

}  // namespace insonify::sonar
