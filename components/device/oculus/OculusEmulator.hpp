#pragma once
#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "components/device/OculusPing.hpp"
#include "components/device/RequestedPings.hpp"
#include "components/device/oculus/OculusMessages.hpp"
#include "components/sonars/Sonars.hpp"
#include "types/Time.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/text/Describe.hpp"

namespace insonify::device {

/** The models with figures in components/sonars/sonars.yml. */
enum class OculusModel { M370s, M750d, M1200d, M3000d };

const sonars::SonarFigures& figures(OculusModel model);
/** Returns the mode of a fire message: 2 is the high frequency, if the model has one; all other numbers are the low
 *  frequency. */
const sonars::SonarMode& oculusMode(const sonars::SonarFigures& figures, uint8_t number);
/** Returns the model of a part number; none: unknown. */
std::optional<OculusModel> oculusModel(uint16_t part);

/** Properties of an Oculus that drivers do not set. */
struct OculusConfig {
    OculusModel model = OculusModel::M750d;
    int serial_number = 7700;
    int bin_count = 1000;
    int code_bits = 16;
    double gain_min_db = -20, gain_max_db = 20;
    double temperature_celsius = 10;
    double pressure_bar = 1.5;
    std::string device_address;

    static void describe(auto& self, auto& visit) {
        visit({"model", "", "sets frequencies, ranges and angles"}, self.model);
        visit({"serial_number", "1", "of the device, in its status and pings", 1, 65535}, self.serial_number);
        visit({"bin_count", "1", "of a beam; fewer where bins would be finer than the model's", 1, 65535},
              self.bin_count);
        visit({"code_bits", "1", "of the receiver's codes of amplitude: its output code, law sqrt", 8, 16},
              self.code_bits);
        visit({"gain_min_db", "dB", "of the receiver at a gain of 0 %", -200, 200}, self.gain_min_db);
        visit({"gain_max_db", "dB", "of the receiver at a gain of 100 %", -200, 200}, self.gain_max_db);
        visit({"temperature_celsius", "degC", "of the water, as the device reports it", -5, 60},
              self.temperature_celsius);
        visit({"pressure_bar", "bar", "of the water, as the device reports it", 0, 1200}, self.pressure_bar);
        visit({"device_address", "", "IPv4 address in its status, to which drivers connect; empty: `address`"},
              self.device_address);
    }
};

/** A Blueprint Subsea Oculus as drivers know it. Inputs are bytes of clients, pings and the time; outputs are bytes and
 *  requests to the sonar. All clients share one state: the last fire message applies. Without a client, and before the
 *  first fire message, it is in standby. */
class OculusEmulator {
public:
    using ClientId = uint64_t;

    /** The due work. */
    struct Due {
        std::optional<types::SonarSettings> ask;  ///< A request for a ping.
        Bytes dummy;                              ///< To all clients, in standby.
        Bytes status;                             ///< A datagram to all listeners.
        types::Time next;                         ///< When something is due again.
    };

    /** @param started when the device was switched on */
    OculusEmulator(const OculusConfig& config, types::Time started);

    void opened(ClientId client) { clients_[client] = OculusFramer(max_message); }
    void received(ClientId client, std::span<const uint8_t> bytes);
    void closed(ClientId client);

    /** Returns the due work. One ping is in progress at a time. A ping that does not arrive within two seconds and the
     *  travel time of its sound is requested again, the next after four seconds, and so on. A late ping is still sent
     *  when it arrives. The clock may be set; a ping that was requested before it was set back by more than a
     *  second is requested again at once. */
    Due tick(types::Time clock);
    /** Reads the clock before a ping is taken, which may be stamped after the clock was set; returns the steady time.
     */
    types::Time follow(types::Time clock);
    /** Returns the message of a ping, for all clients; empty if no request waits for it. The ping's bins are a
     *  receiver's codes. */
    Bytes ping(const types::Sonar& codes);

    /** The settings of the next ping, as interpreted. */
    const OculusFire& fire() const { return fire_; }
    bool inStandby() const { return clients_.empty() || fire_.isStandby(); }
    uint64_t lost() const { return lost_; }        ///< Pings that did not arrive in time.
    uint64_t refused() const { return refused_; }  ///< Client messages that were not valid settings.

private:
    static constexpr size_t max_message = 4096;

    struct Request {
        types::Time time;  ///< Steady time.
        types::SonarSettings settings;
        OculusFire fire;
    };

    void take(std::span<const uint8_t> message);
    /** Returns the settings clamped to the device's limits; none: they are not numbers. */
    std::optional<OculusFire> possible(OculusFire fire) const;
    double computeRange(const OculusFire& fire) const;
    types::SonarSettings getSettings(const OculusFire& fire, types::Time now) const;
    Due workAt(types::Time now, types::Time clock);
    bool isDue(types::Time now);
    OculusResult makeResult(const Request& request, const types::Sonar& codes);
    Bytes statusBytes() const;
    const sonars::SonarMode& mode(const OculusFire& fire) const { return oculusMode(figures_, fire.mode); }

    OculusConfig config_;
    const sonars::SonarFigures& figures_;
    OculusEncoder encoder_;
    types::SteadyTime steady_;
    bool was_set_back_ = false;  ///< By more than a second since the last tick.
    types::Time started_;
    std::map<ClientId, OculusFramer> clients_;
    OculusFire fire_;
    RequestedPings<Request> requests_{4};  ///< With more than one, all but the newest have not arrived in time.
    types::Time last_ping_, last_dummy_, last_status_;
    bool speed_was_set_ = false;  ///< By a driver; 0 then requests the sonar's own speed of sound.
    uint32_t number_ = 0;
    std::atomic<uint64_t> lost_{0}, refused_{0};  ///< Other threads than the task's may read them.
};

}  // namespace insonify::device

template <>
struct insonify::types::EnumNames<insonify::device::OculusModel> {
    static constexpr std::string_view names[] = {"m370s", "m750d", "m1200d", "m3000d"};
};
