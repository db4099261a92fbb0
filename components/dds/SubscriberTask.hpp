#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Node.hpp"
#include "components/dds/Subscription.hpp"
#include "components/pose/ListenerTask.hpp"

namespace insonify::dds {

/** The topic of an output of SubscriberTask. */
template <class Sample>
struct Topic {
    std::unique_ptr<Subscription> subscription;
    bool came = false, absence_reported = false;
};

/** Reads poses that ROS 2 nodes send; for `schedule: realtime`.
 *
 *  Ports: an output for each of `topics`: body in the world, Rock's axes (x north, y west, z up), whatever
 *  `world_frame` they come in. A message that arrives wakes the task; with a period, it takes what has come by then.
 *  With `depth: 1` the newest wins, else all are handed on in order as long as the task keeps up.
 *
 *  A message that is none, a pose that is not finite or a stamp that goes back is dropped and counted: a warning tells
 *  it at the first and then every ten seconds at most, and a notice tells the sum at the end. A topic without a pose
 *  for three seconds after the start is reported once, with what the domain has in its place. Refused in lockstep,
 *  whose time does not wait for messages. */
class SubscriberTask final : public pose::ListenerTask<SubscriberConfig, &SubscriberConfig::topics, Topic> {
public:
    using ListenerTask::ListenerTask;
    ~SubscriberTask() override;  // the subscriptions end before their node

    std::vector<std::string> notices() const override;
    double wakeAfter() const override { return 1; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void reportAbsence();

    std::optional<Node> node_;
    types::Time started_;
    types::ThrottledWarning drops_{"message", "dropped"}, odd_{"pose", "made of unit length"};
};

}  // namespace insonify::dds
