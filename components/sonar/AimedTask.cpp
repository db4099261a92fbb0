#include "components/sonar/AimedTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "components/framework/Activity.hpp"
#include "components/framework/Properties.hpp"
#include "types/Pose.hpp"

namespace insonify::sonar {
namespace {

/** Makes a pose's quaternion one of unit length. Returns why the pose cannot be used, null where it can. */
const char* normalisePose(types::Pose& pose) {
    const glm::dvec3& p = pose.position;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "the sonar's position is not finite";
    const double length = glm::length(pose.orientation);
    if (!std::isfinite(length)) return "the sonar's orientation is not finite";
    if (length < 1e-6) return "the sonar's orientation is a quaternion of no length";
    pose.orientation /= length;
    return nullptr;
}

}  // namespace

double AimedTask::realtimePeriod() const { return activity().realtime() ? period_.period() : 0; }

void AimedTask::resetAim() {
    grid_ = makeBinGrid(sonarConfig());
    shortest_ = std::numeric_limits<double>::infinity();
    period_ = {};
}

void AimedTask::followSnapshot(const types::Snapshot& scene) {
    const std::optional<Mark> before = std::exchange(before_, Mark{scene.time, scene.sonar.position});
    const double seconds = before ? (scene.time - before->time).seconds() : 0;
    jumped_ = false;
    if (!(seconds > 0)) return;
    shortest_ = std::min(shortest_, seconds);
    period_.note(seconds);
    const double way = glm::distance(scene.sonar.position, before->position);
    const double fastest = 0.1 * grid_.speed_of_sound;
    jumped_ = !(way <= fastest * seconds);
    if (jumps_.isDue(jumped_))
        warn(
            fmt::format("the sonar has moved {:.4g} m in {:.4g} s, faster than a tenth of the speed of sound, {:.4g} "
                        "m/s: it is taken as put there, at rest unless its pose has a velocity",
                        way, seconds, fastest));
}

bool AimedTask::takeGiven() {
    types::SnapshotPtr sample;
    types::Pose given;
    if (!given_pose.readNew(given) || snapshot.readNewest(sample) == framework::FlowStatus::NoData) return false;
    begun_ = now();
    aimed_ = *sample;
    aimed_.sonar = given;
    aimed_.time = given.time;
    used_ = std::move(given);
    return true;
}

std::map<std::string, std::string> AimedTask::changedBy(const types::SonarSettings& asked) const {
    const SonarConfig config = sonarConfig();
    std::map<std::string, std::string> changed;
    const auto compare = [&](const char* name, double wanted, std::optional<double> now) {
        if (std::isfinite(wanted) && wanted != now) changed[name] = fmt::format("{}", wanted);
    };
    const auto compareCount = [&](const char* name, uint32_t wanted, uint32_t now) {
        if (wanted != 0 && wanted != now) changed[name] = fmt::format("{}", wanted);
    };
    compare("range", asked.range, config.range);
    compare("frequency_khz", asked.frequency_khz, config.frequency_khz);
    compare("speed_of_sound", asked.speed_of_sound, config.speed_of_sound);
    compare("field_of_view_deg", asked.field_of_view.deg(), config.field_of_view_deg);
    compare("beam_height_deg", asked.beam_height.deg(), config.beam_height_deg);
    compareCount("bin_count", asked.bin_count, static_cast<uint32_t>(config.bin_count));
    compareCount("beam_count", asked.beam_count, static_cast<uint32_t>(config.beam_count));
    return changed;
}

void AimedTask::applySettings(const types::SonarSettings& asked) {
    const auto changed = changedBy(asked);
    if (!changed.empty()) properties().front()->setAll(changed);
    if (!asked.bearing.isUnknown()) turnHead(asked.bearing);
}

bool AimedTask::takeAsked() {
    types::SonarSettings asked;
    types::SnapshotPtr sample;
    if (snapshot.readNewest(sample) == framework::FlowStatus::NoData || !settings.takeNext(asked)) return false;
    try {
        applySettings(asked);
    } catch (const std::exception& refused) {
        error(std::string("settings: ") + refused.what());
        return false;
    }
    aim(*sample);
    aimed_.time = std::max(aimed_.time, asked.time);
    used_.time = aimed_.time;
    return true;
}

bool AimedTask::takeNext() {
    if (given_pose.connected()) return takeGiven();
    if (settings.connected()) return takeAsked();
    types::SnapshotPtr sample;
    if (!snapshot.takeNext(sample)) return false;
    aim(*sample);
    return true;
}

void AimedTask::aim(const types::Snapshot& scene) {
    begun_ = now();
    aimed_ = scene;
    if (activity().realtime() && aimed_.max_extrapolation > 0) {
        aimed_.sonar = types::extrapolatePose(aimed_.sonar, begun_, aimed_.max_extrapolation);
        aimed_.time = aimed_.sonar.time;
    }
    used_ = aimed_.sonar;
}

const char* AimedTask::refusal() {
    if (!aimed_.geometry) return "the snapshot has no geometry";
    if (const char* why = normalisePose(aimed_.sonar)) return why;
    if (activity().realtime() && (aimed_.time - now()).seconds() > 1)
        return "the snapshot's time is ahead of the clock by more than a second";
    followSnapshot(aimed_);
    return steer(aimed_);
}

}  // namespace insonify::sonar
