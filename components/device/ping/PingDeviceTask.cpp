#include "components/device/ping/PingDeviceTask.hpp"

namespace insonify::device {

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

}  // namespace insonify::device
