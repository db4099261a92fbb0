#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "components/device/DeviceTask.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "components/framework/Properties.hpp"
#include "components/output/ByteFile.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/Notice.hpp"

namespace insonify::device {

struct OculusTaskConfig {
    std::string address = "127.0.0.1";
    int port = 52100;
    std::string status_address = "127.255.255.255";
    int status_port = 52102;
    std::optional<std::string> record;
    OculusConfig device;

    static void describe(auto& self, auto& visit) {
        visit(listen_address, self.address);
        visit({"port", "1", "TCP port; drivers expect 52100; 0: a free port, named in a notice", 0, 65535}, self.port);
        visit({"status_address", "",
               "destination of the status each second; a network's broadcast address, as "
               "192.168.2.255; 127.255.255.255: this machine"},
              self.status_address);
        visit({"status_port", "1", "UDP port of the status; drivers expect 52102", 1, 65535}, self.status_port);
        visit({"record", "",
               "file (.oculus) of the maker's viewer for the pings that are sent, relative to the output "
               "folder, written anew at each start; absent: none"},
              self.record);
        OculusConfig::describe(self.device, visit);
    }
    void check(types::Diagnostics& diagnostics) const { checkAddress(diagnostics, address); }
};

/** Replaces a Blueprint Subsea Oculus. Drivers find it by its status, connect over TCP, and get pings with the settings
 *  of their fire messages: see OculusEmulator. `ping` takes a receiver's codes of amplitude (output code, law sqrt,
 *  code_bits bits). A client that reads slowly gets fewer pings. */
class OculusTask final : public DeviceTask {
public:
    using DeviceTask::DeviceTask;

    framework::Properties<OculusTaskConfig> config{this};
    framework::InputPort<types::SonarPtr> ping{this, "ping", "codes of a receiver, of amplitude",
                                               framework::Need::Required, types::left_receiver};

    void check(types::Diagnostics& diagnostics) const override;
    types::Notices notices() const override;
    /** The listening port; 0 before it is configured. */
    uint16_t port() const { return getPort(0); }

private:
    void listen(Network& network) override;
    void opened(Client client) override;
    void received(Client client, std::span<const uint8_t> bytes) override;
    void closed(Client client) override;
    void follow(types::Time clock) override { emulator_->follow(clock); }
    void readPings() override;
    std::optional<types::Time> tick(types::Time now) override;
    bool startHook() override;
    void stopHook() override;
    void openRecord();
    /** Adds a message to the recording. A message that the disk cannot take is counted where a run may lose samples. */
    void record(const Bytes& message);
    /** Counts a ping that is not in the recording. `why`: empty: as the one before. */
    void countUnrecorded(const std::string& why);
    /** Ends a recording that cannot be written any more; throws `failure` where a run may not lose samples. */
    void endRecord(const std::exception& failure);
    void sendStatus(const Bytes& status, Network& network) const;
    void sendToAll(const Bytes& message);
    /** Warns when bins are not codes. */
    void checkCodes(const types::Sonar& codes);

    std::optional<OculusEmulator> emulator_;
    std::unique_ptr<output::ByteFile> recorded_;  ///< Null: no recording, or it cannot be written any more.
    mutable std::mutex failure_mutex_;            ///< For the next two, which notices() reads on another thread.
    uint64_t unrecorded_ = 0;                     ///< Pings that are not in the recording [1].
    std::string record_failure_;                  ///< Why the last of them is not.
    std::set<Client> clients_;
    types::RecurringDiagnostic no_codes_;
};

}  // namespace insonify::device
