#include "components/device/MicronTask.hpp"

namespace insonify::device {

void MicronTask::listen(Network& network) {
    network.listenTcp(config->address, static_cast<uint16_t>(config->port));
    if (!config->serial.empty()) network.openSerial(outputPath(config->serial));
    emulator_.emplace(
        config->device,
        MicronEmulator::Outlet{[this](const types::SonarSettings& asked) { settings.write(asked); },
                               [this](Client to, Bytes bytes) { this->network().send(to, std::move(bytes)); },
                               [this](const std::string& text) { warn(text); }});
}

void MicronTask::takePings() {
    types::SonarPtr sample;
    while (ping.readNew(sample)) emulator_->heard(*sample);
}

}  // namespace insonify::device
