#pragma once
#include <optional>

#include "components/device/Ping360Emulator.hpp"
#include "components/device/PingDeviceTask.hpp"
#include "components/framework/Properties.hpp"

namespace insonify::device {

/** How finders on the network learn of the device. */
struct Ping360Discovery {
    int port = 30303;
    std::string ip = "127.0.0.1";
    std::string mac = "02-00-00-00-03-60";

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"port", "1", "UDP port on which \"Discovery\" is answered; 0: any that is free", 0, 65535},
              self.port);
        visit(Field{"ip", "", "address that is told, as drivers are to call it; viewers pass over 127.0.0.1"}, self.ip);
        visit(Field{"mac", "", "hardware address that is told"}, self.mac);
    }
    void check(types::Diagnostics& diagnostics) const;
    std::string answer() const;
};

struct Ping360TaskConfig {
    PingEnds ends{12345};
    std::optional<Ping360Discovery> discovery;
    Ping360Config device;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        PingEnds::describe(self.ends, visit);
        visit(types::Field{"discovery", "", "finders learn of the device; absent: only drivers that know its address"},
              self.discovery);
        Ping360Config::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const { device.check(diagnostics); }
};

/** Stands in for a Blue Robotics Ping360: its drivers and viewers, over UDP, TCP or a serial line. See Ping360Emulator
 *  for what it does.
 *
 *  `settings` leads to a sonar::ScanningSonarTask, and to its receiver for the gain; the ends are those of
 *  PingDeviceTask, and then that of discovery. */
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
