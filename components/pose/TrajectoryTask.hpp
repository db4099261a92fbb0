#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/pose/Trajectory.hpp"

namespace insonify::pose {

/** Moves the vehicle along a prescribed trajectory. Needs a periodic activity.
 *
 *  Each cycle writes the pose at now(); the trajectory's times count from the start of the run, or as TrajectoryTimes
 *  says. check() and configure report times of another clock: those that begin more than an hour after the start of the
 *  run, end before it, or are beyond 1e9 s. The task is finished
 *  once the next pose would be beyond the last stamp (with a single waypoint: after one pose). If it keeps running, it
 *  holds the last pose. With `loop` it restarts at the first stamp after each last stamp, and is never finished. With
 *  `motion` waves move the body about the trajectory, by the time of the run, also outside the stamps. An invalid file
 *  is a diagnostic of configure. */
class TrajectoryTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<TrajectoryConfig> config{this};
    framework::OutputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};

    void check(types::Diagnostics& diagnostics) const override;
    bool finished() const override { return finished_; }
    /** Returns the time until which the vehicle stays at its first pose, how many quaternions of the file have an odd
     *  length, and how many poses after the last stamp were that of the last stamp. */
    types::Notices notices() const override;
    /** Returns the trajectory of the properties, configured or not. Throws types::ConfigError as
     *  Trajectory::fromFile. */
    Trajectory trajectory() const;
    /** Returns the time of the last of several stamps [s]; infinite for a loop, 0 for a fixed pose and before the task
     * is configured. */
    double duration() const;

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;
    /** Returns a warning that the trajectory has not begun at the start of the run; empty: it has. */
    std::string waitText() const;
    /** Returns whether the next pose of this period would be beyond the trajectory. */
    bool isLast(types::Time elapsed);

    std::optional<Trajectory> trajectory_;
    std::optional<SeaMotion> motion_;
    std::atomic<bool> finished_{false};
    std::atomic<uint64_t> held_{0};  ///< Poses after the last stamp.
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::pose
