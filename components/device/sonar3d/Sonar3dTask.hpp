#pragma once
#include <map>
#include <optional>
#include <string>

#include "components/device/DeviceTask.hpp"
#include "components/device/sonar3d/Sonar3dEmulator.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::device {

struct Sonar3dDeviceConfig {
    std::string address = "127.0.0.1";
    int port = 80;
    Sonar3dDevice device;

    static void describe(auto& self, auto& visit) {
        visit(listen_address, self.address);
        visit({"port", "1", "TCP port of the HTTP API; 0: a free port, named in a notice", 0, 65535}, self.port);
        Sonar3dDevice::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const {
        checkAddress(diagnostics, address);
        device.check(diagnostics);
    }
};

/** Replaces a Water Linked Sonar 3D-15: its HTTP API, and range images by UDP. Sonar3dEmulator has the device's
 *  behaviour. The sonar is a sonar::Sonar3dTask. */
class Sonar3dTask final : public DeviceTask {
public:
    using DeviceTask::DeviceTask;

    framework::Properties<Sonar3dDeviceConfig> config{this};
    framework::InputPort<types::DepthMapPtr> range_image{this, "range_image",
                                                         "range and strength of each beam's return"};

private:
    void listen(Network& network) override {
        network.listenTcp(config->address, static_cast<uint16_t>(config->port));
        clients_.clear();
        emulator_.emplace(config->device, Sonar3dEmulator::Outlet{
                                              [this](const types::SonarSettings& request) { settings.write(request); },
                                              [this](const std::string& address, uint16_t port, Bytes packet) {
                                                  this->network().sendTo(address, port, std::move(packet));
                                              },
                                              [this](const std::string& text) { warn(text); }});
    }
    void opened(Client client) override { clients_[client]; }
    void received(Client client, std::span<const uint8_t> bytes) override {
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
    void closed(Client client) override { clients_.erase(client); }
    void follow(types::Time clock) override { emulator_->follow(clock); }
    void readPings() override {
        for (types::DepthMapPtr map; range_image.readNew(map);) emulator_->setPing(*map);
    }
    std::optional<types::Time> tick(types::Time now) override { return emulator_->tick(now); }

    std::optional<Sonar3dEmulator> emulator_;
    std::map<Client, HttpReader> clients_;
};

}  // namespace insonify::device
