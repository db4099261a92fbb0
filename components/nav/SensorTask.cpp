#include "components/nav/SensorTask.hpp"

#include <fmt/format.h>

#include <utility>

namespace insonify::nav {

bool DvlTask::configureHook() {
    log_.emplace(*config);
    return true;
}

bool DvlTask::startHook() {
    if (!snapshot.connected() && !config->bottom_height) {
        error("there is no bottom: connect a scene's snapshot, or set bottom_height");
        return false;
    }
    scene_ = nullptr;
    tracker_ = MotionTracker(config->sensor.mount);
    cadence_ = Cadence(config->sensor.period);
    bottom_ = snapshot.connected() ? Bottom() : Bottom(config->bottom_height);
    return true;
}

void DvlTask::updateHook() {
    snapshot.readNewest(scene_, false);
    types::Pose body;
    if (!pose.readNew(body)) return;
    if (!isUsable(body)) return error("pose: is not finite, or its orientation has no length");
    if (state() == framework::TaskState::RunTimeError) recover();
    const std::optional<Motion> motion = tracker_.take(body);
    if (const std::string reported = tracker_.consumeWarning(); !reported.empty()) warn(reported);
    if (motion && cadence_.isDue(motion->time)) measure(*motion);
}

void DvlTask::measure(const Motion& motion) {
    if (scene_) bottom_.take(std::exchange(scene_, nullptr));
    const auto reported = pool_.take();
    log_->measure(motion, bottom_, *reported);
    pool_.stock(*reported);
    dvl.write(reported);
    velocity_samples.write(getVelocity(*reported));
}

bool PressureTask::configureHook() {
    cadence_ = Cadence(config->sensor.period);
    gauge_.emplace(*config);
    was_deep_ = false;
    return true;
}

void PressureTask::updateHook() {
    types::Pose body, placed;
    if (!pose.readNew(body)) return;
    if (!isUsable(body)) return error("pose: is not finite, or its orientation has no length");
    if (state() == framework::TaskState::RunTimeError) recover();
    if (!cadence_.isDue(body.time)) return;
    types::place(body, config->sensor.mount, placed);
    if (const bool is_deep = config->water_surface - placed.position.z > deepest;
        std::exchange(was_deep_, is_deep) < is_deep)
        warn(fmt::format("pose: is deeper than {:g} m, of which the pressure is that of this depth", deepest));
    const types::Pressure reading = gauge_->measure(placed);
    pressure.write(reading);
    if (depth_samples.connected()) depth_samples.write(depthSample(reading, *config));
}

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
    if (const std::string reported = tracker_.consumeWarning(); !reported.empty()) warn(reported);
    if (!motion || !cadence_.isDue(motion->time)) return;
    const types::Imu measured = unit_->measure(*motion);
    imu.write(measured);
    calibrated_sensors.write(getSensors(measured));
    orientation_samples.write(getOrientation(measured));
}

bool FixTask::configureHook() {
    types::Diagnostics diagnostics;
    check(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError("", name() + ".datum", diagnostics.front().message);
    cadence_ = Cadence(config->sensor.period);
    receiver_.emplace(*config);
    return true;
}

void FixTask::updateHook() {
    types::Pose body, antenna;
    if (!pose.readNew(body)) return;
    if (!isUsable(body)) return error("pose: is not finite, or its orientation has no length");
    if (state() == framework::TaskState::RunTimeError) recover();
    if (!cadence_.isDue(body.time)) return;
    types::place(body, config->sensor.mount, antenna);
    const types::Pose measured = receiver_->measure(antenna);
    fix.write(makeFix(measured, *config->datum));
    position_samples.write(measured);
}

void registerTasks(framework::Registry& registry) {
    registry.add<ImuTask>("nav::ImuTask", "an inertial measurement unit with an attitude, from the vehicle's poses");
    registry.add<DvlTask>("nav::DvlTask", "a Doppler velocity log of four beams over the scene's bottom");
    registry.add<FixTask>("nav::FixTask", "a receiver of satellites, from the vehicle's poses");
    registry.add<PressureTask>("nav::PressureTask", "a pressure gauge, from the vehicle's poses");
}

}  // namespace insonify::nav
