#pragma once
// Messages of the Ping360, a scanning sonar. Angles of the head are whole gradians, 400 to a turn.
#include "components/device/ping/PingProtocol.hpp"

namespace insonify::device {

/** The settings of echoes. */
struct Ping360Acoustics {
    uint8_t gain = 0;                ///< 0 low, 1 normal, 2 high.
    uint16_t transmit_duration = 0;  ///< [us]
    uint16_t sample_period = 0;      ///< Sampling interval in two-way time [25 ns].
    uint16_t frequency_khz = 0;
    uint16_t samples = 0;

    friend bool operator==(const Ping360Acoustics&, const Ping360Acoustics&) = default;
};

/** The sector of an automatic scan. */
struct Ping360Sector {
    uint16_t start = 0, stop = 0;  ///< [gradian]
    uint8_t steps = 1;             ///< Between two pings [gradian].
    uint8_t delay_ms = 0;          ///< Between two pings, in addition to their duration.

    friend bool operator==(const Ping360Sector&, const Ping360Sector&) = default;
};

struct Ping360SetDeviceId {
    static constexpr uint16_t message = 2000;
    uint8_t device_id = 0, reserved = 0;

    static void describe(auto& self, auto& visit) { visit(self.device_id, self.reserved); }
};

/** The sonar's state, and its echoes. */
struct Ping360DeviceData {
    static constexpr uint16_t message = 2300;
    uint8_t mode = 1;
    uint16_t angle = 0;  ///< [gradian]
    Ping360Acoustics acoustics;
    Bytes data;  ///< Nearest first; empty: no ping was sent.

    static void describe(auto& self, auto& visit) {
        auto& a = self.acoustics;
        visit(self.mode, a.gain, self.angle, a.transmit_duration, a.sample_period, a.frequency_khz, a.samples,
              self.data);
    }
};

/** The same in an automatic scan. */
struct Ping360AutoDeviceData {
    static constexpr uint16_t message = 2301;
    uint8_t mode = 1;
    uint16_t angle = 0;  ///< [gradian]
    Ping360Acoustics acoustics;
    Ping360Sector sector;
    Bytes data;

    static void describe(auto& self, auto& visit) {
        auto& a = self.acoustics;
        auto& s = self.sector;
        visit(self.mode, a.gain, self.angle, a.transmit_duration, a.sample_period, a.frequency_khz, s.start, s.stop,
              s.steps, s.delay_ms, a.samples, self.data);
    }
};

struct Ping360Reset {
    static constexpr uint16_t message = 2600;
    uint8_t bootloader = 0, reserved = 0;

    static void describe(auto& self, auto& visit) { visit(self.bootloader, self.reserved); }
};

/** Turns the head and pings there. */
struct Ping360Transducer {
    static constexpr uint16_t message = 2601;
    uint8_t mode = 1;
    uint16_t angle = 0;  ///< [gradian]
    Ping360Acoustics acoustics;
    uint8_t transmit = 0, reserved = 0;

    static void describe(auto& self, auto& visit) {
        auto& a = self.acoustics;
        visit(self.mode, a.gain, self.angle, a.transmit_duration, a.sample_period, a.frequency_khz, a.samples,
              self.transmit, self.reserved);
    }
};

/** Scans a sector continuously. */
struct Ping360AutoTransmit {
    static constexpr uint16_t message = 2602;
    uint8_t mode = 1;
    Ping360Acoustics acoustics;
    Ping360Sector sector;

    static void describe(auto& self, auto& visit) {
        auto& a = self.acoustics;
        auto& s = self.sector;
        visit(self.mode, a.gain, a.transmit_duration, a.sample_period, a.frequency_khz, a.samples, s.start, s.stop,
              s.steps, s.delay_ms);
    }
};

struct Ping360MotorOff {
    static constexpr uint16_t message = 2903;

    static void describe(auto& /*self*/, auto& visit) { visit(); }
};

}  // namespace insonify::device
