#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/nav/Dvl.hpp"

namespace insonify::nav {

/** A Doppler velocity log over the bottom of a scene, from the poses of the body.
 *
 *  Inputs: `pose`, body in the world; `snapshot`, of a scene's task with any mount. The beams meet the newest snapshot;
 *  before the first snapshot every beam is lost. Without a connected scene the bottom is level at `bottom_height`;
 *  without that property the task does not start. Outputs, one pose late and stamped with their pose (see
 *  MotionTracker): `dvl`, velocity over the bottom in the axes of the instrument (x forward, y left, z up), ranges and
 *  velocities of beams; the velocity as Rock's `velocity_samples`.
 *
 *  The same seed and poses give the same errors. A pose that is not finite leads to RunTimeError; the next valid pose
 *  recovers from it. */
class DvlTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<DvlConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::InputPort<types::SnapshotPtr> snapshot{this, "snapshot", "the scene; the newest sample is used",
                                                      framework::Need::Optional};
    framework::OutputPort<types::DvlPtr> dvl{this, "dvl", "velocity over the bottom, ranges and velocities of beams"};
    framework::OutputPort<types::Pose> velocity_samples{this, "velocity_samples",
                                                        "velocity in the instrument, as Rock's"};

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void measure(const Motion& motion);

    MotionTracker tracker_;
    Cadence cadence_;
    types::SnapshotPtr scene_;  ///< The newest scene that the bottom has not taken; may be null.
    Bottom bottom_;
    std::optional<Dvl> log_;
    framework::SamplePool<types::Dvl> pool_;
};

}  // namespace insonify::nav
