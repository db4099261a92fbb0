#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/device/Network.hpp"
#include "components/framework/Event.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/Describe.hpp"
#include "types/SonarSettings.hpp"
#include "types/ThrottledWarning.hpp"
#include "types/Time.hpp"

namespace insonify::device {

/** Where a device listens, as a property of its task. */
inline constexpr types::Field listen_address{"address", "",
                                             "numeric address to listen on; 0.0.0.0: every network of this machine"};

/** What the tasks share that stand in for an instrument: its ends on the network, and the port by which they ask a
 *  sonar for pings, each as the driver wants it.
 *
 *  Each cycle hands over what clients have sent, then the pings, then the time; a cycle runs when one of these has
 *  something new. What talks to a driver keeps the wall clock's time, so the schedule is realtime. */
class DeviceTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::OutputPort<types::SonarSettings> settings{this, "settings", "one ping as the driver asks for it"};

    bool reachesOutside() const override { return true; }
    /** A first cycle, and one for what came before it ran. */
    double wakeAfter() const override { return 0.1; }
    void check(types::Diagnostics& diagnostics) const override;
    /** Where clients find it, and what was not sent. */
    std::vector<std::string> notices() const override;
    /** For tests with port 0. */
    uint16_t portOf(End end) const { return network_->portOf(end); }

protected:
    Network& network() { return *network_; }
    /** Opens the ends. */
    virtual void listen(Network& network) = 0;
    virtual void opened(Client /*client*/) {}
    virtual void received(Client client, std::span<const uint8_t> bytes) = 0;
    virtual void closed(Client /*client*/) {}
    /** Takes what has come at the task's own input ports. */
    virtual void takePings() = 0;
    /** Does what is due; when it wants its next cycle at the latest, none: when something comes. */
    virtual std::optional<types::Time> tick(types::Time now) = 0;

    bool configureHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void cleanupHook() override { network_.reset(); }

private:
    void warnOfDisplaced();

    types::ThrottledWarning displaced_{"connection", "closed"};
    framework::Event happened_{this};  ///< On the network; outlives it.
    std::unique_ptr<Network> network_;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::device
