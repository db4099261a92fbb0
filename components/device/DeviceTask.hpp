#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/device/wire/Network.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/Time.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/text/Describe.hpp"
#include "types/text/Notice.hpp"

namespace insonify::device {

/** The property of a device task for its listening address. */
inline constexpr types::Field listen_address{"address", "",
                                             "numeric address to listen on; 0.0.0.0: every network of this machine"};

/** The common part of the tasks that replace an instrument: its ends on the network, and the port that requests pings
 *  from a sonar with the driver's settings.
 *
 *  Each cycle processes the clients' bytes, then the pings, then the time. A cycle runs when one of these has news.
 *  Drivers use the wall clock, so the schedule is realtime. */
class DeviceTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::OutputPort<types::SonarSettings> settings{this, "settings", "one ping with the driver's settings"};

    bool reachesOutside() const override { return true; }
    /** For a first cycle, and one for events before it. */
    double wakeAfter() const override { return 0.1; }
    void check(types::Diagnostics& diagnostics) const override;
    /** Returns the addresses for clients, and the messages not sent. */
    types::Notices notices() const override;
    /** For tests with port 0. */
    uint16_t getPort(End end) const { return network_->getPort(end); }

protected:
    Network& network() { return *network_; }
    /** Opens the ends. */
    virtual void listen(Network& network) = 0;
    virtual void opened(Client /*client*/) {}
    virtual void received(Client client, std::span<const uint8_t> bytes) = 0;
    virtual void closed(Client /*client*/) {}
    /** Reads the clock, which may have been set since the last cycle. */
    virtual void follow(types::Time /*clock*/) {}
    /** Reads the task's own input ports. */
    virtual void readPings() = 0;
    /** Does the due work. Returns the latest time of the next cycle; none: when something arrives. */
    virtual std::optional<types::Time> tick(types::Time now) = 0;

    bool configureHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void cleanupHook() override { network_.reset(); }

private:
    void warnOfDisplaced();

    types::ThrottledWarning displaced_{"connection", "closed"};
    framework::Event happened_{this};  ///< Raised by the network; outlives it.
    std::unique_ptr<Network> network_;
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::device
