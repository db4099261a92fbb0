#include "components/device/PingDeviceTask.hpp"

namespace insonify::device {

void PingDeviceTask::listen(Network& network) {
    const auto port = static_cast<uint16_t>(ends().port);
    network.listenUdp(ends().address, port);
    network.listenTcp(ends().address, port);
    if (!ends().serial.empty()) network.openSerial(outputPath(ends().serial));
    device_ = makeDevice();
}

void PingDeviceTask::received(Client client, std::span<const uint8_t> bytes) {
    device_->receive(numberOf(client), bytes, client.end == udp, now());
    sendWhatIsWanted();
}

void PingDeviceTask::closed(Client client) { device_->close(numberOf(client)); }

void PingDeviceTask::takePings() {
    for (types::SonarPtr sample; ping.readNew(sample);) device_->hear(sample, now());
}

std::optional<types::Time> PingDeviceTask::tick(types::Time now) {
    device_->tick(now);
    sendWhatIsWanted();
    return device_->wakeAt();
}

void PingDeviceTask::sendWhatIsWanted() {
    for (PingOutgoing& out : device_->takeOutgoing())
        network().send(clientOf(out.client), std::move(out.bytes),
                       out.stream ? Network::Kind::Stream : Network::Kind::Reply);
    if (const auto asked = device_->takeAsked()) settings.write(*asked);
    for (const std::string& warning : device_->takeWarnings()) warn(warning);
}

}  // namespace insonify::device
