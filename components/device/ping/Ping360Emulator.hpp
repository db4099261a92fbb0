#pragma once
#include <deque>

#include "components/device/ping/Ping360Messages.hpp"
#include "components/device/ping/PingDevice.hpp"
#include "types/ConfigError.hpp"
#include "types/Describe.hpp"

namespace insonify::device {

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
        Ping360Transducer asked;
    };
    /** An automatic scan. */
    struct Scan {
        PingClient client;
        Ping360AutoTransmit asked;
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

    void applyTransducer(PingClient client, const Ping360Transducer& asked);
    void applyAutoTransmit(PingClient client, const Ping360AutoTransmit& asked);
    void reset(bool bootloader, types::Time now);
    bool begin(types::Time now);
    void turnTo(const Ping360Transducer& asked, types::Time now);
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
