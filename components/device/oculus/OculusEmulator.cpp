#include "components/device/oculus/OculusEmulator.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::device {
namespace {

using types::Time;

const Time second{1'000'000}, dummy_period{100'000};

Time period(const OculusFire& fire) { return Time::fromSeconds(1 / fire.rateHz()); }

/** In high frequency the device's gain is at least 40 %; a driver's 0 to 100 % are mapped to the rest. */
double usedGain(const OculusFire& fire) { return fire.mode == 2 ? 40 + 0.6 * fire.gain_percent : fire.gain_percent; }

}  // namespace

const sonars::SonarFigures& figures(OculusModel model) {
    return sonars::sonar("oculus_" + std::string(types::EnumNames<OculusModel>::names[static_cast<size_t>(model)]));
}

const sonars::SonarMode& oculusMode(const sonars::SonarFigures& figures, uint8_t number) {
    return figures.modes[number == 2 && figures.modes.size() > 1 ? 1 : 0];
}

std::optional<OculusModel> oculusModel(uint16_t part) {
    for (const OculusModel model : {OculusModel::M370s, OculusModel::M750d, OculusModel::M1200d, OculusModel::M3000d})
        if (figures(model).part == part) return model;
    return std::nullopt;
}

OculusEmulator::OculusEmulator(const OculusConfig& config, Time started)
    : config_(config), figures_(figures(config.model)), encoder_(config.code_bits), started_(steady_.read(started)) {
    fire_.rate = OculusFire::standby;
}

void OculusEmulator::received(ClientId client, std::span<const uint8_t> bytes) {
    const auto found = clients_.find(client);
    if (found == clients_.end()) return;
    found->second.add(bytes);
    for (Bytes message = found->second.next(); !message.empty(); message = found->second.next()) take(message);
}

void OculusEmulator::closed(ClientId client) {
    clients_.erase(client);
    if (clients_.empty()) fire_.rate = OculusFire::standby;
}

void OculusEmulator::take(std::span<const uint8_t> message) {
    if (oculusUserConfig(message)) return;  // the network settings are not changed
    const auto request = oculusFire(message);
    const auto settings = request ? possible(*request) : std::nullopt;
    if (!settings) return void(++refused_);
    fire_ = *settings;
    speed_was_set_ = speed_was_set_ || fire_.speed_of_sound != 0;
}

std::optional<OculusFire> OculusEmulator::possible(OculusFire fire) const {
    for (const double number : {fire.range, fire.gain_percent, fire.speed_of_sound, fire.salinity})
        if (!std::isfinite(number)) return std::nullopt;
    fire.mode = fire.mode == 2 && figures_.modes.size() > 1 ? 2 : 1;
    fire.gain_percent = std::clamp(fire.gain_percent, 0.0, 100.0);
    if (fire.speed_of_sound != 0) fire.speed_of_sound = std::clamp(fire.speed_of_sound, 1300.0, 1700.0);
    const bool metres = (fire.flags & OculusFire::range_in_metres) != 0;
    const double shortest = mode(fire).range_min, longest = mode(fire).range_max;
    fire.range =
        metres ? std::clamp(fire.range, shortest, longest) : std::clamp(fire.range, 100 * shortest / longest, 100.0);
    return fire;
}

double OculusEmulator::computeRange(const OculusFire& fire) const {
    const bool metres = (fire.flags & OculusFire::range_in_metres) != 0;
    return metres ? fire.range : std::max(mode(fire).range_min, fire.range / 100 * mode(fire).range_max);
}

types::SonarSettings OculusEmulator::getSettings(const OculusFire& fire, Time now) const {
    types::SonarSettings settings;
    settings.time = now;
    settings.range = computeRange(fire);
    settings.frequency_khz = mode(fire).frequency_khz;
    settings.speed_of_sound = fire.speed_of_sound != 0 || speed_was_set_ ? fire.speed_of_sound : settings.unset;
    settings.gain_db = std::lerp(config_.gain_min_db, config_.gain_max_db, usedGain(fire) / 100);
    settings.field_of_view = types::Angle::fromDeg(mode(fire).field_of_view_deg);
    settings.beam_height = types::Angle::fromDeg(mode(fire).beam_height_deg);
    const double finest = std::floor(settings.range / mode(fire).range_resolution * (1 + 1e-9));
    settings.bin_count = static_cast<uint32_t>(std::clamp(finest, 1.0, static_cast<double>(config_.bin_count)));
    settings.beam_count = (fire.flags & OculusFire::beams_512) != 0 ? 512 : 256;
    return settings;
}

bool OculusEmulator::isDue(Time now) {
    if (!requests_.empty()) {
        if (was_set_back_) return true;
        if (now < requests_.deadline(2.0 * static_cast<double>(requests_.size()))) return false;
        ++lost_;
    }
    return now >= last_ping_ + period(fire_);
}

Time OculusEmulator::follow(Time clock) {
    const Time now = steady_.read(clock);
    was_set_back_ = was_set_back_ || steady_.jumpedBack();
    return now;
}

OculusEmulator::Due OculusEmulator::tick(Time clock) {
    Due due = workAt(follow(clock), clock);
    was_set_back_ = false;
    due.next = steady_.clock(due.next);
    return due;
}

OculusEmulator::Due OculusEmulator::workAt(Time now, Time clock) {
    Due due;
    if (now >= last_status_ + second) {
        due.status = statusBytes();
        last_status_ = now;
    }
    due.next = last_status_ + second;
    if (clients_.empty()) return due;
    if (inStandby()) {
        if (now >= last_dummy_ + dummy_period) {
            due.dummy = oculusDummy(static_cast<uint16_t>(config_.serial_number), static_cast<uint16_t>(figures_.part));
            last_dummy_ = now;
        }
        due.next = std::min(due.next, last_dummy_ + dummy_period);
        return due;
    }
    if (isDue(now)) {
        due.ask = getSettings(fire_, clock);
        requests_.add(now, now + Time::fromSeconds(2 * due.ask->range / 1300), {now, *due.ask, fire_});
        const Time planned = last_ping_ + period(fire_);  // keeps the rate even if a cycle is late
        last_ping_ = now - planned < period(fire_) ? planned : now;
    }
    due.next = std::min(due.next, requests_.empty() ? last_ping_ + period(fire_) : now + second);
    return due;
}

Bytes OculusEmulator::ping(const types::Sonar& codes) {
    const bool fits = codes.bin_count > 0 && codes.beam_count > 0 && codes.bin_count <= 65535 &&
                      codes.beam_count <= 65535 && codes.wellShaped();
    const auto request = fits ? requests_.take(steady_.steady(codes.time)) : std::nullopt;
    if (!request) return {};
    if (inStandby()) return {};
    return toBytes(makeResult(*request, codes));
}

OculusResult OculusEmulator::makeResult(const Request& request, const types::Sonar& codes) {
    OculusResult result;
    result.fire = request.fire;
    result.fire.header = {.source = static_cast<uint16_t>(config_.serial_number),
                          .id = static_cast<uint16_t>(OculusId::PingResult),
                          .version = std::min<uint16_t>(request.fire.header.version, request.fire.isVersion2() ? 2 : 1),
                          .part = static_cast<uint16_t>(figures_.part)};
    result.fire.gain_percent = usedGain(request.fire);
    result.number = number_++;
    result.frequency_hz = 1e3 * request.settings.frequency_khz;
    result.temperature_celsius = config_.temperature_celsius;
    result.pressure_bar = config_.pressure_bar;
    result.speed_of_sound = static_cast<double>(codes.speed_of_sound);
    result.start_s = (request.time - started_).seconds();
    result.start_ticks = static_cast<uint32_t>(static_cast<uint64_t>(result.start_s * oculus_ticks_per_second));
    result.range_resolution = codes.binWidth();
    if (!(result.range_resolution > 0)) result.range_resolution = request.settings.range / codes.bin_count;
    encoder_.encode(codes, result);
    result.settle();
    return result;
}

Bytes OculusEmulator::statusBytes() const {
    OculusStatus status;
    status.header.source = static_cast<uint16_t>(config_.serial_number);
    status.header.part = status.part = static_cast<uint16_t>(figures_.part);
    status.device_id = static_cast<uint32_t>(config_.serial_number);
    status.address = ipv4(config_.device_address).value_or(Ipv4{});
    status.mask = {255, 255, 255, 0};
    const uint16_t serial = status.header.source;
    status.mac = {0x02, 0x4F, 0x53, 0, static_cast<uint8_t>(serial >> 8), static_cast<uint8_t>(serial)};
    status.temperatures.fill(config_.temperature_celsius);
    status.pressure_bar = config_.pressure_bar;
    return toBytes(status);
}

}  // namespace insonify::device
