#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <string>

#include "components/device/RequestedPings.hpp"
#include "components/device/sonar3d/Rip2.hpp"
#include "components/device/wire/Http.hpp"
#include "components/sonars/Sonars.hpp"
#include "types/Time.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/SonarSettings.hpp"

namespace insonify::device {

/** Properties of a Sonar 3D-15 that are not set over its API. */
struct Sonar3dDevice {
    double longest_range = mode(false).range_max;          ///< The API's limit [m].
    double low_frequency_khz = mode(false).frequency_khz;  ///< 90 x 40 degrees, 5 pings a second.
    double high_frequency_khz = mode(true).frequency_khz;  ///< 40 x 40 degrees, 20 pings a second.
    double temperature_celsius = 12;                       ///< In the housing, and for the automatic speed of sound.
    std::string multicast_address = "224.0.0.96";
    int multicast_port = 4747;
    bool compressed = true;

    /** Returns the maker's figures of the mode of low or high frequency. */
    static const sonars::SonarMode& mode(bool high_frequency) {
        return sonars::sonar("sonar_3d_15").modes[high_frequency ? 1 : 0];
    }
    static void describe(auto& self, auto& visit) {
        visit({"longest_range", "m", "max range of the API", 1, 65}, self.longest_range);
        visit({"low_frequency_khz", "kHz", "of the mode of 90 x 40 degrees, 5 pings a second", 10, 10000},
              self.low_frequency_khz);
        visit({"high_frequency_khz", "kHz", "of the mode of 40 x 40 degrees, 20 pings a second", 10, 10000},
              self.high_frequency_khz);
        visit({"temperature_celsius", "degC", "in the housing, and of the water for the automatic speed of sound", -2,
               40},
              self.temperature_celsius);
        visit({"multicast_address", "", "group that images are sent to unless the client sets another"},
              self.multicast_address);
        visit({"multicast_port", "1", "of the group", 1, 65535}, self.multicast_port);
        visit({"compressed", "", "whether images are RIP2, as of release 1.6; else RIP1, as before"}, self.compressed);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** The settings of clients over the API; initially the device's power-on state. */
struct Sonar3dState {
    bool acoustics = false;
    double range_min = 0.3, range_max = 15;  ///< [m]
    double speed_of_sound = 1491;            ///< [m/s]; 0: computed from salinity and temperature.
    bool high_frequency = false;
    bool fresh_water = false;
    std::string udp_mode = "multicast";
    std::string unicast_ip;
    uint16_t unicast_port = 0;
    bool imu = false;
    std::string ntp_address = "auto";
    bool ntp_synced = false;
    types::Time synced_at;  ///< Steady time.
};

/** A Water Linked Sonar 3D-15 without sockets and clocks: answers to its HTTP API, and range images in its protocol.
 *
 *  Once acoustics are enabled it requests pings at the rate of its mode, one at a time. Each range image is sent with
 *  the image of its strengths. The device reads the given clock until a client sets its time; then its clock runs on
 *  evenly, however the given clock is set. There is no IMU:
 *  its switch is kept and nothing is sent. */
class Sonar3dEmulator {
public:
    struct Outlet {
        std::function<void(const types::SonarSettings&)> ask;  ///< Requests one ping.
        std::function<void(const std::string& address, uint16_t port, Bytes packet)> send;
        std::function<void(const std::string&)> warn;
    };

    Sonar3dEmulator(Sonar3dDevice device, Outlet outlet) : device_(std::move(device)), outlet_(std::move(outlet)) {
        state_.range_max = std::min(state_.range_max, device_.longest_range);
    }

    HttpReply answer(const HttpRequest& request, types::Time clock);
    /** Reads the clock, which may be set, before a ping is taken; returns the steady time. A ping that was requested
     *  before it was set back by more than a second is requested again. */
    types::Time follow(types::Time clock);
    /** Takes a requested ping, even a late one: ranges and strengths by direction. */
    void setPing(const types::DepthMap& map);
    /** Sends due requests; returns when the next is due. */
    std::optional<types::Time> tick(types::Time clock);
    const Sonar3dState& state() const { return state_; }

private:
    struct Api;
    void ask(types::Time now);
    types::Time workAt(types::Time now);              ///< As tick, in steady time.
    types::Time deviceTime(types::Time stamp) const;  ///< What the device's clock shows at a stamp of ours.
    double speedOfSound() const;
    double period() const { return 1 / Sonar3dDevice::mode(state_.high_frequency).rate_hz; }  ///< [s]
    double frequencyKhz(const Sonar3dState& state) const {
        return state.high_frequency ? device_.high_frequency_khz : device_.low_frequency_khz;
    }
    RipImage getFrame(const types::DepthMap& map, const Sonar3dState& request) const;
    void sendImages(const types::DepthMap& map, const Sonar3dState& request);
    void send(const Bytes& packet);

    Sonar3dDevice device_;
    Outlet outlet_;
    Sonar3dState state_;
    RequestedPings<Sonar3dState> requests_{8};  ///< With the state at each request.
    types::SteadyTime steady_;
    std::optional<types::Time> last_;
    std::optional<types::Time> shift_;  ///< Of the device's clock from steady time, once a client has set it.
    uint32_t sequence_ = 0;
    bool warned_ = false;
};

}  // namespace insonify::device
