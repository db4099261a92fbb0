#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Registry.hpp"
#include "components/gazebo/Subscriptions.hpp"
#include "components/pose/ListenerTask.hpp"
#include "types/SenderClock.hpp"
#include "types/text/Notice.hpp"

namespace insonify::gazebo {

/** Reads the poses of bodies in a Gazebo world; for `schedule: realtime`.
 *
 *  Ports: an output for each of `bodies`: body in the world, Rock's axes (x north, y west, z up). Every message that is
 *  newer than the previous message gives a pose, stamped by the time of the simulation converted to our clock. A
 *  message wakes the task; with a period the task takes the messages that have arrived. A paused simulation gives no
 *  poses; after a reset, poses begin anew. Entities that appear in the world later, or disappear, are a warning: the
 *  scene remains as it was.
 *
 *  Dropped messages are counted. A warning reports the first, then at most one warning every ten seconds; a notice at
 *  the end reports the sum. Lockstep, whose time does not wait for messages, is an error. */
class PoseTask final : public pose::ListenerTask<PoseConfig, &PoseConfig::bodies> {
public:
    using ListenerTask::ListenerTask;

    types::Notices notices() const override;
    /** Wakes the task for messages that arrived before it ran [s]. */
    double wakeAfter() const override { return 0.5; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(Arrived& message);
    /** Warns once when nobody has offered a topic for a while. */
    void warnOfSilence();
    void gather(WorldWatch::Change& change);
    /** Warns of the changes of the world, the first at once, then those of a minute together. */
    void reportChanges();
    void write(Placed& placed, types::Time time);
    /** Returns whether a pose of this body at a simulated time is due by its period. */
    bool isDue(size_t body, types::Time stamp);

    std::unique_ptr<Inbox> inbox_;
    std::unique_ptr<Subscriptions> subscriptions_;  ///< Fills the inbox, so it must be destroyed first.
    std::vector<types::SenderClock> clocks_;        ///< By topic.
    std::vector<std::optional<types::Time>> next_;  ///< Simulated time from which a body with a period has a pose.
    types::ThrottledWarning drops_{"message", "dropped"};
    types::Time started_;
    bool is_silence_reported_ = false;
    WorldWatch::Change changed_;           ///< Changes that are not reported yet.
    std::optional<types::Time> reported_;  ///< When changes were last reported.
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::gazebo
