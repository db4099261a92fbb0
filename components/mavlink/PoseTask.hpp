#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/device/wire/Network.hpp"
#include "components/framework/Registry.hpp"
#include "components/mavlink/Body.hpp"
#include "components/pose/ListenerTask.hpp"
#include "types/text/Notice.hpp"

namespace insonify::mavlink {

/** The body of an output of PoseTask. */
template <class Sample>
struct Follows {
    std::unique_ptr<Body> body;
};

/** Reads the poses of vehicles from MAVLink over UDP; for `schedule: realtime`.
 *
 *  Ports: an output for each of `bodies`: body in the world, Rock's axes (x north, y west, z up). Every pose is
 *  written, in order. A datagram wakes the task; with a period the task takes the datagrams that have arrived.
 *
 *  Dropped messages are counted. A warning reports the first, then at most one warning every ten seconds; a notice at
 *  the end reports the sum. Messages of other systems are counted likewise, with warnings only until the first pose.
 *  With `request` each sender of a frame gets a heartbeat, and a command for each missing message, once a second.
 *  Lockstep, whose time does not wait for messages, is an error. */
class PoseTask final : public pose::ListenerTask<PoseConfig, &PoseConfig::bodies, Follows> {
public:
    using ListenerTask::ListenerTask;

    types::Notices notices() const override;
    /** Wakes the task for datagrams that arrived before it ran, and for requests [s]. */
    double wakeAfter() const override { return 0.5; }
    /** Returns the UDP port, for tests with port 0. */
    uint16_t port() const { return network_->getPort(0); }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(const device::NetworkEvent& event);
    void take(const Frame& frame, device::Client client);
    void request(types::Time now);
    /** Warns of a vehicle that sends heartbeats, and no pose comes from any system. */
    void noteSilence(uint8_t system, uint8_t component);
    void requestFor(const Body& body, device::Client client, types::Time now);
    /** Sends a message as a ground station. */
    void send(const auto& message, device::Client client);

    std::unique_ptr<device::Network> network_;
    types::ThrottledWarning drops_{"message", "dropped"}, others_{"message", "of others ignored"};
    std::map<device::Client, uint8_t>
        peers_;  ///< Senders of frames, and the sequence number of the next frame to them.
    types::Time requested_;
    std::map<uint8_t, types::Time> heard_;  ///< The first heartbeat of each system.
    bool has_written_ = false, silence_is_reported_ = false;
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::mavlink
