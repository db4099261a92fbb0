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
 *  Ports: an output for each of `topics`: body in the world, in Rock's axes (x north, y west, z up), converted from
 *  `world_frame`. A message that arrives wakes the task; with a period, each cycle takes the messages that have
 *  arrived. With `depth: 1` only the newest is passed on, else all in order as long as the task keeps up.
 *
 *  A position of a receiver of satellites becomes a pose about the `datum`, without which the task is not configured.
 *  Its orientation comes from another topic, or the body is level and looks to the north.
 *
 *  A message that cannot be decoded, a fix without a position, a pose that is not finite or a stamp that decreases is
 * dropped and counted. A warning reports the first drop and then at most one every ten seconds; a notice reports the
 * sum at the end. A topic without a pose for three seconds after the start is reported once, together with similar
 * topics of the domain. Refused in lockstep, whose time does not wait for messages. */
class SubscriberTask final : public pose::ListenerTask<SubscriberConfig, &SubscriberConfig::topics, Topic> {
public:
    using ListenerTask::ListenerTask;
    ~SubscriberTask() override;  // ends the subscriptions before their node

    types::Notices notices() const override;
    double wakeAfter() const override { return 1; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void checkMore(types::Diagnostics& diagnostics) const override;
    void reportAbsence();

    std::optional<Node> node_;
    types::Time started_;
    Counts counts_;
};

}  // namespace insonify::dds
