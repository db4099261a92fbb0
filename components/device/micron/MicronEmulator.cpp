#include "components/device/micron/MicronEmulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/device/DeviceBins.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::device {
namespace {

constexpr double alive_period = 1;        // [s]
constexpr double motor_unit = 10e-6;      // motor_delay counts in this unit [s]
constexpr double interval_unit = 640e-9;  // ad_interval counts in this unit [s]
constexpr double clock_hz = 32e6;         // unit of transmit frequencies
constexpr double full_gain = 210, usual_gain = 84, full_gain_db = 80;
constexpr double max_code = 65535;
constexpr uint16_t max_bins = 1500, max_interval = 1500;
constexpr double lowest_khz = 100, highest_khz = 2000;

int wrapped(int angle) { return (angle % seanet_turn + seanet_turn) % seanet_turn; }

types::Time seconds(double value) { return types::Time::fromSeconds(value); }

/** Returns why a head refuses a command; null: it accepts. */
const char* refusal(const SeaNetHeadCommand& command) {
    if (command.bins == 0 || command.bins > max_bins) return "must have 1 to 1500 bins";
    if (command.ad_interval == 0 || command.ad_interval > max_interval) return "must have an ad_interval of 1 to 1500";
    if (command.left >= seanet_turn || command.right >= seanet_turn) return "must have limits of 0 to 6399";
    return nullptr;
}

}  // namespace

void MicronEmulator::opened(Client client) { clients_[client]; }

void MicronEmulator::closed(Client client) {
    clients_.erase(client);
    if (line_) std::erase(line_->clients, client);
}

types::Time MicronEmulator::follow(types::Time clock) {
    const types::Time now = steady_.read(clock);
    if (steady_.jumpedBack() && line_ && !line_->request.empty()) askForPing(now);
    return now;
}

void MicronEmulator::received(Client client, std::span<const uint8_t> bytes, types::Time clock) {
    const types::Time now = follow(clock);
    SeaNetReader& reader = clients_[client];
    reader.add(bytes);
    while (const auto message = reader.next()) take(client, *message, now);
}

void MicronEmulator::take(Client client, const SeaNetMessage& message, types::Time now) {
    if (message.to != seanet_imaging_sonar && message.to != seanet_computer) return;  // 255: to every node
    switch (message.type) {
        case SeaNetType::Reboot: return reboot(now);
        case SeaNetType::SendVersion:
            return outlet_.send(client, SeaNetVersion{.software = 12,
                                                      .info = 1,
                                                      .serial = static_cast<uint16_t>(device_.serial_number),
                                                      .program_length = 0x10000,
                                                      .program_sum = 0x1234}
                                            .message()
                                            .packet());
        case SeaNetType::SendUserData: return outlet_.send(client, SeaNetUserData{}.message().packet());
        case SeaNetType::HeadCommand: return configure(client, message, now);
        case SeaNetType::SendData: return requestLine(client, now);
        case SeaNetType::StopAlive: sends_alive_ = false; return;
        default: return;
    }
}

void MicronEmulator::reboot(types::Time now) {
    state_ = State::Booting;
    begun_ = now;
    next_alive_ = now + seconds(device_.boot_time);
    sends_alive_ = true;
    bearing_ = seanet_ahead;
    line_.reset();
}

types::Time MicronEmulator::centred() const {
    return begun_ + seconds(device_.boot_time) + seconds(device_.centring_time);
}

void MicronEmulator::reverse() {
    if (state_ == State::Ready) backwards_ = !backwards_;
}

void MicronEmulator::configure(Client client, const SeaNetMessage& message, types::Time now) {
    if (SeaNetHeadCommand::isReversal(message)) return reverse();
    const auto command = SeaNetHeadCommand::in(message);
    const char* why = command ? refusal(*command) : "is too short";
    line_.reset();
    if (why) {
        outlet_.warn(fmt::format("a head command was refused: it {}", why));
        if (state_ == State::Ready) state_ = State::Unconfigured;
    } else {
        command_ = *command;
        state_ = State::Ready;
        backwards_ = false;
        arrived_ = std::max(now, centred());
        if (!isWithinSector()) turnTo(command_.left);
    }
    outlet_.send(client, alive(now).message().packet());
}

void MicronEmulator::requestLine(Client client, types::Time now) {
    if (state_ != State::Ready) return outlet_.send(client, alive(now).message().packet());
    if (!line_) {
        line_.emplace();
        line_->ready = std::max(now, arrived_);
    }
    if (std::ranges::find(line_->clients, client) == line_->clients.end()) line_->clients.push_back(client);
}

double MicronEmulator::listening() const { return command_.bins * command_.ad_interval * interval_unit; }

void MicronEmulator::askForPing(types::Time now) {
    line_->whole = now + seconds(listening());
    types::SonarSettings settings;
    settings.time = steady_.clock(now);
    settings.range = listening() * device_.speed_of_sound / 2;
    settings.speed_of_sound = device_.speed_of_sound;
    settings.bin_count = command_.bins;
    const uint32_t transmit = command_.transmit[command_.has(SeaNetControl::second_channel) ? 1 : 0];
    const double named_khz = std::ldexp(transmit * clock_hz, -32) / 1e3;
    settings.frequency_khz = named_khz >= lowest_khz && named_khz <= highest_khz ? named_khz : device_.frequency_khz;
    settings.gain_db = (std::min<double>(command_.gain, full_gain) - usual_gain) / full_gain * full_gain_db;
    const int clockwise = bearing_ - seanet_ahead;
    settings.bearing = types::Angle::fromRad((command_.has(SeaNetControl::inverted) ? 1 : -1) * 2 * std::numbers::pi *
                                             clockwise / seanet_turn);
    if (command_.has(SeaNetControl::silent)) {
        line_->data = getData({});
    } else {
        line_->request.add(now, line_->whole);
        outlet_.ask(settings);
    }
}

