#pragma once
#include <memory>
#include <string>

#include "components/device/DeviceTask.hpp"
#include "components/device/ping/PingDevice.hpp"
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

}  // namespace insonify::device
