#pragma once
#include <memory>
#include <optional>
#include <string>

#include "components/device/DeviceTask.hpp"
#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/device/ping/PingDevice.hpp"
#include "components/framework/Graph.hpp"
#include "components/framework/Properties.hpp"
#include "types/text/Describe.hpp"

namespace insonify::device {

/** The addresses of a device for drivers of the ping protocol. */
struct PingEnds {
    std::string address = "127.0.0.1";
    int port;
    std::string serial;

    explicit PingEnds(int at) : port(at) {}

    static void describe(auto& self, auto& visit) {
        visit(listen_address, self.address);
        visit({"port", "1", "of UDP, and of TCP; 0: free ports, named in a notice", 0, 65535}, self.port);
        visit({"serial", "",
               "a serial line as well: the file that drivers open, made when the task is configured, relative to "
               "the run's output folder; empty: none"},
              self.serial);
    }
    void check(types::Diagnostics& diagnostics) const { checkAddress(diagnostics, address); }
};

/** Moves bytes between drivers and a device of the ping protocol, and pings from the sonar to the device.
 *
 *  Ends: UDP, TCP, and a serial line if one is named, in this order. */
class PingDeviceTask : public DeviceTask {
public:
    using DeviceTask::DeviceTask;

    static constexpr End udp = 0, tcp = 1;
    framework::InputPort<types::SonarPtr> ping{this, "ping",
                                               "one beam in codes of 16 bits, of the sonar connected to `settings`",
                                               framework::Need::Required, types::left_receiver};

protected:
    virtual const PingEnds& ends() const = 0;
    virtual std::unique_ptr<PingDevice> makeDevice() const = 0;
    void listen(Network& network) override;
    void received(Client client, std::span<const uint8_t> bytes) override;
    void closed(Client client) override;
    void readPings() override;
    std::optional<types::Time> tick(types::Time now) override;

private:
    PingClient getNumber(Client client) const { return client.number << 8 | client.end; }
    Client getClient(PingClient number) const { return {number & 0xff, number >> 8}; }
    void send(Client client, PingOutgoing out);
    void sendWhatIsWanted();

    std::unique_ptr<PingDevice> device_;
};

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

struct Ping1dTaskConfig {
    PingEnds ends{9090};
    Ping1dConfig device;

    static void describe(auto& self, auto& visit) {
        PingEnds::describe(self.ends, visit);
        Ping1dConfig::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const { ends.check(diagnostics); }
};

/** Replaces a Blue Robotics Ping1D for drivers, viewers and autopilots, over UDP, TCP or a serial line. Ping1dEmulator
 *  has the device's behaviour. Connect `settings` to a sonar::AltimeterTask, and for the gain to its receiver. */
class Ping1dTask final : public PingDeviceTask {
public:
    using PingDeviceTask::PingDeviceTask;
    framework::Properties<Ping1dTaskConfig> config{this};

private:
    const PingEnds& ends() const override { return config->ends; }
    std::unique_ptr<PingDevice> makeDevice() const override {
        Ping1dConfig device = config->device;
        device.nearest = framework::upstreamReturnRules(ping, types::left_receiver).range_min;
        return std::make_unique<Ping1dEmulator>(device);
    }
};

}  // namespace insonify::device
