#include "components/device/ping/PingDeviceTask.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>

namespace insonify::device {
namespace {

/** Parses "02-00-00-00-03-60"; none for other texts. */
std::optional<std::array<uint8_t, 6>> readMac(const std::string& text) {
    std::array<uint8_t, 6> parts{};
    const char* at = text.c_str();
    for (size_t i = 0; i < parts.size(); ++i) {
        char* end = nullptr;
        if (!std::isxdigit(static_cast<unsigned char>(*at))) return {};
        const unsigned long part = std::strtoul(at, &end, 16);
        if (end == at || part > 255 || *end != (i + 1 < parts.size() ? '-' : '\0')) return {};
        parts[i] = static_cast<uint8_t>(part);
        at = end + 1;
    }
    return parts;
}

}  // namespace

void PingDeviceTask::listen(Network& network) {
    const auto port = static_cast<uint16_t>(ends().port);
    network.listenUdp(ends().address, port);
    network.listenTcp(ends().address, port);
    if (!ends().serial.empty()) network.openSerial(outputPath(ends().serial));
    device_ = makeDevice();
}

void PingDeviceTask::received(Client client, std::span<const uint8_t> bytes) {
    device_->receive(getNumber(client), bytes, client.end == udp, now());
    sendWhatIsWanted();
}

void PingDeviceTask::closed(Client client) { device_->close(getNumber(client)); }

void PingDeviceTask::readPings() {
    for (types::SonarPtr sample; ping.readNew(sample);) device_->setPing(sample, now());
}

std::optional<types::Time> PingDeviceTask::tick(types::Time now) {
    device_->tick(now);
    sendWhatIsWanted();
    return device_->wakeAt();
}

void PingDeviceTask::send(Client client, PingOutgoing out) {
    const auto kind = out.stream ? Network::Kind::Stream : Network::Kind::Reply;
    if (client.end != udp) return network().send(client, std::move(out.bytes), kind);
    for (const PingFrame& frame : pingFrames(out.bytes, UINT16_MAX))  // one frame per datagram
        network().send(client, frame.bytes(), kind);
}

void PingDeviceTask::sendWhatIsWanted() {
    for (PingOutgoing& out : device_->consumeOutgoing()) send(getClient(out.client), std::move(out));
    if (const auto request = device_->consumeRequest()) settings.write(*request);
    for (const std::string& warning : device_->consumeWarnings()) warn(warning);
}

void Ping360Discovery::check(types::Diagnostics& diagnostics) const {
    if (!ipv4(ip)) diagnostics.push_back({"ip", "is '" + ip + "'; write it as 192.168.2.10"});
    if (!readMac(mac)) diagnostics.push_back({"mac", "is '" + mac + "'; write it as 02-00-00-00-03-60"});
}

std::string Ping360Discovery::answer() const {
    return ping360Discovery(readMac(mac).value_or(std::array<uint8_t, 6>{}), ipv4(ip).value_or(Ipv4{}));
}

void Ping360Task::listen(Network& network) {
    PingDeviceTask::listen(network);
    finders_.reset();
    if (config->discovery) finders_ = network.listenUdp("0.0.0.0", static_cast<uint16_t>(config->discovery->port));
}

void Ping360Task::received(Client client, std::span<const uint8_t> bytes) {
    if (client.end != finders_) return PingDeviceTask::received(client, bytes);
    constexpr std::string_view question = "Discovery";
    if (bytes.size() < question.size() || !std::equal(question.begin(), question.end(), bytes.begin())) return;
    const std::string answer = config->discovery->answer();
    network().send(client, Bytes(answer.begin(), answer.end()));
}

}  // namespace insonify::device
