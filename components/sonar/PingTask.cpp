#include "components/sonar/PingTask.hpp"

#include <cmath>

#include "components/sonar/Plan.hpp"

namespace insonify::sonar {

const char* normalisePose(types::Pose& pose) {
    const glm::dvec3& p = pose.position;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "the sonar's position is not finite";
    const double length = glm::length(pose.orientation);
    if (!std::isfinite(length)) return "the sonar's orientation is not finite";
    if (length < 1e-6) return "the sonar's orientation is a quaternion of no length";
    pose.orientation /= length;
    return nullptr;
}

PingTask::~PingTask() {
    stop();
    cleanup();
}

std::vector<std::string> PingTask::notices() const {
    return plan_ ? plan_->notices : configNotices(sonarConfig());
}

bool PingTask::configureHook() {
    renderer_.reset();
    plan_.reset();
    return true;
}

void PingTask::updateHook() {
    types::SnapshotPtr sample;
    if (!snapshot.readNew(sample)) return;
    aimed_ = *sample;
    const char* fault = aimed_.geometry ? normalisePose(aimed_.sonar) : "the snapshot has no geometry";
    if (!fault) fault = aim(aimed_);
    if (fault) return error(fault);
    if (state() == framework::TaskState::RunTimeError) recover();
    render();
}

void PingTask::render() {
    if (!renderer_ || geometry_ != aimed_.geometry) {
        renderer_.reset();
        geometry_ = aimed_.geometry;
        renderer_ = std::make_unique<SonarRenderer>(sonarConfig(), geometry_);
        plan_ = renderer_->plan();
        aimed_.moved.reserve(geometry_->objects.size());
    }
    const auto sample = pool_.take();
    renderer_->render(aimed_, *sample);
    label(*sample);
    for (const SonarRenderer::Stage& stage : renderer_->stages()) recordStage(stage.name, stage.seconds);
    pool_.stock(*sample);
    ping.write(sample);
}

}  // namespace insonify::sonar
