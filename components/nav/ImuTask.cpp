#include "components/nav/ImuTask.hpp"

#include "components/nav/DvlTask.hpp"
#include "components/nav/PressureTask.hpp"

namespace insonify::nav {

bool ImuTask::configureHook() {
    tracker_ = MotionTracker(config->sensor.mount);
    cadence_ = Cadence(config->sensor.period);
    unit_.emplace(*config);
    return true;
}

void ImuTask::updateHook() {
    types::Pose body;
    if (!pose.readNew(body)) return;
    if (!isUsable(body)) return error("pose: is not finite, or its orientation has no length");
    if (state() == framework::TaskState::RunTimeError) recover();
    const std::optional<Motion> motion = tracker_.take(body);
    if (const std::string reported = tracker_.takeWarning(); !reported.empty()) warn(reported);
    if (!motion || !cadence_.isDue(motion->time)) return;
    const types::Imu measured = unit_->measure(*motion);
    imu.write(measured);
    calibrated_sensors.write(sensorsOf(measured));
    orientation_samples.write(orientationOf(measured));
}

void registerTasks(framework::Registry& registry) {
    registry.add<ImuTask>("nav::ImuTask", "an inertial measurement unit with an attitude, from the vehicle's poses");
    registry.add<DvlTask>("nav::DvlTask", "a Doppler velocity log of four beams over the scene's bottom");
    registry.add<PressureTask>("nav::PressureTask", "a pressure gauge, from the vehicle's poses");
}

}  // namespace insonify::nav
