#include "components/nav/PressureTask.hpp"

namespace insonify::nav {

bool PressureTask::configureHook() {
    cadence_ = Cadence(config->sensor.period);
    gauge_.emplace(*config);
    return true;
}

void PressureTask::updateHook() {
    types::Pose body, placed;
    if (!pose.readNew(body)) return;
    if (!isUsable(body)) return error("pose: is not finite, or its orientation has no length");
    if (state() == framework::TaskState::RunTimeError) recover();
    if (!cadence_.isDue(body.time)) return;
    types::place(body, config->sensor.mount, placed);
    const types::Pressure reading = gauge_->measure(placed);
    pressure.write(reading);
    if (depth_samples.connected()) depth_samples.write(depthSample(reading, *config));
}

}  // namespace insonify::nav
