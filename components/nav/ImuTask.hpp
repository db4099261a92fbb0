#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/nav/Imu.hpp"

namespace insonify::nav {

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

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::nav
