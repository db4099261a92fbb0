#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/framework/Registry.hpp"
#include "components/gazebo/PoseConfig.hpp"
#include "components/gazebo/Subscriptions.hpp"
#include "components/pose/ListenerTask.hpp"
#include "types/SenderClock.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::gazebo {

/** Reads where bodies are in a world of Gazebo's; for `schedule: realtime`.
 *
 *  Ports: an output for each of `bodies`: body in the world, Rock's axes (x north, y west, z up). Every message that is
 *  newer than the one before is a pose, stamped by the simulation's time carried over to ours. A message wakes the
 * task; with a period it takes what has come by then. While the simulation stands still there is no pose; one that is
 * reset begins anew. What comes into the world later, or goes from it, is a warning: the scene is as it was.
 *
 *  What is dropped is counted: a warning at the first and then every ten seconds at most, a notice with the sum at
 *  the end. Refused in lockstep, whose time does not wait for messages. */
class PoseTask final : public pose::ListenerTask<PoseConfig, &PoseConfig::bodies> {
public:
    using ListenerTask::ListenerTask;

    std::vector<std::string> notices() const override;
    /** For what came before it ran. */
    double wakeAfter() const override { return 0.5; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(Arrived& message);
    /** Warns once where nobody has offered a topic for a while. */
    void warnOfSilence();
    void report(const WorldWatch::Change& change);
    void write(Placed& placed, types::Time time);

    std::unique_ptr<Inbox> inbox_;
    std::unique_ptr<Subscriptions> subscriptions_;  ///< Puts into the inbox, so it goes first.
    std::vector<types::SenderClock> clocks_;        ///< By topic.
    types::ThrottledWarning drops_{"message", "dropped"};
    types::Time started_;
    bool is_silence_reported_ = false;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::gazebo
