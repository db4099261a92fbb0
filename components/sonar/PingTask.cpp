#include "components/sonar/PingTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "components/framework/Activity.hpp"
#include "components/sonar/Plan.hpp"
#include "types/CarriedOn.hpp"

namespace insonify::sonar {
namespace {

constexpr double budget_share = 0.5;  ///< Of the budget, for the qualities to choose from: later pings may take longer.
constexpr double fine_enough = 1e-3;  ///< Error below which time that is left is not used [1].
constexpr size_t most_notices = 100;  ///< Runs may last for days.

}  // namespace

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
    std::vector<std::string> all = plan_ ? plan_->notices : configNotices(sonarConfig());
    if (shortest_ < echoTime() * (1 - 1e-6))
        all.push_back(fmt::format(
            "Warning: pings {:.3g} s apart are ambiguous in range, sound takes {:.3g} s to {:.4g} m and back; each "
            "is rendered by itself",
            shortest_, echoTime(), grid_.range_max));
    return all;
}

bool PingTask::configureHook() {
    renderer_.reset();
    plan_.reset();
    grid_ = makeBinGrid(sonarConfig());
    shortest_ = std::numeric_limits<double>::infinity();
    return true;
}

const char* PingTask::follow(const types::Snapshot& scene) {
    const std::optional<Mark> before = std::exchange(before_, Mark{scene.time, scene.sonar.position});
    const double seconds = before ? (scene.time - before->time).seconds() : 0;
    if (!(seconds > 0)) return nullptr;
    shortest_ = std::min(shortest_, seconds);
    const bool too_fast = glm::distance(scene.sonar.position, before->position) > 0.1 * grid_.speed_of_sound * seconds;
    return too_fast ? "the sonar moves faster than a tenth of the speed of sound" : nullptr;
}

bool PingTask::takeNext() {
    types::SnapshotPtr sample;
    const bool realtime = activity().realtime();
    const bool is_new =
        realtime ? snapshot.readNewest(sample, false) == framework::FlowStatus::NewData : snapshot.readNew(sample);
    if (!is_new) return false;
    begun_ = now();
    aimed_ = *sample;
    if (realtime && aimed_.carry_on > 0) {
        aimed_.sonar = types::carriedOn(aimed_.sonar, begun_, aimed_.carry_on);
        aimed_.time = aimed_.sonar.time;
    }
    return true;
}

void PingTask::updateHook() {
    if (!takeNext()) return;
    const char* fault = aimed_.geometry ? normalisePose(aimed_.sonar) : "the snapshot has no geometry";
    if (!fault && activity().realtime() && (aimed_.time - now()).seconds() > 1)
        fault = "the snapshot's time is ahead of the clock by more than a second";
    if (!fault) fault = follow(aimed_);
    if (!fault) fault = aim(aimed_);
    if (fault) return error(fault);
    if (state() == framework::TaskState::RunTimeError) recover();
    render();
}

void PingTask::makeRenderer() {
    renderer_.reset();
    keeper_.reset();
    geometry_ = aimed_.geometry;
    const SonarConfig config = sonarConfig();
    chosen_ = !config.targetError() && !config.quality.budget_ms;
    renderer_ = std::make_unique<SonarRenderer>(config, geometry_);
    plan_ = renderer_->plan();
    culling_untold_ = true;
    plan_told_ = false;
    aimed_.moved.reserve(geometry_->objects.size());
}

void PingTask::chooseQuality() {
    const SonarConfig config = sonarConfig();
    const std::optional<double> target = config.targetError(), wished_ms = config.quality.budget_ms;
    renderer_.reset();  // trials draw on this thread, too
    const double budget = wished_ms ? budget_share * *wished_ms : std::numeric_limits<double>::infinity();
    std::vector<Quality> ladder = tryQualities(config, aimed_, target.value_or(fine_enough), budget);
    renderer_ = std::make_unique<SonarRenderer>(config, geometry_);
    chosen_ = true;
    if (target && ladder.back().error > *target)
        plan_->notices.push_back(fmt::format(
            "Warning: the finest quality leaves an error of {:.2g}; the target is {:g}", ladder.back().error, *target));
    if (wished_ms && ladder.front().ms > *wished_ms)
        plan_->notices.push_back(fmt::format("Warning: the coarsest quality takes {:.3g} ms; the budget is {:g} ms",
                                             ladder.front().ms, *wished_ms));
    setQuality(ladder.back());
    if (wished_ms) keeper_.emplace(std::move(ladder), *wished_ms);
}

void PingTask::setQuality(const Quality& quality) {
    renderer_->setQuality(quality.rows, quality.columns_per_beam);
    plan_->rows = quality.rows;
    plan_->columns_per_beam = quality.columns_per_beam;
    plan_->predicted_error = quality.error;
    plan_told_ = false;
}

void PingTask::keepBudget(double ms) {
    if (!keeper_ || !keeper_->heard(ms)) return;
    setQuality(keeper_->quality());
    if (plan_->notices.size() >= most_notices) return;
    plan_->notices.push_back(fmt::format("from {:.3f} s on {} rows, {} columns per beam, to keep to {:g} ms",
                                         aimed_.time.seconds(), plan_->rows, plan_->columns_per_beam,
                                         *sonarConfig().quality.budget_ms));
}

void PingTask::render() {
    if (!renderer_ || geometry_ != aimed_.geometry) makeRenderer();
    const auto sample = pool_.take();
    const auto start = std::chrono::steady_clock::now();
    renderer_->render(aimed_, *sample);
    if (std::exchange(culling_untold_, false))
        for (types::Omission& omission : renderer_->culled()) plan_->omitted.push_back(std::move(omission));
    keepBudget(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    if (!chosen_ && renderer_->heard()) {
        chooseQuality();
        renderer_->render(aimed_, *sample);
    }
    label(*sample);
    for (const Stage& stage : renderer_->stages()) recordStage(stage.name, stage.seconds);
    pool_.stock(*sample);
    if (!std::exchange(plan_told_, true)) refreshRecord();
    if (listen()) ping.write(sample);
}

bool PingTask::listen() {
    if (!activity().realtime()) return true;
    const types::Time heard{std::max(aimed_.time, begun_).microseconds +
                            static_cast<int64_t>(std::ceil(echoTime() * 1e6))};
    return activity().sleepUntil(heard);
}

}  // namespace insonify::sonar
