#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/device/Network.hpp"
#include "components/framework/Registry.hpp"
#include "components/mavlink/Body.hpp"
#include "components/pose/ListenerTask.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::mavlink {

/** Which messages an output of PoseTask is of. */
template <class Sample>
struct Follows {
    std::unique_ptr<Body> body;
};

/** Reads the poses of vehicles from MAVLink over UDP; for `schedule: realtime`.
 *
 *  Ports: an output for each of `bodies`: body in the world, Rock's axes (x north, y west, z up). Every pose is
 * written, in order. A datagram wakes the task; with a period it takes what has come by then.
 *
 *  What is dropped is counted: a warning tells it at the first and then every ten seconds at most, a notice the sum at
 *  the end. So are messages of other systems, warned of only as long as none has become a pose. With `request` a
 *  heartbeat goes to whoever has sent a frame, and a command for each message that stays away, once a second. Refused
 * in lockstep, whose time does not wait for messages. */
class PoseTask final : public pose::ListenerTask<PoseConfig, &PoseConfig::bodies, Follows> {
public:
    using ListenerTask::ListenerTask;

    std::vector<std::string> notices() const override;
    /** For what came before it ran, and for requests. */
    double wakeAfter() const override { return 0.5; }
    /** For tests with port 0. */
    uint16_t port() const { return network_->portOf(0); }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(const device::NetworkEvent& event);
    void take(const Frame& frame, device::Client client);
    void request(types::Time now);
    void requestFor(const Body& body, device::Client client, types::Time now);
    /** As a ground station. */
    template <class Message>
    void send(const Message& message, device::Client client);

    std::unique_ptr<device::Network> network_;
    types::ThrottledWarning drops_{"message", "dropped"}, others_{"message", "of others passed over"};
    std::map<device::Client, uint8_t> peers_;  ///< Who sends frames, and the number of the next one to it.
    types::Time requested_;
    bool has_written_ = false;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::mavlink
