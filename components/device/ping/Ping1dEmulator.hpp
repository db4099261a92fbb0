#pragma once
#include "components/device/ping/PingDevice.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "components/sonars/Sonars.hpp"
#include "types/text/Describe.hpp"

namespace insonify::device {

// Messages of the Ping1D, an echo sounder. Distances are whole millimetres.

/** A message with one number; `Id` is the message's number on the wire. */
template <uint16_t Id, std::integral T>
struct Ping1dValue {
    static constexpr uint16_t message = Id;
    T value = 0;

    static void describe(auto& self, auto& visit) { visit(self.value); }
};

using Ping1dSetDeviceId = Ping1dValue<1000, uint8_t>;
using Ping1dSetSpeedOfSound = Ping1dValue<1002, uint32_t>;  ///< [mm/s]
using Ping1dSetModeAuto = Ping1dValue<1003, uint8_t>;
using Ping1dSetPingInterval = Ping1dValue<1004, uint16_t>;  ///< [ms]
using Ping1dSetGain = Ping1dValue<1005, uint8_t>;
using Ping1dSetPingEnable = Ping1dValue<1006, uint8_t>;
using Ping1dDeviceId = Ping1dValue<1201, uint8_t>;
using Ping1dVoltage5 = Ping1dValue<1202, uint16_t>;      ///< [mV]
using Ping1dSpeedOfSound = Ping1dValue<1203, uint32_t>;  ///< [mm/s]
using Ping1dModeAuto = Ping1dValue<1205, uint8_t>;
using Ping1dPingInterval = Ping1dValue<1206, uint16_t>;  ///< [ms]
using Ping1dGain = Ping1dValue<1207, uint32_t>;
using Ping1dTransmitDuration = Ping1dValue<1208, uint16_t>;      ///< [us]
using Ping1dProcessorTemperature = Ping1dValue<1213, uint16_t>;  ///< [0.01 degC]
using Ping1dPcbTemperature = Ping1dValue<1214, uint16_t>;        ///< [0.01 degC]
using Ping1dPingEnable = Ping1dValue<1215, uint8_t>;
using Ping1dContinuousStart = Ping1dValue<1400, uint16_t>;  ///< The message that is sent continuously.
using Ping1dContinuousStop = Ping1dValue<1401, uint16_t>;

/** The scanned interval; message 1001 sets it, 1204 reports it. */
template <uint16_t Id>
struct Ping1dScan {
    static constexpr uint16_t message = Id;
    uint32_t start = 0, length = 0;  ///< [mm]

    static void describe(auto& self, auto& visit) { visit(self.start, self.length); }
};
using Ping1dSetRange = Ping1dScan<1001>;
using Ping1dRange = Ping1dScan<1204>;

struct Ping1dFirmwareVersion {
    static constexpr uint16_t message = 1200;
    uint8_t type = 1, model = 1;
    uint16_t major = 0, minor = 0;

    static void describe(auto& self, auto& visit) { visit(self.type, self.model, self.major, self.minor); }
};

struct Ping1dGeneralInfo {
    static constexpr uint16_t message = 1210;
    uint16_t major = 0, minor = 0, voltage_5 = 0, ping_interval = 0;
    uint8_t gain = 0, mode_auto = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.major, self.minor, self.voltage_5, self.ping_interval, self.gain, self.mode_auto);
    }
};

struct Ping1dDistanceSimple {
    static constexpr uint16_t message = 1211;
    uint32_t distance = 0;   ///< [mm]
    uint8_t confidence = 0;  ///< [%]

    static void describe(auto& self, auto& visit) { visit(self.distance, self.confidence); }
};

/** The result of a ping, and its settings. */
struct Ping1dMeasurement {
    uint32_t distance = 0;           ///< [mm]
    uint16_t confidence = 0;         ///< [%]
    uint16_t transmit_duration = 0;  ///< [us]
    uint32_t ping_number = 0;        ///< Since power-on.
    uint32_t start = 0, length = 0;  ///< Start and length of the scan [mm].
    uint32_t gain = 0;

    static void describe(auto& self, auto& visit) {
        visit(self.distance, self.confidence, self.transmit_duration, self.ping_number, self.start, self.length,
              self.gain);
    }
};

