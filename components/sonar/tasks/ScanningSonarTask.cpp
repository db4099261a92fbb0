#include "components/sonar/tasks/ScanningSonarTask.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "components/sonar/surfaces/Motion.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ProfilerTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sonar {

bool ScanningSonarTask::startHook() {
    scan_.emplace(config->head);
    asked_ = {};
    last_.reset();
    before_.reset();
    periods_ = 0;
    return true;
}

bool ScanningSonarTask::propertiesHook() {
    if (scan_ && scan_->config() != config->head) {
        if (isRunning() && periods_ > 0 && isFarTooSlow(mean_period_))
            throw types::ConfigError("", "head.step_deg", stepText(mean_period_));
        scan_.emplace(config->head);
        periods_ = 0;
    }
    return PingTask::propertiesHook();
}

const char* ScanningSonarTask::setLook(types::Snapshot& scene) {
    const bool is_back = last_ && scene.time < *last_;
    if (is_back && *last_ - scene.time <= types::max_lateness) return "the snapshot is older than the one before";
    if (is_back) last_.reset(), before_.reset();
    if (last_ && asked_.isUnknown()) checkStep((scene.time - *last_).seconds());
    const double seconds = last_ ? (scene.time - *last_).seconds() : 0;
    last_ = scene.time;
    const Look look{scene.sonar.orientation, types::radians(findStandingDeg(config->head, bearingDeg()))};
    scene.sonar.orientation *= glm::angleAxis(look.bearing, glm::dvec3(0, 0, 1));
    if (config->sonar.motion_in_ping) turn(scene.sonar, look, seconds);
    before_ = look;
    return nullptr;
}

void ScanningSonarTask::turn(types::Pose& sonar, const Look& look, double seconds) const {
    const bool follows = before_ && seconds > 0;
    glm::dvec3 turn(0);  // in the world
    if (std::isfinite(glm::length(sonar.angular_velocity)))
        turn = look.body * sonar.angular_velocity;
    else if (follows && !jumped())
        turn = turnBetween(before_->body, look.body, seconds);
    const double step = follows ? std::remainder(look.bearing - before_->bearing, 2 * std::numbers::pi) : 0;
    if (config->head.sweeps && follows) turn += look.body * glm::dvec3(0, 0, step / seconds);
    sonar.angular_velocity = glm::conjugate(sonar.orientation) * turn;
}

void ScanningSonarTask::stampBearings(types::Sonar& sample) {
    sample.bearings[0] = types::Angle::fromDeg(bearingDeg());
}

std::string ScanningSonarTask::stepText(double period) const {
    return fmt::format("is {} deg, which takes {:.4g} s at {} deg/s; the ping period is {:.4g} s",
                       config->head.step_deg, stepDuration(config->head), *config->head.speed_deg_per_s, period);
}

bool ScanningSonarTask::isFarTooSlow(double period) const {
    return !activity().realtime() && stepDuration(config->head) > 1.5 * period;
}

void ScanningSonarTask::checkStep(double seconds) {
    constexpr int enough = 8;  // stamps of a network jitter, their mean does not
    if (periods_ == enough) return;
    if (periods_ == 0) mean_period_ = 0;
    ++periods_;
    mean_period_ += (seconds - mean_period_) / periods_;
    if (periods_ == 1 && isFarTooSlow(mean_period_))
        throw types::ConfigError("", name() + ".head.step_deg", stepText(mean_period_));
    if (periods_ == enough && stepDuration(config->head) > 1.01 * mean_period_)
        warn("head.step_deg " + stepText(mean_period_));
}

void registerTasks(framework::Registry& registry) {
    registry.add<SonarTask>("sonar::SonarTask", "forward-looking imaging sonar, a fan of beams per ping");
    registry.add<ScanningSonarTask>("sonar::ScanningSonarTask", "mechanically scanning sonar, one beam per ping");
    registry.add<ProfilerTask>("sonar::ProfilerTask", "profiling multibeam sonar, one sounding per beam");
    registry.add<SideScanTask>("sonar::SideScanTask", "side-scan sonar, a line to port and to starboard per ping");
    registry.add<Sonar3dTask>("sonar::Sonar3dTask", "3-D sonar, a range for each beam in azimuth and elevation");
    registry.add<AltimeterTask>("sonar::AltimeterTask", "altimeter, the range to the first return of one beam");
}

}  // namespace insonify::sonar
