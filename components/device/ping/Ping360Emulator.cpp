#include "components/device/ping/Ping360Emulator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

namespace insonify::device {
namespace {

constexpr int turn = 400;  ///< [gradian]
constexpr size_t max_commands = 16;
constexpr double boot_seconds = 5;

/** The device's initial state. */
Ping360DeviceData atBoot() { return {1, 0, {0, 32, 80, 740, 1024}, {}}; }

std::string whyNot(uint8_t mode, const Ping360Acoustics& a) {
    return findDiagnostic({{"mode", mode, 0, 1},  // drivers also send 0
                           {"gain_setting", a.gain, 0, 2},
                           {"transmit_duration", a.transmit_duration, 1, 1000},
                           {"sample_period", a.sample_period, 80, 40000},
                           {"transmit_frequency", a.frequency_khz, 500, 1000},
                           {"number_of_samples", a.samples, 200, 1200}});
}

std::string whyNot(const Ping360Transducer& request) {
    const std::string why = whyNot(request.mode, request.acoustics);
    if (!why.empty()) return why;
    return findDiagnostic({{"angle", request.angle, 0, turn - 1}, {"transmit", request.transmit, 0, 1}});
}

std::string whyNot(const Ping360AutoTransmit& request) {
    const std::string why = whyNot(request.mode, request.acoustics);
    if (!why.empty()) return why;
    return findDiagnostic({{"start_angle", request.sector.start, 0, turn - 1},
                           {"stop_angle", request.sector.stop, 0, turn - 1},
                           {"num_steps", request.sector.steps, 1, 10},
                           {"delay", request.sector.delay_ms, 0, 100}});
}

/** Returns the shorter difference of two angles. */
int distanceBetween(int a, int b) {
    const int way = std::abs(a - b) % turn;
    return std::min(way, turn - way);
}

}  // namespace

void Ping360Config::check(types::Diagnostics& diagnostics) const {
    if (gain_db.size() != 3)
        diagnostics.push_back({"gain_db", fmt::format("has {} values; must be 3", gain_db.size())});
}

types::Angle ping360Bearing(double angle, double ahead) {
    return types::Angle::fromRad((ahead - angle) * std::numbers::pi / (turn / 2));
}

std::string ping360Discovery(std::span<const uint8_t, 6> mac, std::span<const uint8_t, 4> ip) {
    return fmt::format("SONAR PING360\r\nBlue Robotics\r\nMAC Address:- {:02X}\r\nIP Address:- {:03}\r\n",
                       fmt::join(mac, "-"), fmt::join(ip, "."));
}

Ping360Emulator::Ping360Emulator(const Ping360Config& config, double max_code)
    : PingDevice({static_cast<uint8_t>(PingDeviceType::Ping360), 1, 3, 3, 8, 0}, {1, 1, 0, 0}, 2),
      config_(config),
      max_code_(max_code),
      state_(atBoot()) {}

int Ping360Emulator::Scan::width() const { return (request.sector.stop - request.sector.start + turn) % turn; }

int Ping360Emulator::Scan::angle() const { return (request.sector.start + offset) % turn; }

void Ping360Emulator::Scan::advance() {
    const int steps = request.sector.steps;
    const auto within = [&](int to) { return to >= 0 && to <= width(); };
    if (width() > turn / 2) {
        offset = within(offset + steps) ? offset + steps : 0;
        return;
    }
    if (!within(offset + direction * steps)) direction = -direction;
    if (within(offset + direction * steps)) offset += direction * steps;
}

double Ping360Emulator::listens() const { return state_.acoustics.samples * state_.acoustics.sample_period * 25e-9; }

void Ping360Emulator::command(PingClient client, const PingFrame& frame, types::Time now) {
    switch (frame.message) {
        case Ping360Transducer::message:
            return with<Ping360Transducer>(client, frame, [&](const auto& m) { applyTransducer(client, m); });
        case Ping360AutoTransmit::message:
            return with<Ping360AutoTransmit>(client, frame, [&](const auto& m) { applyAutoTransmit(client, m); });
        case Ping360MotorOff::message: scan_.reset(); return acknowledge(client, frame.message);
        case Ping360SetDeviceId::message:
            return with<Ping360SetDeviceId>(client, frame,
                                            [&](const auto& m) { setId(client, m.message, m.device_id, 1); });
        case Ping360Reset::message:
            return with<Ping360Reset>(client, frame, [&](const auto& m) {
                acknowledge(client, m.message);
                reset(m.bootloader != 0, now);
            });
        default: return refuse(client, frame.message, "there is no such message");
    }
}

bool Ping360Emulator::answer(PingClient client, uint16_t requested, types::Time /*now*/) {
    Ping360DeviceData state = state_;
    state.data.clear();
    if (requested == Ping360DeviceData::message) send(client, state);
    if (requested == Ping360AutoDeviceData::message)
        send(client,
             Ping360AutoDeviceData{
                 state.mode, state.angle, state.acoustics, scan_ ? scan_->request.sector : Ping360Sector{}, {}});
    return requested == Ping360DeviceData::message || requested == Ping360AutoDeviceData::message;
}

void Ping360Emulator::applyTransducer(PingClient client, const Ping360Transducer& request) {
    if (const std::string why = whyNot(request); !why.empty()) return refuse(client, request.message, why);
    if (commands_.size() >= max_commands) return refuse(client, request.message, "too many commands wait already");
    scan_.reset();
    commands_.push_back({client, request});
}

void Ping360Emulator::applyAutoTransmit(PingClient client, const Ping360AutoTransmit& request) {
    if (const std::string why = whyNot(request); !why.empty()) return refuse(client, request.message, why);
    scan_ = Scan{client, request, ++scans_};
    if (phase_ == Phase::Idle) ready_ = {};
}

void Ping360Emulator::forget(PingClient client) {
    if (scan_ && scan_->client == client) scan_.reset();
    const bool at_hand = phase_ != Phase::Idle && !scanning_;
    for (size_t i = commands_.size(); i-- > 0;) {
        if (commands_[i].client != client) continue;
        if (i == 0 && at_hand)
            commands_[i].client.reset();
        else
            commands_.erase(commands_.begin() + static_cast<ptrdiff_t>(i));
    }
}

void Ping360Emulator::reset(bool bootloader, types::Time now) {
    state_ = atBoot();
    phase_ = Phase::Idle;
    scanning_ = false;
    commands_.clear();
    scan_.reset();
    turn_.drop();
    if (bootloader) setDeaf(now + types::Time::fromSeconds(boot_seconds));
}

void Ping360Emulator::turnTo(const Ping360Transducer& request, types::Time now) {
    const double seconds = config_.seconds_per_gradian * distanceBetween(state_.angle, request.angle);
    state_.angle = request.angle;
    state_.acoustics = request.acoustics;
    ready_ = now + types::Time::fromSeconds(seconds);
    phase_ = Phase::Turning;
}

bool Ping360Emulator::begin(types::Time now) {
    scanning_ = commands_.empty();
    if (!scanning_) {
        turnTo(commands_.front().request, now);
        return true;
    }
    if (!scan_ || now < ready_) return false;
    scan_at_hand_ = scan_->number;
    turnTo({1, static_cast<uint16_t>(scan_->angle()), scan_->request.acoustics, 1, 0}, now);
    return true;
}

void Ping360Emulator::listen(types::Time now) {
    types::SonarSettings wanted;
    wanted.bearing = ping360Bearing(state_.angle, config_.ahead);
    wanted.frequency_khz = state_.acoustics.frequency_khz;
    wanted.gain_db = config_.gain_db[state_.acoustics.gain];
    wanted.bin_count = state_.acoustics.samples;
    const double takes = state_.acoustics.transmit_duration * 1e-6 + listens() + config_.overhead;
    turn_.ask(wanted, listens(), takes, now);
    phase_ = Phase::Listening;
}

void Ping360Emulator::finish(types::Time now, Bytes data) {
    phase_ = Phase::Idle;
    if (!scanning_) {
        const Command done = commands_.front();
        commands_.pop_front();
        if (done.client)
            send(*done.client, Ping360DeviceData{1, done.request.angle, done.request.acoustics, std::move(data)});
        return;
    }
    if (!scan_ || scan_->number != scan_at_hand_) return;
    send(scan_->client,
         Ping360AutoDeviceData{1, state_.angle, state_.acoustics, scan_->request.sector, std::move(data)}, true);
    scan_->advance();
    ready_ = now + types::Time{1000 * scan_->request.sector.delay_ms};
}

void Ping360Emulator::fail(types::Time now) {
    warnOfSilence();
    phase_ = Phase::Idle;
    ready_ = now;
    if (scanning_) return;
    const Command failed = commands_.front();
    commands_.pop_front();
    if (failed.client) refuse(*failed.client, Ping360Transducer::message, "no echoes have arrived");
}

bool Ping360Emulator::step(types::Time now) {
    if (phase_ == Phase::Idle) return begin(now);
    if (phase_ == Phase::Turning) {
        if (now < ready_) return false;
        if (!scanning_ && commands_.front().request.transmit == 0)
            finish(now, {});
        else
            listen(now);
        return true;
    }
    if (const types::SonarPtr ping = turn_.due(now)) {
        noteReceived();
        finish(now, bytesOfCodes(ping->bins, max_code_));
        return true;
    }
    if (!turn_.failed(now)) return false;
    fail(now);
    return true;
}

void Ping360Emulator::proceed(types::Time now) {
    while (step(now)) continue;
}

std::optional<types::Time> Ping360Emulator::nextWork() const {
    if (phase_ == Phase::Listening) return turn_.next();
    if (phase_ == Phase::Turning || scan_) return ready_;
    return {};
}

}  // namespace insonify::device