Bytes MicronEmulator::getData(const types::Sonar& ping) const {
    const auto level = [&](size_t bin) {  // in 255ths of 80 dB
        const double code = bin < ping.bins.size() ? static_cast<double>(ping.bins[bin]) : 0;
        return std::isfinite(code) ? 255 * std::clamp(code / max_code, 0.0, 1.0) : 0;
    };
    if (command_.has(SeaNetControl::eight_bits)) {
        Bytes data(command_.bins);
        for (size_t bin = 0; bin < data.size(); ++bin) data[bin] = static_cast<uint8_t>(std::lround(level(bin)));
        return data;
    }
    Bytes data((command_.bins + 1) / 2);
    const double span = std::max<double>(command_.ad_span, 1);
    for (size_t bin = 0; bin < command_.bins; ++bin) {
        const long four = std::lround(15 * std::clamp((level(bin) - command_.ad_low) / span, 0.0, 1.0));
        data[bin / 2] |= static_cast<uint8_t>(four << (bin % 2 == 0 ? 0 : 4));
    }
    return data;
}

void MicronEmulator::setPing(const types::Sonar& ping) {
    if (!line_ || !line_->request.take(steady_.steady(ping.time))) return;
    warned_ = false;
    types::Sonar scaled = ping;
    const bool is_other = ping.bin_count == command_.bins &&
                          setBinWidth(listening() * device_.speed_of_sound / 2 / command_.bins, scaled);
    line_->data = getData(is_other ? scaled : ping);
}

void MicronEmulator::finishLine() {
    SeaNetHeadData answer;
    answer.command = command_;
    answer.bearing = static_cast<uint16_t>(bearing_);
    if (!command_.has(SeaNetControl::continuous))
        answer.sweep = bearing_ == command_.left ? 1 : bearing_ == command_.right ? 2 : 0;
    answer.data = std::move(*line_->data);
    const Bytes packet = answer.message().packet();
    for (const Client client : line_->clients) outlet_.send(client, packet);
    arrived_ = line_->whole;
    line_.reset();
    turn();
}

bool MicronEmulator::isWithinSector() const {
    return command_.has(SeaNetControl::continuous) ||
           wrapped(bearing_ - command_.left) <= wrapped(command_.right - command_.left);
}

void MicronEmulator::turnTo(int bearing) {
    const int way = std::min(wrapped(bearing - bearing_), wrapped(bearing_ - bearing));
    bearing_ = wrapped(bearing);
    arrived_ = arrived_ + seconds(way * command_.motor_delay * motor_unit);
}

void MicronEmulator::turn() {
    if (command_.has(SeaNetControl::motor_off)) return;
    if (command_.has(SeaNetControl::continuous))
        return turnTo(bearing_ + (backwards_ ? -command_.step : command_.step));
    const int width = wrapped(command_.right - command_.left);
    const int place = wrapped(bearing_ - command_.left) + (backwards_ ? -1 : 1) * command_.step;
    backwards_ = place >= width || (backwards_ && place > 0);
    turnTo(command_.left + std::clamp(place, 0, width));
}

SeaNetAlive MicronEmulator::alive(types::Time now) const {
    const bool ready = state_ == State::Ready;
    const bool recentring = now < centred();
    return {.recentring = recentring,
            .centred = !recentring,
            .motor_on = true,
            .scanning = line_.has_value(),
            .unconfigured = !ready,
            .configured = ready,
            .milliseconds = static_cast<uint32_t>((now - begun_).microseconds / 1000),
            .bearing = static_cast<uint16_t>(bearing_)};
}

void MicronEmulator::sendAlive(types::Time now) {
    next_alive_ = now + seconds(alive_period);
    if (state_ == State::Booting) state_ = State::Unconfigured;
    if (!sends_alive_) return;
    const Bytes packet = alive(now).message().packet();
    for (const auto& [client, reader] : clients_) outlet_.send(client, packet);
}

std::optional<types::Time> MicronEmulator::tick(types::Time clock) { return steady_.clock(workAt(follow(clock))); }

types::Time MicronEmulator::workAt(types::Time now) {
    if (state_ == State::Off) reboot(now);
    if (line_ && line_->request.empty() && !line_->data && now >= line_->ready) askForPing(now);
    if (line_ && line_->data && now >= line_->whole) finishLine();
    if (line_ && line_->request.isLate(now)) {
        if (!warned_) outlet_.warn("a requested ping did not arrive; its scan line waits for another");
        warned_ = true;
        askForPing(now);
    }
    const bool is_late = line_ && line_->request.size() > 1;
    if (now >= next_alive_ && (!line_ || is_late)) sendAlive(now);
    if (!line_) return next_alive_;
    if (line_->data) return line_->whole;
    if (line_->request.empty()) return line_->ready;
    return is_late ? std::min(line_->request.deadline(), next_alive_) : line_->request.deadline();
}

}  // namespace insonify::device
