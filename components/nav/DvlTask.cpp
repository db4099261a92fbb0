#include "components/nav/DvlTask.hpp"

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
    if (const std::string reported = tracker_.takeWarning(); !reported.empty()) warn(reported);
    if (motion && cadence_.isDue(motion->time)) measure(*motion);
}

void DvlTask::measure(const Motion& motion) {
    if (scene_) bottom_.take(std::exchange(scene_, nullptr));
    const auto reported = pool_.take();
    log_->measure(motion, bottom_, *reported);
    pool_.stock(*reported);
    dvl.write(reported);
    velocity_samples.write(velocityOf(*reported));
}

}  // namespace insonify::nav