struct Ping1dDistance {
    static constexpr uint16_t message = 1212;
    Ping1dMeasurement measurement;

    static void describe(auto& self, auto& visit) { Ping1dMeasurement::describe(self.measurement, visit); }
};

struct Ping1dProfile {
    static constexpr uint16_t message = 1300;
    Ping1dMeasurement measurement;
    Bytes data;  ///< Echoes at even steps through the scan, nearest first.

    static void describe(auto& self, auto& visit) {
        Ping1dMeasurement::describe(self.measurement, visit);
        visit(self.data);
    }
};

// The device.

/** Properties of a Ping1D that are not set over the wire. */
struct Ping1dConfig {
    double max_range = sonars::sonar("ping1d").modes.front().range_max;
    int profile_samples = 200;
    double nearest = 0;  ///< Nearer returns are blanked: the sonar's `range_min` or its receiver's; not a key [m].

    static void describe(auto& self, auto& visit) {
        visit({"max_range", "m", "end of the scan, at most", 1, 1000}, self.max_range);
        visit({"profile_samples", "1", "of a profile", 10, 1200}, self.profile_samples);
    }
};

inline constexpr uint32_t ping1d_max_gain = 6;
/** Returns the receiver's gain at a gain setting of at most ping1d_max_gain [dB]. */
double ping1dGainDb(uint32_t setting);

/** The strongest return of a ping: its first bin near its maximum, and its confidence. */
struct Ping1dReturn {
    size_t bin = 0;
    uint16_t confidence = 0;  ///< [%]; 0: there is none.
};

/** Finds the maximum of the first run of codes that reach half of the max. Confidence is the difference of the max and
 *  the mean code, as a part of the max.
 *  @param first codes before this are blanked */
Ping1dReturn ping1dReturn(std::span<const float> codes, size_t first = 0);

/** A Blue Robotics Ping1D: an echo sounder that sends the distance of its target and the profile of its echoes.
 *
 *  It makes a ping for each request of a measurement, or continuously while a stream is requested, as often as the
 *  interval and the travel time of sound allow. Distances use the speed of sound that was set, as on the device; they
 *  are wrong by the ratio to the water's. In automatic mode the scan extends to twice the distance found, and the gain
 *  keeps the strongest echo between a quarter and all of the scale. */
class Ping1dEmulator final : public PingDevice {
public:
    /** @param max_code the max code of the receiver that the pings come from */
    explicit Ping1dEmulator(const Ping1dConfig& config, double max_code = 65535);

private:
    /** A message that a client waits for. */
    struct Wanted {
        PingClient client;
        uint16_t message;
        friend bool operator==(const Wanted&, const Wanted&) = default;
    };

    void command(PingClient client, const PingFrame& frame, types::Time now) override;
    bool answer(PingClient client, uint16_t requested, types::Time now) override;
    void forget(PingClient client) override;
    void proceed(types::Time now) override;
    std::optional<types::Time> nextWork() const override;

    bool answerSetting(PingClient client, uint16_t requested);
    bool answerBoard(PingClient client, uint16_t requested);
    void setRange(PingClient client, const Ping1dSetRange& request);
    /** Takes a value within bounds, and acknowledges it. */
    template <class Message, class Value>
    void set(PingClient client, const PingFrame& frame, const char* name, uint32_t min, uint32_t max, Value& value);
    void startStream(PingClient client, uint16_t message);
    void stopStream(PingClient client, uint16_t message);
    bool wantsPing(types::Time now) const;
    void listen(types::Time now);
    void finish(const types::Sonar& ping);
    void adapt(const Ping1dReturn& found);
    void report(const Wanted& wanted, bool stream);
    void refuseWaiting();

    Ping1dConfig config_;
    double max_code_;
    uint32_t start_ = 0, length_;          ///< [mm]
    uint32_t speed_of_sound_ = 1'500'000;  ///< As set [mm/s].
    uint8_t mode_auto_ = 1, enabled_ = 1, gain_ = 3;
    uint16_t interval_ = 100;  ///< [ms]
    Ping1dProfile last_;
    std::vector<Wanted> waiting_, streams_;
    types::Time next_;  ///< Time of the next message of the stream.
};

}  // namespace insonify::device
