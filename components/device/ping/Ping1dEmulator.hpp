#pragma once
#include "components/device/ping/Ping1dMessages.hpp"
#include "components/device/ping/PingDevice.hpp"
#include "types/Describe.hpp"

namespace insonify::device {

/** Properties of a Ping1D that are not set over the wire. */
struct Ping1dConfig {
    double max_range = 100;
    int profile_samples = 200;
    double nearest = 0;  ///< Nearer returns are blanked: the sonar's `range_min` or its receiver's; not a key [m].

    static void describe(auto& self, auto& visit) {
        visit({"max_range", "m", "end of the scan, at most", 1, 1000}, self.max_range);
        visit({"profile_samples", "1", "of a profile", 10, 1200}, self.profile_samples);
    }
};

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
    void setRange(PingClient client, const Ping1dSetRange& asked);
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
