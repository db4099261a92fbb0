#include "components/sonar/PingTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <utility>

#include "components/framework/Activity.hpp"
#include "components/framework/Properties.hpp"
#include "components/sonar/PlanReport.hpp"
#include "components/sonar/effects/Refraction.hpp"
#include "types/ConfigError.hpp"
#include "types/Pose.hpp"

namespace insonify::sonar {
namespace {

/** A quality to begin with, until something is heard, where none is given. */
SonarConfig begun(SonarConfig config) {
    if (!config.choosesQuality()) return config;
    const Quality coarsest;
    config.quality = {};
    config.quality.rows = coarsest.rows;
    config.quality.columns_per_beam = coarsest.columns_per_beam;
    return config;
}

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

SonarConfig PingTask::locatedConfig() const {
    SonarConfig config = sonarConfig();
    if (config.water && config.water->profile) config.water->profile = inputPath(*config.water->profile).string();
    if (!config.beam_pattern) return config;
    for (ArrayConfig* array : {&config.beam_pattern->transmit, &config.beam_pattern->receive})
        for (std::optional<acoustics::BeamLaw>* law : {&array->azimuth, &array->elevation})
            if (*law && !(*law)->file.empty()) (*law)->file = inputPath((*law)->file);
    return config;
}

bool PingTask::configureHook() {
    if (const std::string why = whyTooLarge(locatedConfig()); !why.empty())
        throw types::ConfigError("", name() + ".beam_pattern", why);
    if (const std::string why = whyStraight(locatedConfig()); !why.empty())
        throw types::ConfigError("", name() + ".water.profile", why);
    if (!rendersOnce() && (truth.connected() || returns.connected()))
        throw types::ConfigError("", name() + (truth.connected() ? ".truth" : ".returns"),
                                 "is connected; a sonar that renders a ping in many parts tells no truth");
    if (elements.connected() && !sonarConfig().elements)
        throw types::ConfigError("", name() + ".elements",
                                 "is connected; the sonar has none: give it `elements`, or leave the connection out");
    if (elements.connected() && !rendersOnce())
        throw types::ConfigError("", name() + ".elements",
                                 "is connected; a sonar that renders a ping in many parts tells no signals");
    renderer_.reset();
    plan_.reset();
    grid_ = makeBinGrid(sonarConfig());
    shortest_ = std::numeric_limits<double>::infinity();
    period_ = {};
    return true;
}

void PingTask::followSnapshot(const types::Snapshot& scene) {
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

bool PingTask::takeGiven() {
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

std::map<std::string, std::string> PingTask::changedBy(const types::SonarSettings& asked) const {
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

void PingTask::applySettings(const types::SonarSettings& asked) {
    const auto changed = changedBy(asked);
    if (!changed.empty()) properties().front()->setAll(changed);
    if (!asked.bearing.isUnknown()) turnHead(asked.bearing);
}

bool PingTask::takeAsked() {
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

bool PingTask::takeNext() {
    if (given_pose.connected()) return takeGiven();
    if (settings.connected()) return takeAsked();
    types::SnapshotPtr sample;
    if (!snapshot.takeNext(sample)) return false;
    aim(*sample);
    return true;
}

void PingTask::aim(const types::Snapshot& scene) {
    begun_ = now();
    aimed_ = scene;
    if (activity().realtime() && aimed_.max_extrapolation > 0) {
        aimed_.sonar = types::extrapolatePose(aimed_.sonar, begun_, aimed_.max_extrapolation);
        aimed_.time = aimed_.sonar.time;
    }
    used_ = aimed_.sonar;
}

void PingTask::updateHook() {
    if (!takeNext()) return;
    const char* refusal = aimed_.geometry ? normalisePose(aimed_.sonar) : "the snapshot has no geometry";
    if (!refusal && activity().realtime() && (aimed_.time - now()).seconds() > 1)
        refusal = "the snapshot's time is ahead of the clock by more than a second";
    if (!refusal) {
        followSnapshot(aimed_);
        refusal = steer(aimed_);
    }
    if (refusal) return error(refusal);
    if (state() == framework::TaskState::RunTimeError) recover();
    environment().rehearsing ? rehearse() : render();
    goOn();
}

void PingTask::rehearse() {
    const auto sample = std::make_shared<types::Sonar>();
    sample->time = aimed_.time;
    if (pose.connected()) pose.write(used_);
    ping.write(sample);
}

std::string PingTask::indivisible() const {
    if (!sonarConfig().choosesQuality()) return {};
    return "quality: is chosen from the pings before, which a shard does not have; give rows and columns_per_beam, "
           "such "
           "as a run of a few pings tells";
}

void PingTask::makeRenderer() {
    renderer_.reset();
    quality_.reset();
    geometry_ = aimed_.geometry;
    diagnostics_.emplace(*geometry_, pingsPerTurn());
    const SonarConfig config = locatedConfig();
    renderer_ = std::make_unique<SonarRenderer>(begun(config), geometry_);
    if (config.choosesQuality()) quality_.emplace(config, pingsPerTurn());
    plan_ = renderer_->plan();
    if (const std::string note = depthNotice(renderer_->renderPlan(), aimed_); !note.empty())
        plan_->notices.push_back(note);
    culling_untold_ = true;
    plan_told_ = false;
    aimed_.moved.reserve(geometry_->objects.size());
}

void PingTask::followQuality(types::Sonar& sample, double ms) {
    if (!quality_) return;
    const double period_ms = activity().realtime() ? 1e3 * period_.period() : 0;
    const bool changed = quality_->follow(*renderer_, aimed_, sample, ms, period_ms);
    std::ranges::move(quality_->takeNotices(), std::back_inserter(plan_->notices));
    if (!changed) return;
    plan_->rows = quality_->quality().rows;
    plan_->columns_per_beam = quality_->quality().columns_per_beam;
    plan_->predicted_error = quality_->quality().error;
    plan_told_ = false;
}

bool PingTask::renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample) {
    renderer.render(scene, sample);
    return renderer.hasEchoes() || renderer.othersHeard() > 0;
}

RenderPlan PingTask::coverage(const types::Snapshot& /*scene*/) const { return renderer_->renderPlan(); }

std::string PingTask::diagnosticOf(bool heard, const types::Sonar& sample) {
    const Model model = renderer_->renderPlan().config.model;
    return diagnostics_->follow(heard, model, aimed_, sample, [this] { return coverage(aimed_); });
}

void PingTask::render() {
    if (!renderer_ || geometry_ != aimed_.geometry) makeRenderer();
    const auto sample = pool_.take();
    const auto told = takeTruth();
    renderer_->setTruth(*sample, told.get());
    const auto start = std::chrono::steady_clock::now();
    const bool heard = renderPing(*renderer_, aimed_, *sample);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    for (const Stage& stage : renderStages(*renderer_)) recordStage(stage.name, stage.seconds);
    if (std::exchange(culling_untold_, false) && rendersOnce()) {
        for (const LeftOut& what : renderer_->leftOut()) {
            plan_->omitted.push_back(describe(what, grid_));
            if (what.reason == Reason::Lacking)
                plan_->notices.push_back("Warning: " + plan_->omitted.back().reason);
        }
    }
    followQuality(*sample, took.count());
    if (const std::string diagnostic = diagnosticOf(heard, *sample); !diagnostic.empty()) warn(diagnostic);
    stampBearings(*sample);
    pool_.stock(*sample);
    if (!std::exchange(plan_told_, true)) refreshRecord();
    if (!waitForLastEcho()) return;
    if (pose.connected()) pose.write(used_);
    tellMore(*sample, aimed_.sonar);
    ping.write(sample);
    if (told) writeTruth(*sample, told);
    if (elements.connected()) writeElements(*sample);
}

std::shared_ptr<types::SonarTruth> PingTask::takeTruth() {
    if (!truth.connected() && !returns.connected()) return nullptr;
    return truths_.take();
}

void PingTask::writeTruth(const types::Sonar& sample, const std::shared_ptr<types::SonarTruth>& told) {
    told->takeGrid(sample);
    told->objects.resize(geometry_->objects.size());
    for (size_t i = 0; i < told->objects.size(); ++i) told->objects[i] = geometry_->objects[i].name;
    truths_.stock(*told);
    if (truth.connected()) truth.write(told);
    if (!returns.connected()) return;
    const auto found = all_returns_.take();
    found->take(sample, *told);
    all_returns_.stock(*found);
    returns.write(found);
}

void PingTask::writeElements(const types::Sonar& sample) {
    const auto signals = signals_.take();
    renderer_->takeElements(sample, *signals);
    signals_.stock(*signals);
    elements.write(signals);
}

bool PingTask::waitForLastEcho() {
    if (!activity().realtime()) return true;
    const types::Time heard{std::max(aimed_.time, begun_).microseconds +
                            static_cast<int64_t>(std::ceil(echoTime() * 1e6))};
    return activity().sleepUntil(heard);
}

}  // namespace insonify::sonar
