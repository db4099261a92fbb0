#pragma once
#include <deque>

#include "components/device/ping/PingDevice.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Describe.hpp"

namespace insonify::device {

// Messages of the Ping360, a scanning sonar. Angles of the head are whole gradians, 400 to a turn.

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

// The device.

/** Properties of a Ping360 that are not set over the wire. The defaults meet the maker's figures: a full turn in 9 s at
 *  2 m and in 35 s at 50 m. */
struct Ping360Config {
    double seconds_per_gradian = 0.006;
    double overhead = 0.0138;
    double ahead = 200;
    std::vector<double> gain_db = {0, 10, 20};

    static void describe(auto& self, auto& visit) {
        visit({"seconds_per_gradian", "s", "time of the head per gradian; a turn has 400", 0, 1},
              self.seconds_per_gradian);
        visit({"overhead", "s", "between the last echo and the answer", 0, 10}, self.overhead);
        visit({"ahead", "gradian", "angle of the head that is ahead; the maker's viewer shows 200 there", 0, 399},
              self.ahead);
        visit({"gain_db", "dB", "of the receiver at gain settings 0, 1 and 2"}, self.gain_db);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A Blue Robotics Ping360: a scanning sonar that pings on request, or scans a sector continuously.
 *
 *  Commands are executed one after the other. A command turns the head the shorter way, pings, and is answered after
 *  the times of head, sound and device. Values out of bounds are refused at once. An automatic scan runs from start to
 *  stop clockwise, seen from above. It then reverses if the sector is at most half a turn, else it starts again. */
class Ping360Emulator final : public PingDevice {
public:
    /** @param max_code the max code of the receiver that the pings come from */
    explicit Ping360Emulator(const Ping360Config& config, double max_code = 65535);

    uint16_t angle() const { return state_.angle; }  ///< Present or next angle of the head [gradian].
    bool scans() const { return scan_.has_value(); }

private:
    struct Command {
        std::optional<PingClient> client;  ///< None: the client is gone.
        Ping360Transducer request;
    };
    /** An automatic scan. */
    struct Scan {
        PingClient client;
        Ping360AutoTransmit request;
        uint32_t number;                ///< Since the beginning.
        int offset = 0, direction = 1;  ///< From the start, clockwise [gradian].
        int width() const;
        int angle() const;
        void advance();
    };
    enum class Phase { Idle, Turning, Listening };

    void command(PingClient client, const PingFrame& frame, types::Time now) override;
    bool answer(PingClient client, uint16_t requested, types::Time now) override;
    void forget(PingClient client) override;
    void proceed(types::Time now) override;
    std::optional<types::Time> nextWork() const override;

    void applyTransducer(PingClient client, const Ping360Transducer& request);
    void applyAutoTransmit(PingClient client, const Ping360AutoTransmit& request);
    void reset(bool bootloader, types::Time now);
    bool begin(types::Time now);
    void turnTo(const Ping360Transducer& request, types::Time now);
    void listen(types::Time now);
    bool step(types::Time now);
    void finish(types::Time now, Bytes data);
    void fail(types::Time now);
    double listens() const;  ///< Listening time of one ping [s].

    Ping360Config config_;
    double max_code_;
    Ping360DeviceData state_;
    Phase phase_ = Phase::Idle;
    types::Time ready_;             ///< When the head has arrived, or the next ping of a scan may begin.
    std::deque<Command> commands_;  ///< The first is in progress unless a scan's ping is.
    std::optional<Scan> scan_;
    uint32_t scans_ = 0;         ///< Number of scans so far.
    bool scanning_ = false;      ///< A ping of a scan is in progress.
    uint32_t scan_at_hand_ = 0;  ///< Number of the current scan.
};

/** Returns the answer to "Discovery" on UDP 30303. @param mac 6 bytes; ip 4 */
std::string ping360Discovery(std::span<const uint8_t, 6> mac, std::span<const uint8_t, 4> ip);

/** Returns the bearing of a head angle, positive to port. @param ahead the angle that is ahead [gradian] */
types::Angle ping360Bearing(double angle, double ahead);

}  // namespace insonify::device
