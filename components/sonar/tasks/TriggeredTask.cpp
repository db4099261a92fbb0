#include "components/sonar/tasks/TriggeredTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "components/framework/Properties.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/geometry/PosedMesh.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::sonar {
namespace {

/** Normalises a pose's quaternion. Returns why the pose cannot be used, null where it can. */
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

double TriggeredTask::realtimePeriod() const { return activity().realtime() ? period_.period() : 0; }

void TriggeredTask::resetTrigger() {
    grid_ = makeBinGrid(sonarConfig());
    shortest_ = std::numeric_limits<double>::infinity();
    period_ = {};
    reported_jump_.reset();
}

void TriggeredTask::followSnapshot(const types::Snapshot& scene) {
    const std::optional<Mark> before = std::exchange(before_, Mark{scene.time, scene.sonar.position});
    const double seconds = before ? (scene.time - before->time).seconds() : 0;
    jumped_ = false;
    if (!(seconds > 0)) return;
    shortest_ = std::min(shortest_, seconds);
    period_.note(seconds);
    const double way = glm::distance(scene.sonar.position, before->position);
    const double fastest = 0.1 * grid_.speed_of_sound;
    jumped_ = !(way <= fastest * seconds);
    if (!jumps_.isDue(jumped_)) return;
    const auto isNear = [way](const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) < 0.2 * way; };
    const auto last = std::exchange(reported_jump_, Jump{before->position, scene.sonar.position});
    if (!last || !isNear(last->from, before->position) || !isNear(last->to, scene.sonar.position))
        warn(
            fmt::format("the sonar has moved {:.4g} m in {:.4g} s, faster than a tenth of the speed of sound, {:.4g} "
                        "m/s: it counts as repositioned, at rest unless its pose has a velocity",
                        way, seconds, fastest));
}

bool TriggeredTask::readInputs() {
    types::SnapshotPtr sample;
    types::Pose given;
    if (snapshot.readNewest(sample) == framework::FlowStatus::NoData || !given_pose.readNew(given)) return false;
    taken_.begun = now();
    taken_.scene = *sample;
    taken_.scene.sonar = given;
    taken_.scene.time = given.time;
    taken_.used = std::move(given);
    return true;
}

TriggeredTask::Changes TriggeredTask::changedBy(const types::SonarSettings& requested) const {
    const SonarConfig config = sonarConfig();
    Changes changes;
    const auto compare = [&](const char* name, double wanted, std::optional<double> now) {
        if (std::isfinite(wanted) && wanted != now) changes[name] = wanted;
    };
    const auto compareCount = [&](const char* name, uint32_t wanted, int now) {
        if (wanted != 0 && wanted != static_cast<uint32_t>(now)) changes[name] = wanted;
    };
    double range = requested.range;
    if (range >= 0 && range <= config.range_min) {  // drivers may ask for less than the nearest that a sonar hears
        SonarConfig nearest = config;
        nearest.range = 1.1 * config.range_min;
        if (requested.bin_count != 0) nearest.bin_count = static_cast<int>(std::min(requested.bin_count, 65536u));
        if (requested.speed_of_sound > 0)
            nearest.speed_of_sound = std::clamp(requested.speed_of_sound, 100.0, 20000.0);
        else if (requested.speed_of_sound == 0 && own_speed_)
            nearest.speed_of_sound = *own_speed_;
        range = makeBinGrid(nearest).range_max;
    }
    compare("range", range, config.range);
    compare("frequency_khz", requested.frequency_khz, config.frequency_khz);
    if (requested.speed_of_sound != 0)
        compare("speed_of_sound", requested.speed_of_sound, config.speed_of_sound);
    else if (own_speed_ && *own_speed_ != config.speed_of_sound)
        changes["speed_of_sound"] = *own_speed_;
    compare("field_of_view_deg", requested.field_of_view.deg(), config.field_of_view_deg);
    compare("beam_height_deg", requested.beam_height.deg(), config.beam_height_deg);
    compareCount("bin_count", requested.bin_count, config.bin_count);
    compareCount("beam_count", requested.beam_count, config.beam_count);
    return changes;
}

void TriggeredTask::applySettings(const types::SonarSettings& asked) {
    const Changes changes = changedBy(asked);
    const auto before = sonarConfig().speed_of_sound;
    if (!changes.empty()) framework::blockWith(changes.begin()->first, properties()).change(changes);
    if (asked.speed_of_sound == 0)
        own_speed_.reset();
    else if (!own_speed_ && changes.contains("speed_of_sound"))
        own_speed_ = before;
    if (!asked.bearing.isUnknown()) turnHead(asked.bearing);
}

bool TriggeredTask::consumeRequest() {
    types::SonarSettings asked;
    types::SnapshotPtr sample;
    if (snapshot.readNewest(sample) == framework::FlowStatus::NoData || !settings.readNext(asked)) return false;
    try {
        applySettings(asked);
    } catch (const std::exception& refused) {
        error(std::string("settings: ") + refused.what());
        return false;
    }
    setScene(*sample);
    // A request from before the clock was set back would be ahead of it.
    const types::Time latest = activity().realtime() ? std::min(asked.time, now()) : asked.time;
    taken_.scene.time = std::max(taken_.scene.time, latest);
    taken_.used.time = taken_.scene.time;
    return true;
}

bool TriggeredTask::readNext() {
    if (given_pose.connected()) return readInputs();
    if (settings.connected()) return consumeRequest();
    types::SnapshotPtr sample;
    if (!snapshot.readNext(sample)) return false;
    setScene(*sample);
    return true;
}

void TriggeredTask::setScene(const types::Snapshot& scene) {
    taken_.begun = now();
    taken_.scene = scene;
    if (activity().realtime() && taken_.scene.max_extrapolation > 0) {
        taken_.scene.sonar = types::extrapolatePose(taken_.scene.sonar, taken_.begun, taken_.scene.max_extrapolation);
        taken_.scene.time = taken_.scene.sonar.time;
    }
    taken_.used = taken_.scene.sonar;
}

const char* TriggeredTask::refusal() {
    if (!taken_.scene.geometry) return "the snapshot has no geometry";
    if (std::ranges::any_of(taken_.scene.moved, [count = taken_.scene.geometry->objects.size()](const auto& moved) {
            return moved.object >= count;
        }))
        return "the snapshot moves an object that its geometry does not have";
    if (taken_.scene.movable && std::ranges::any_of(*taken_.scene.movable, [&](uint32_t object) {
            return object >= taken_.scene.geometry->objects.size();
        }))
        return "the snapshot has a movable object that its geometry does not have";
    if (!types::deformsRightly(taken_.scene))
        return "the snapshot deforms an object that its geometry does not have so";
    if (const char* why = normalisePose(taken_.scene.sonar)) return why;
    if (activity().realtime() && (taken_.scene.time - now()).seconds() > 1)
        return "the snapshot's time is ahead of the clock by more than a second";
    followSnapshot(taken_.scene);
    return setLook(taken_.scene);
}

}  // namespace insonify::sonar
