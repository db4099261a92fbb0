#include "components/device/ping/PingDevice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/device/DeviceBins.hpp"

namespace insonify::device {
namespace {

constexpr size_t max_payload_to_device = 64;  ///< [bytes]

types::Time after(types::Time now, double seconds) { return now + types::Time::fromSeconds(seconds); }

}  // namespace

std::string findDiagnostic(std::initializer_list<PingBound> bounds) {
    for (const PingBound& bound : bounds)
        if (bound.value < bound.min || bound.value > bound.max)
            return fmt::format("{} is {}; must be {} to {}", bound.name, bound.value, bound.min, bound.max);
    return "";
}

Bytes bytesOfCodes(std::span<const float> codes, double max_code) {
    Bytes bytes(codes.size());
    std::ranges::transform(codes, bytes.begin(), [&](float code) {
        const double part = code > 0 ? code / max_code : 0;  // 0 for NaN
        return static_cast<uint8_t>(std::lround(255 * std::min(1.0, part)));
    });
    return bytes;
}

void PingTurn::ask(types::SonarSettings wanted, double listens, double earliest, types::Time now) {
    wanted_ = wanted;
    listens_ = listens;
    again_ = false;
    due_ = after(now, earliest);
    ask(now);
}

void PingTurn::ask(types::Time now) {
    wanted_.time = now;
    wanted_.range = speed_of_sound_ * listens_ / 2;
    unsent_ = wanted_;
    requests_.add(now, after(std::max(now, due_), listens_));
}

bool PingTurn::take(const types::SonarPtr& ping, types::Time stamp, types::Time now) {
    if (!requests_.awaits(stamp)) return false;
    if (ping->beam_count != 1 || ping->bin_count != wanted_.bin_count || !ping->wellShaped()) {
        warning_ = fmt::format(
            "pings have {} beams of {} bins where the driver asked for one of {}; connect `settings` to a sonar of one "
            "beam",
            ping->beam_count, ping->bin_count, wanted_.bin_count);
        return false;
    }
    requests_.clear();
    const double speed = static_cast<double>(ping->speed_of_sound);
    const bool other = speed > 0 && std::abs(speed / speed_of_sound_ - 1) > 1e-6;
    if (other) speed_of_sound_ = speed;
    if (other && !std::exchange(again_, true)) {
        ask(now);
        return true;
    }
    auto scaled = std::make_shared<types::Sonar>(*ping);
    ping_ = setBinWidth(speed_of_sound_ * listens_ / 2 / ping->bin_count, *scaled) ? scaled : ping;
    return true;
}

types::SonarPtr PingTurn::due(types::Time now) {
    if (!ping_ || now < due_) return nullptr;
    return std::exchange(ping_, {});
}

bool PingTurn::failed(types::Time now) {
    if (!requests_.isLate(now)) return false;
    requests_.clear();
    return true;
}

types::Time PingDevice::follow(types::Time clock) {
    now_ = steady_.read(clock);
    if (steady_.jumpedBack()) turn_.repeat(now_);
    return now_;
}

std::optional<types::Time> PingDevice::wakeAt() const {
    auto next = nextWork();
    if (now_ < deaf_until_) next = std::min(next.value_or(deaf_until_), deaf_until_);
    return next ? std::optional(steady_.clock(*next)) : std::nullopt;
}

std::optional<types::SonarSettings> PingDevice::consumeRequest() {
    auto request = turn_.consumeRequest();
    if (request) request->time = steady_.clock(request->time);
    return request;
}

void PingDevice::receive(PingClient client, std::span<const uint8_t> bytes, bool datagram, types::Time clock) {
    const types::Time now = follow(clock);
    if (datagram) {
        for (const PingFrame& frame : pingFrames(bytes, max_payload_to_device)) handle(client, frame, now);
    } else {
        PingFrameReader& reader = readers_.try_emplace(client, max_payload_to_device).first->second;
        reader.add(bytes);
        while (const auto frame = reader.next()) handle(client, *frame, now);
    }
    proceed(now);
}

void PingDevice::close(PingClient client) {
    readers_.erase(client);
    std::erase_if(outgoing_, [&](const PingOutgoing& each) { return each.client == client; });
    forget(client);
}

void PingDevice::setPing(const types::SonarPtr& ping, types::Time clock) {
    const types::Time now = follow(clock);
    turn_.take(ping, steady_.steady(ping->time), now);
    if (std::string warning = turn_.consumeWarning(); !warning.empty() && !std::exchange(silent_, true))
        warnings_.push_back(std::move(warning));
    proceed(now);
}

void PingDevice::handle(PingClient client, const PingFrame& frame, types::Time now) {
    constexpr uint8_t all = 0, broadcast = 255;
    if (now < deaf_until_) return;
    if (frame.destination != all && frame.destination != broadcast && frame.destination != id_) return;
    if (frame.message >= PingAck::message && frame.message <= PingText::message) return;  // answers are not answered
    if (frame.message == PingGeneralRequest::message)
        with<PingGeneralRequest>(client, frame, [&](const auto& m) { handleRequest(client, m.requested, now); });
    else if (frame.message == PingSetDeviceId::message)
        with<PingSetDeviceId>(client, frame, [&](const auto& m) { setId(client, m.message, m.device_id, 1); });
    else if (!frame.payload.empty() || !answerAny(client, frame.message, now))
        command(client, frame, now);
}

bool PingDevice::answerAny(PingClient client, uint16_t requested, types::Time now) {
    if (requested == PingDeviceInformation::message) return send(client, information_), true;
    if (requested == PingProtocolVersion::message) return send(client, version_), true;
    return answer(client, requested, now);
}

void PingDevice::handleRequest(PingClient client, uint16_t requested, types::Time now) {
    if (!answerAny(client, requested, now)) refuse(client, requested, "there is no such message to request");
}

void PingDevice::add(PingOutgoing out) {
    const auto same = std::ranges::find_if(
        outgoing_, [&](const PingOutgoing& each) { return out.stream && each.stream && each.client == out.client; });
    if (same == outgoing_.end())
        outgoing_.push_back(std::move(out));
    else
        same->bytes.insert(same->bytes.end(), out.bytes.begin(), out.bytes.end());
}

void PingDevice::setId(PingClient client, uint16_t message, uint8_t id, uint8_t min) {
    if (const std::string why = findDiagnostic({{"id", id, min, 254}}); !why.empty())
        return refuse(client, message, why);
    id_ = id;
    acknowledge(client, message);
}

void PingDevice::warnOfSilence() {
    if (std::exchange(silent_, true)) return;
    warnings_.emplace_back("no ping has arrived for the driver's request; is `settings` connected to a running sonar?");
}

}  // namespace insonify::device
