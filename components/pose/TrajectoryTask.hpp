#pragma once
#include <atomic>
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/pose/Trajectory.hpp"

namespace insonify::pose {

/** Moves the vehicle along a prescribed trajectory: a source, to be run by a periodic activity.
 *
 *  Each cycle writes the pose at now(); the trajectory's times count from the start of the run. It has finished once
 *  the next pose would lie beyond the last stamp (a single waypoint: after one pose), and holds its end if it goes on
 *  running. With `loop` it goes on from the first stamp, as often as it comes to the last, and has never finished. With
 * `motion` waves move the body about the trajectory, by the time of the run, and at its ends too. A file that is not
 * right refuses configure. */
class TrajectoryTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<TrajectoryConfig> config{this};
    framework::OutputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};

    void check(types::Diagnostics& diagnostics) const override;
    bool finished() const override { return finished_; }
    /** The path of its properties, configured or not. Throws types::ConfigError as Trajectory::fromCsv. */
    Trajectory trajectory() const;
    /** Time of the last stamp; 0 before it is configured [s]. */
    double duration() const { return trajectory_ ? trajectory_->stamps().back().time : 0; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;
    /** Whether no later pose of this period lies on the trajectory. */
    bool isLast(types::Time elapsed);

    std::optional<Trajectory> trajectory_;
    std::optional<SeaMotion> motion_;
    std::atomic<bool> finished_{false};
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::pose
