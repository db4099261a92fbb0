#pragma once
// Messages of the Ping1D, an echo sounder. Distances are whole millimetres.
#include "components/device/ping/PingProtocol.hpp"

namespace insonify::device {

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

}  // namespace insonify::device
