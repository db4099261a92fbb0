#pragma once
#include <optional>

#include "components/device/ping/Ping360Emulator.hpp"
#include "components/device/ping/PingDeviceTask.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::device {

/** How programs on the network find the device. */
struct Ping360Discovery {
    int port = 30303;
    std::string ip = "127.0.0.1";
    std::string mac = "02-00-00-00-03-60";

    static void describe(auto& self, auto& visit) {
        visit({"port", "1", "UDP port on which \"Discovery\" is answered; 0: a free port", 0, 65535}, self.port);
        visit({"ip", "", "address in the answer, for drivers; viewers ignore 127.0.0.1"}, self.ip);
        visit({"mac", "", "hardware address in the answer"}, self.mac);
    }
    void check(types::Diagnostics& diagnostics) const;
    std::string answer() const;
};

struct Ping360TaskConfig {
    PingEnds ends{12345};
    std::optional<Ping360Discovery> discovery;
    Ping360Config device;

    static void describe(auto& self, auto& visit) {
        PingEnds::describe(self.ends, visit);
        visit({"discovery", "", "answers programs that search for the device; absent: drivers must know its address"},
              self.discovery);
        Ping360Config::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const {
        ends.check(diagnostics);
        device.check(diagnostics);
    }
};

/** Replaces a Blue Robotics Ping360 for drivers and viewers, over UDP, TCP or a serial line. Ping360Emulator has the
 *  device's behaviour.
 *
 *  Connect `settings` to a sonar::ScanningSonarTask, and for the gain to its receiver. The ends are those of
 *  PingDeviceTask, followed by the end of discovery. */
class Ping360Task final : public PingDeviceTask {
public:
    using PingDeviceTask::PingDeviceTask;
    framework::Properties<Ping360TaskConfig> config{this};

private:
    const PingEnds& ends() const override { return config->ends; }
    std::unique_ptr<PingDevice> makeDevice() const override {
        return std::make_unique<Ping360Emulator>(config->device);
    }
    void listen(Network& network) override;
    void received(Client client, std::span<const uint8_t> bytes) override;

    std::optional<End> finders_;
};

}  // namespace insonify::device
