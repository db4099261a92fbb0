#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/device/RequestedPings.hpp"
#include "components/device/micron/SeaNet.hpp"
#include "components/device/wire/Network.hpp"
#include "types/Time.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarSettings.hpp"

namespace insonify::device {

/** Properties of a Micron that drivers do not set. */
struct MicronDevice {
    int serial_number = 1;
    double frequency_khz = 700;    ///< For commands without a frequency.
    double speed_of_sound = 1500;  ///< Converts times to the sonar's range [m/s].
    double boot_time = 0.5;        ///< From power-on or reboot to the first mtAlive [s].
    double centring_time = 3;      ///< From then until the motor has found its centre [s].

    static void describe(auto& self, auto& visit) {
        visit({"serial_number", "1", "reported to drivers", 0, 65535}, self.serial_number);
        visit({"frequency_khz", "kHz", "for head commands without a frequency", 100, 2000}, self.frequency_khz);
        visit({"speed_of_sound", "m/s", "converts the times of scan lines to the sonar's range", 1000, 2000},
              self.speed_of_sound);
        visit({"boot_time", "s", "from power-on or reboot to the head's first mtAlive", 0, 60}, self.boot_time);
        visit({"centring_time", "s", "then, until the motor has found its centre; no line is scanned before", 0, 60},
              self.centring_time);
    }
};

/** A Tritech Micron without sockets and clocks: handshake, head commands, scan lines.
 *
 *  There is one head on one line. Every connected client receives its mtAlive, once a second while the head does not
 *  scan, and the scan lines that the client requests. The head starts straight ahead. With each line it moves by a
 *  step, all round or to and fro between its limits. A line is answered once the motor has arrived and sound is back,
 *  never before. */
class MicronEmulator {
public:
    struct Outlet {
        std::function<void(const types::SonarSettings&)> ask;  ///< Requests one ping.
        std::function<void(Client, Bytes)> send;
        std::function<void(const std::string&)> warn;
    };

    MicronEmulator(MicronDevice device, Outlet outlet) : device_(device), outlet_(std::move(outlet)) {}

    void opened(Client client);
    void received(Client client, std::span<const uint8_t> bytes, types::Time clock);
    void closed(Client client);
    /** Reads the clock, which may be set, before a ping is taken; returns the steady time. A ping that was requested
     *  before it was set back by more than a second is requested again. */
    types::Time follow(types::Time clock);
    /** Takes a requested ping, in codes on a scale of 80 dB from the smallest to the max code. Ignores pings of earlier
     *  requests. */
    void setPing(const types::Sonar& ping);
    /** Does the due work; returns when the next is due. */
    std::optional<types::Time> tick(types::Time clock);

    int bearing() const { return bearing_; }  ///< Bearing of the head [1/16 gradian].

private:
    enum class State { Off, Booting, Unconfigured, Ready };
    static constexpr size_t max_requests = 16;  ///< For one line. A slow sonar, asked again, may answer an earlier
                                                ///< request [1].
    /** A scan line in progress. */
    struct Line {
        types::Time ready;  ///< The motor has arrived.
        types::Time whole;  ///< Sound is back.
        RequestedPings<> request{max_requests};
        std::optional<Bytes> data;  ///< Once the ping has arrived.
        std::vector<Client> clients;
    };

    types::Time workAt(types::Time now);  ///< As tick.
    void take(Client client, const SeaNetMessage& message, types::Time now);
    void reboot(types::Time now);
    void reverse();
    types::Time centred() const;  ///< When the motor has found its centre.
    void configure(Client client, const SeaNetMessage& message, types::Time now);
    void requestLine(Client client, types::Time now);
    void askForPing(types::Time now);
    void finishLine();
    bool isWithinSector() const;
    void turnTo(int bearing);
    void turn();  ///< By one step, reversing at a limit.
    SeaNetAlive alive(types::Time now) const;
    void sendAlive(types::Time now);
    double listening() const;  ///< Two-way travel time to the last bin [s].
    Bytes getData(const types::Sonar& ping) const;

    MicronDevice device_;
    Outlet outlet_;
    types::SteadyTime steady_;
    std::map<Client, SeaNetReader> clients_;
    State state_ = State::Off;
    types::Time begun_, next_alive_;
    bool sends_alive_ = true;
    SeaNetHeadCommand command_;
    int bearing_ = seanet_ahead;
    bool backwards_ = false;  ///< Counter-clockwise.
    types::Time arrived_;     ///< When the motor has finished its last step.
    std::optional<Line> line_;
    bool warned_ = false;
};

}  // namespace insonify::device
