#pragma once
#include "components/device/Ping1dMessages.hpp"
#include "components/device/PingDevice.hpp"
#include "types/Describe.hpp"

namespace insonify::device {

/** What of a Ping1D is not set over the wire. */
struct Ping1dConfig {
    double max_range = 100;
    int profile_samples = 200;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"max_range", "m", "end of the scan, at most", 1, 1000}, self.max_range);
        visit(Field{"profile_samples", "1", "of a profile", 10, 1200}, self.profile_samples);
    }
};

/** The strongest return of a ping: in which bin it begins to be as strong as it gets, and how far it stands out. */
struct Ping1dReturn {
    size_t bin = 0;
    uint16_t confidence = 0;  ///< [%]; 0: there is none.
};

/** The first run of codes that reach half of the largest, at its maximum. Confidence is what the mean code lacks of the
 *  largest. */
Ping1dReturn ping1dReturn(std::span<const float> codes);

/** A Blue Robotics Ping1D: an echo sounder that tells the distance to what it finds, and the profile of its echoes.
 *
 *  A ping is made for each request of a measurement, and on and on while one is to be sent continuously, as often as
 * the interval and the sound allow. Distances come by the speed of sound that was set, as on the device: where the
 * water's is another, they are wrong in that ratio. In automatic mode the scan reaches twice as far as what was found,
 * and the gain keeps the strongest echo between a quarter and all of the scale. */
class Ping1dEmulator final : public PingDevice {
public:
    /** @param most the largest code of the receiver that the pings come from */
    explicit Ping1dEmulator(const Ping1dConfig& config, double most = 65535);

    std::optional<types::Time> wakeAt() const override;

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
    void tell(const Wanted& wanted, bool stream);
    void refuseWaiting();

    Ping1dConfig config_;
    double most_;
    uint32_t start_ = 0, length_;          ///< [mm]
    uint32_t speed_of_sound_ = 1'500'000;  ///< That was set [mm/s].
    uint8_t mode_auto_ = 1, enabled_ = 1, gain_ = 3;
    uint16_t interval_ = 100;  ///< [ms]
    Ping1dProfile last_;
    std::vector<Wanted> waiting_, streams_;
    types::Time next_;  ///< Of a stream's pings.
};

}  // namespace insonify::device
