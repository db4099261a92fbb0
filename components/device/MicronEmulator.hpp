#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/device/AskedPings.hpp"
#include "components/device/Network.hpp"
#include "components/device/SeaNet.hpp"
#include "types/Sonar.hpp"
#include "types/SonarSettings.hpp"

namespace insonify::device {

/** What of a Micron is not told by a driver. */
struct MicronDevice {
    int serial_number = 1;
    double frequency_khz = 700;    ///< Where a command names none.
    double speed_of_sound = 1500;  ///< By which sound's time becomes the sonar's range [m/s].
    double boot_time = 0.5;        ///< Until a head that is switched on or rebooted sends its first mtAlive [s].
    double centring_time = 3;      ///< Until its motor has found the middle after that [s].

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"serial_number", "1", "that it tells drivers", 0, 65535}, self.serial_number);
        visit(Field{"frequency_khz", "kHz", "of a head command that names none", 100, 2000}, self.frequency_khz);
        visit(Field{"speed_of_sound", "m/s", "by which the time of a scan line is the sonar's range", 1000, 2000},
              self.speed_of_sound);
        visit(Field{"boot_time", "s", "until a head that is switched on or rebooted tells that it lives", 0, 60},
              self.boot_time);
        visit(Field{"centring_time", "s",
                    "that the motor takes after that to find the middle; no line is scanned meanwhile", 0, 60},
              self.centring_time);
    }
};

/** A Tritech Micron without sockets and clocks: handshake, head commands, scan lines.
 *
 *  It is one head on one line: whoever is connected hears its mtAlive, once a second while it does not scan, and gets
 *  the scan lines that he asks for. The head begins straight ahead, and moves by a step with each line, all round or to
 *  and fro between its limits; a line is answered once the motor has arrived and sound is back, never before. */
class MicronEmulator {
public:
    struct Outlet {
        std::function<void(const types::SonarSettings&)> ask;  ///< Wants one ping.
        std::function<void(Client, Bytes)> send;
        std::function<void(const std::string&)> warn;
    };

    MicronEmulator(MicronDevice device, Outlet outlet) : device_(device), outlet_(std::move(outlet)) {}

    void opened(Client client);
    void received(Client client, std::span<const uint8_t> bytes, types::Time now);
    void closed(Client client);
    /** The ping that was asked for, in codes on a scale of decibels whose largest is 80 dB above the smallest. One of
     *  before is passed over. */
    void heard(const types::Sonar& ping);
    /** Does what is due; when something is next. */
    std::optional<types::Time> tick(types::Time now);

    int bearing() const { return bearing_; }  ///< Of the head [1/16 gradian].

private:
    enum class State { Off, Booting, Unconfigured, Ready };
    static constexpr size_t max_asked = 16;  ///< For one line: a sonar that takes so long that it is asked again may
                                             ///< answer what it was asked before [1].
    /** A scan line on its way. */
    struct Line {
        types::Time ready;  ///< When the motor has arrived.
        types::Time whole;  ///< When sound is back.
        AskedPings<> asked{max_asked};
        std::optional<Bytes> data;  ///< Once the ping has come.
        std::vector<Client> clients;
    };

    void take(Client client, const SeaNetMessage& message, types::Time now);
    void reboot(types::Time now);
    void reverse();
    types::Time centred() const;  ///< When the motor has found the middle.
    void configure(Client client, const SeaNetMessage& message, types::Time now);
    void requestLine(Client client, types::Time now);
    void askForPing(types::Time now);
    void finishLine();
    bool isWithinSector() const;
    void turnTo(int bearing);
    void turn();  ///< By one step, back at a limit.
    SeaNetAlive alive(types::Time now) const;
    void tellAlive(types::Time now);
    double listening() const;  ///< To the last bin and back [s].
    Bytes dataOf(const types::Sonar& ping) const;

    MicronDevice device_;
    Outlet outlet_;
    std::map<Client, SeaNetReader> clients_;
    State state_ = State::Off;
    types::Time begun_, next_alive_;
    bool tells_alive_ = true;
    SeaNetHeadCommand command_;
    int bearing_ = seanet_ahead;
    bool backwards_ = false;  ///< Counter-clockwise.
    types::Time arrived_;     ///< When the motor has made its last step.
    std::optional<Line> line_;
    bool warned_ = false;
};

}  // namespace insonify::device
