#include "components/device/ping/Ping1dEmulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "components/device/DeviceBins.hpp"

namespace insonify::device {
namespace {

constexpr double gains[] = {0.6, 1.8, 5.5, 12.9, 30.2, 66.1, 144};  ///< Factors of the amplitude.
constexpr uint8_t max_gain = ping1d_max_gain;
static_assert(std::size(gains) == ping1d_max_gain + 1);
constexpr uint32_t shortest_scan = 1000;                                ///< [mm]
constexpr uint16_t voltage_mv = 5000, temperature_centicelsius = 2000;  // as measured on the simulated board
constexpr size_t max_waiting = 64;
constexpr double overhead = 0.005;  ///< Between the last echo and the answer [s].

bool isMeasurement(uint16_t message) {
    return message == Ping1dDistanceSimple::message || message == Ping1dDistance::message ||
           message == Ping1dProfile::message;
}

}  // namespace

double ping1dGainDb(uint32_t setting) { return 20 * std::log10(gains[setting]); }

Ping1dReturn ping1dReturn(std::span<const float> profile, size_t first) {
    first = std::min(first, profile.size());
    const std::span<const float> codes = profile.subspan(first);
    const float max_code = codes.empty() ? 0 : *std::ranges::max_element(codes);
    if (!(max_code > 0)) return {};
    const auto strong = [&](float code) { return code >= max_code / 2; };
    const auto begin = std::ranges::find_if(codes, strong);
    const auto end = std::find_if_not(begin, codes.end(), strong);
    const double mean = std::accumulate(codes.begin(), codes.end(), 0.0) / static_cast<double>(codes.size());
    return {first + static_cast<size_t>(std::max_element(begin, end) - codes.begin()),
            static_cast<uint16_t>(std::lround(100 * (1 - mean / static_cast<double>(max_code))))};
}

Ping1dEmulator::Ping1dEmulator(const Ping1dConfig& config, double max_code)
    : PingDevice({static_cast<uint8_t>(PingDeviceType::Ping1d), 1, 3, 29, 0, 0}, {1, 0, 0, 0}, 1),
      config_(config),
      max_code_(max_code),
      length_(static_cast<uint32_t>(std::lround(1000 * config.max_range))) {}

template <class Message, class Value>
void Ping1dEmulator::set(PingClient client, const PingFrame& frame, const char* name, uint32_t min, uint32_t max,
                         Value& value) {
    with<Message>(client, frame, [&](const Message& request) {
        const std::string why = findDiagnostic({{name, request.value, min, max}});
        if (!why.empty()) return refuse(client, frame.message, why);
        value = request.value;
        acknowledge(client, frame.message);
    });
}

void Ping1dEmulator::command(PingClient client, const PingFrame& frame, types::Time /*now*/) {
    switch (frame.message) {
        case Ping1dSetDeviceId::message:
            return with<Ping1dSetDeviceId>(client, frame, [&](const auto& m) { setId(client, m.message, m.value, 0); });
        case Ping1dSetRange::message:
            return with<Ping1dSetRange>(client, frame, [&](const auto& m) { setRange(client, m); });
        case Ping1dSetSpeedOfSound::message:
            return set<Ping1dSetSpeedOfSound>(client, frame, "speed_of_sound", 100'000, 10'000'000, speed_of_sound_);
        case Ping1dSetModeAuto::message: return set<Ping1dSetModeAuto>(client, frame, "mode_auto", 0, 1, mode_auto_);
        case Ping1dSetPingInterval::message:
            return set<Ping1dSetPingInterval>(client, frame, "ping_interval", 1, 65535, interval_);
        case Ping1dSetGain::message: return set<Ping1dSetGain>(client, frame, "gain_setting", 0, max_gain, gain_);
        case Ping1dSetPingEnable::message:
            return set<Ping1dSetPingEnable>(client, frame, "ping_enabled", 0, 1, enabled_);
        case Ping1dContinuousStart::message:
            return with<Ping1dContinuousStart>(client, frame, [&](const auto& m) { startStream(client, m.value); });
        case Ping1dContinuousStop::message:
            return with<Ping1dContinuousStop>(client, frame, [&](const auto& m) { stopStream(client, m.value); });
        default: return refuse(client, frame.message, "there is no such message");
    }
}

void Ping1dEmulator::setRange(PingClient client, const Ping1dSetRange& request) {
    const auto end = static_cast<uint32_t>(std::lround(1000 * config_.max_range));
    if (mode_auto_ != 0)
        return refuse(client, request.message, "mode_auto is 1, so the device sets the range; set mode_auto to 0");
    std::string why = findDiagnostic({{"scan_start", request.start, 0, end - shortest_scan}});
    if (why.empty()) why = findDiagnostic({{"scan_length", request.length, shortest_scan, end - request.start}});
    if (!why.empty()) return refuse(client, request.message, why);
    start_ = request.start;
    length_ = request.length;
    acknowledge(client, request.message);
}

void Ping1dEmulator::startStream(PingClient client, uint16_t message) {
    if (!isMeasurement(message))
        return refuse(client, Ping1dContinuousStart::message,
                      fmt::format("message {} is not sent continuously", message));
    if (streams_.size() >= max_waiting)
        return refuse(client, Ping1dContinuousStart::message, "too many streams run already");
    const Wanted wanted{client, message};
    if (std::ranges::find(streams_, wanted) == streams_.end()) streams_.push_back(wanted);
    acknowledge(client, Ping1dContinuousStart::message);
}

void Ping1dEmulator::stopStream(PingClient client, uint16_t message) {
    std::erase(streams_, Wanted{client, message});
    acknowledge(client, Ping1dContinuousStop::message);
}

bool Ping1dEmulator::answer(PingClient client, uint16_t requested, types::Time /*now*/) {
    if (!isMeasurement(requested)) return answerSetting(client, requested) || answerBoard(client, requested);
    if (waiting_.size() >= max_waiting)
        refuse(client, requested, "too many requests wait already");
    else
        waiting_.push_back({client, requested});
    return true;
}

bool Ping1dEmulator::answerSetting(PingClient client, uint16_t requested) {
    switch (requested) {
        case Ping1dDeviceId::message: send(client, Ping1dDeviceId{id()}); return true;
        case Ping1dSpeedOfSound::message: send(client, Ping1dSpeedOfSound{speed_of_sound_}); return true;
        case Ping1dRange::message: send(client, Ping1dRange{start_, length_}); return true;
        case Ping1dModeAuto::message: send(client, Ping1dModeAuto{mode_auto_}); return true;
        case Ping1dPingInterval::message: send(client, Ping1dPingInterval{interval_}); return true;
        case Ping1dGain::message: send(client, Ping1dGain{gain_}); return true;
        case Ping1dPingEnable::message: send(client, Ping1dPingEnable{enabled_}); return true;
        default: return false;
    }
}

bool Ping1dEmulator::answerBoard(PingClient client, uint16_t requested) {
    const PingDeviceInformation& about = information();
    switch (requested) {
        case Ping1dFirmwareVersion::message:
            send(client, Ping1dFirmwareVersion{1, 1, about.major, about.minor});
            return true;
        case Ping1dVoltage5::message: send(client, Ping1dVoltage5{voltage_mv}); return true;
        case Ping1dTransmitDuration::message:
            send(client, Ping1dTransmitDuration{last_.measurement.transmit_duration});
            return true;
        case Ping1dGeneralInfo::message:
            send(client, Ping1dGeneralInfo{about.major, about.minor, voltage_mv, interval_, gain_, mode_auto_});
            return true;
        case Ping1dProcessorTemperature::message:
            send(client, Ping1dProcessorTemperature{temperature_centicelsius});
            return true;
        case Ping1dPcbTemperature::message: send(client, Ping1dPcbTemperature{temperature_centicelsius}); return true;
        default: return false;
    }
}

void Ping1dEmulator::forget(PingClient client) {
    const auto theirs = [&](const Wanted& wanted) { return wanted.client == client; };
    std::erase_if(waiting_, theirs);
    std::erase_if(streams_, theirs);
}

bool Ping1dEmulator::wantsPing(types::Time now) const {
    return enabled_ != 0 && (!waiting_.empty() || (!streams_.empty() && now >= next_));
}

void Ping1dEmulator::listen(types::Time now) {
    const double seconds = 2.0 * (start_ + length_) / speed_of_sound_;
    types::SonarSettings wanted;
    // Bins at least as long as samples, which begin where the scan does.
    wanted.bin_count = static_cast<uint32_t>(int64_t{config_.profile_samples} * (start_ + length_) / length_);
    wanted.gain_db = ping1dGainDb(gain_);
    Ping1dMeasurement& made = last_.measurement;
    made.start = start_;
    made.length = length_;
    made.gain = gain_;
    const double step_us = 2e6 * length_ / speed_of_sound_ / config_.profile_samples;
    made.transmit_duration = static_cast<uint16_t>(std::clamp(step_us, 20.0, 500.0));
    turn_.ask(wanted, seconds, seconds + overhead, now);
    next_ = now + types::Time{int64_t{1000} * interval_};
}

void Ping1dEmulator::finish(const types::Sonar& ping) {
    Ping1dMeasurement& made = last_.measurement;
    const double end = static_cast<double>(made.start) + made.length, bin = end / ping.bin_count;  // [mm], as reported
    const double scale = ping.binWidth() / bin;  // [m/mm], in the water
    // The bin that a limit divides has echoes of its farther part.
    const double nearest = std::max(made.start / bin, config_.nearest / ping.binWidth());  // [bins]
    const auto begin = static_cast<size_t>(made.start / bin + 1e-9);
    std::vector<float> codes(ping.bins.begin() + static_cast<ptrdiff_t>(begin), ping.bins.end());
    for (float& code : codes) code = code > 0 ? code : 0;  // also for unknown bins
    const Ping1dReturn found = ping1dReturn(codes, static_cast<size_t>(nearest + 1e-9) - begin);
    const double place = std::max(static_cast<double>(begin + found.bin) + 0.5, nearest);
    made.confidence = found.confidence;
    made.distance = found.confidence == 0 ? 0 : static_cast<uint32_t>(std::lround(place * bin));
    ++made.ping_number;
    std::vector<float> profile(static_cast<size_t>(config_.profile_samples));
    resampleBeam(ping, 0, scale * made.start, scale * made.length / config_.profile_samples, profile);
    last_.data = bytesOfCodes(profile, max_code_);
    for (const Wanted& wanted : std::exchange(waiting_, {})) report(wanted, false);
    for (const Wanted& wanted : streams_) report(wanted, true);
    if (mode_auto_ != 0) adapt(found);
}

void Ping1dEmulator::adapt(const Ping1dReturn& found) {
    const auto end = static_cast<uint32_t>(std::lround(1000 * config_.max_range));
    const uint8_t peak = last_.data.empty() ? 0 : *std::ranges::max_element(last_.data);
    if (peak == 255 && gain_ > 0) --gain_;
    if (peak < 64 && gain_ < max_gain) ++gain_;
    start_ = 0;
    const uint32_t reach = found.confidence >= 50 ? 2 * last_.measurement.distance : 2 * length_;
    length_ = std::clamp(reach, shortest_scan, end);
}

void Ping1dEmulator::report(const Wanted& wanted, bool stream) {
    const Ping1dMeasurement& made = last_.measurement;
    if (wanted.message == Ping1dProfile::message) send(wanted.client, last_, stream);
    if (wanted.message == Ping1dDistance::message) send(wanted.client, Ping1dDistance{made}, stream);
    if (wanted.message == Ping1dDistanceSimple::message)
        send(wanted.client, Ping1dDistanceSimple{made.distance, static_cast<uint8_t>(made.confidence)}, stream);
}

void Ping1dEmulator::refuseWaiting() {
    for (const Wanted& wanted : std::exchange(waiting_, {}))
        refuse(wanted.client, wanted.message, "no echoes have arrived");
}

void Ping1dEmulator::proceed(types::Time now) {
    if (const types::SonarPtr ping = turn_.due(now)) {
        noteReceived();
        finish(*ping);
    } else if (turn_.failed(now)) {
        warnOfSilence();
        refuseWaiting();
    }
    if (turn_.underWay()) return;
    if (enabled_ == 0)  // the last ping
        for (const Wanted& wanted : std::exchange(waiting_, {})) report(wanted, false);
    if (wantsPing(now)) listen(now);
}

std::optional<types::Time> Ping1dEmulator::nextWork() const {
    if (turn_.underWay()) return turn_.next();
    if (enabled_ != 0 && !streams_.empty()) return next_;
    return {};
}

}  // namespace insonify::device
