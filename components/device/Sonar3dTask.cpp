#include "components/device/Sonar3dTask.hpp"

namespace insonify::device {

void Sonar3dTask::listen(Network& network) {
    network.listenTcp(config->address, static_cast<uint16_t>(config->port));
    clients_.clear();
    emulator_.emplace(config->device,
                      Sonar3dEmulator::Outlet{[this](const types::SonarSettings& asked) { settings.write(asked); },
                                              [this](const std::string& address, uint16_t port, Bytes packet) {
                                                  this->network().sendTo(address, port, std::move(packet));
                                              },
                                              [this](const std::string& text) { warn(text); }});
}

void Sonar3dTask::received(Client client, std::span<const uint8_t> bytes) {
    HttpReader& reader = clients_[client];
    reader.add(bytes);
    while (const auto request = reader.next()) {
        network().send(client, httpBytes(emulator_->answer(*request, now()), request->keep_alive));
        if (!request->keep_alive) network().close(client);
    }
    if (!reader.refusal()) return;
    network().send(client, httpBytes(*reader.refusal(), false));
    network().close(client);
}

void Sonar3dTask::takePings() {
    types::DepthMapPtr map;
    while (range_image.readNew(map)) emulator_->heard(*map);
}

}  // namespace insonify::device
