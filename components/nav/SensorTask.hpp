#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/nav/Dvl.hpp"
#include "components/nav/Fix.hpp"
#include "components/nav/Imu.hpp"
#include "components/nav/Motion.hpp"
#include "components/nav/Pressure.hpp"

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

/** A pressure gauge, from the poses of the body.
 *
 *  Input: `pose`, body in the world. Outputs, at the time of the pose: `pressure`, absolute; the depth in the same
 *  water as Rock's `depth_samples`. The same seed and poses give the same errors; a replay repeats them if it starts
 *  with the first pose. A pose that is not finite leads to RunTimeError; the next valid pose recovers from it. */
class PressureTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<PressureConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::Pressure> pressure{this, "pressure", "absolute, of air and water"};
    framework::OutputPort<types::Pose> depth_samples{this, "depth_samples", "z of the gauge, as Rock's"};

private:
    bool configureHook() override;
    bool startHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }

    Cadence cadence_;
    std::optional<PressureGauge> gauge_;
    bool was_deep_ = false;  ///< Whether the last pose was beyond `deepest`.
};

/** An inertial measurement unit with an attitude, from the poses of the body.
 *
 *  Input: `pose`, body in the world. Outputs, one pose late and stamped with their pose (see MotionTracker): `imu`,
 *  attitude, angular rate and specific force in the axes of the unit (x forward, y left, z up); the same as Rock's
 *  `calibrated_sensors` and `orientation_samples`. A unit at rest and level measures +g along z.
 *
 *  The same seed and poses give the same errors. A replay repeats them if it starts with the first pose, where the
 *  biases begin to wander. A pose that is not finite leads to RunTimeError; the next valid pose recovers from it. */
class ImuTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<ImuConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::Imu> imu{this, "imu", "attitude, angular rate and specific force"};
    framework::OutputPort<types::ImuSensors> calibrated_sensors{this, "calibrated_sensors",
                                                                "angular rate and specific force, as Rock's"};
    framework::OutputPort<types::Pose> orientation_samples{this, "orientation_samples",
                                                           "attitude and angular rate, as Rock's"};

private:
    bool configureHook() override;
    bool startHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }

    MotionTracker tracker_;
    Cadence cadence_;
    std::optional<Imu> unit_;
};

/** A receiver of satellites, from the poses of the body.
 *
 *  Input: `pose`, body in the world. Outputs, at the time of the pose: `fix`, the antenna's place on the earth by the
 *  datum; the same in the world as `position_samples`, as Rock's drivers have it. Below the water surface both are
 *  unknown, and the fix has no solution. The same seed and poses give the same errors; a replay repeats them if it
 * starts with the first pose. A pose that is not finite leads to RunTimeError; the next valid pose recovers from it. */
class FixTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<FixConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::Fix> fix{this, "fix", "place on the earth, with its deviations"};
    framework::OutputPort<types::Pose> position_samples{this, "position_samples", "position in the world, as Rock's"};

    /** Reports a missing datum. */
    void check(types::Diagnostics& diagnostics) const override { checkDatum(config->datum, diagnostics); }

private:
    bool configureHook() override;
    bool startHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }

    Cadence cadence_;
    std::optional<FixReceiver> receiver_;
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::nav
