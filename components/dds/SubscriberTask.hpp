#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Node.hpp"
#include "components/dds/Subscription.hpp"
#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Event.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::dds {

/** Reads poses that ROS 2 nodes send; for `schedule: realtime`.
 *
 *  Ports: an output for each of `topics`: body in the world, Rock's axes (x north, y west, z up), whatever
 *  `world_frame` they come in. A message that arrives wakes the task; with a period, it takes what has come by then.
 *  With `depth: 1` the newest wins, else all are handed on in order as long as the task keeps up.
 *
 *  A message that is none, a pose that is not finite or a stamp that goes back is dropped and counted: a warning tells
 *  it at the first and then every ten seconds at most, and a notice tells the sum at the end. Refused in lockstep,
 *  whose time does not wait for messages. */
class SubscriberTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<SubscriberConfig> config{this};

    framework::OutputPortBase* makeOutput(const std::string& port) override;
    void check(types::Diagnostics& diagnostics) const override;
    std::vector<std::string> notices() const override;
    bool reachesOutside() const override { return true; }

private:
    /** The topic of an output. */
    template <class Sample>
    struct Topic {
        std::unique_ptr<Subscription> subscription;
    };

    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    framework::Event arrived_{this};  ///< A message; outlives the subscriptions.
    std::optional<Node> node_;
    framework::DynamicOutputs<std::tuple<types::Pose>, Topic> outputs_{this};
    types::ThrottledWarning drops_{"message", "dropped"};
};

}  // namespace insonify::dds
