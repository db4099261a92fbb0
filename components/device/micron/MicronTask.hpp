#pragma once
#include <optional>
#include <string>

#include "components/device/DeviceTask.hpp"
#include "components/device/micron/MicronEmulator.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::device {

struct MicronConfig {
    std::string address = "127.0.0.1";
    int port = 4001;
    std::string serial;
    MicronDevice device;

    static void describe(auto& self, auto& visit) {
        visit(listen_address, self.address);
        visit({"port", "1", "TCP port; 0: a free port, named in a notice", 0, 65535}, self.port);
        visit({"serial", "",
               "the file that drivers open as a serial line, relative to the run's output folder; "
               "empty: none"},
              self.serial);
        MicronDevice::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const { checkAddress(diagnostics, address); }
};

/** Replaces a Tritech Micron or a SeaKing, for drivers that speak SeaNet over TCP or a serial line. MicronEmulator has
 *  the device's behaviour. The sonar is a sonar::ScanningSonarTask. Scan lines are made from the pings of `ping`, in
 *  codes of 16 bits on a scale of 80 dB. */
class MicronTask final : public DeviceTask {
public:
    using DeviceTask::DeviceTask;

    framework::Properties<MicronConfig> config{this};
    framework::InputPort<types::SonarPtr> ping{this, "ping", "codes of 16 bits, logarithmic over 80 dB"};

private:
    void listen(Network& network) override {
        network.listenTcp(config->address, static_cast<uint16_t>(config->port));
        if (!config->serial.empty()) network.openSerial(outputPath(config->serial));
        emulator_.emplace(
            config->device,
            MicronEmulator::Outlet{[this](const types::SonarSettings& request) { settings.write(request); },
                                   [this](Client to, Bytes bytes) { this->network().send(to, std::move(bytes)); },
                                   [this](const std::string& text) { warn(text); }});
    }
    void opened(Client client) override { emulator_->opened(client); }
    void received(Client client, std::span<const uint8_t> bytes) override { emulator_->received(client, bytes, now()); }
    void closed(Client client) override { emulator_->closed(client); }
    void follow(types::Time clock) override { emulator_->follow(clock); }
    void readPings() override {
        for (types::SonarPtr sample; ping.readNew(sample);) emulator_->setPing(*sample);
    }
    std::optional<types::Time> tick(types::Time now) override { return emulator_->tick(now); }

    std::optional<MicronEmulator> emulator_;
};

}  // namespace insonify::device
