#include "components/sonar/tasks/PingTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/SoundSpeed.hpp"
#include "components/framework/execution/Activity.hpp"
#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/effects/Refraction.hpp"
#include "components/sonar/multipath/OtherSonars.hpp"
#include "components/sonar/renderer/BinExplanation.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sonar {
namespace {

/** Returns the configuration with the initial quality, until the first echo, where the quality is not given. */
SonarConfig initial(SonarConfig config) {
    if (!config.choosesQuality()) return config;
    const Quality quality = firstQuality(config);
    config.quality = {};
    config.quality.rows = quality.rows;
    config.quality.columns_per_beam = quality.columns_per_beam;
    return config;
}

}  // namespace

PingTask::~PingTask() {
    if (isRunning()) stop();
    if (state() == framework::TaskState::Stopped) cleanup();
}

types::Notices PingTask::notices() const {
    types::Notices all = plan_ ? plan_->notices : configNotices(sonarConfig());
    if (shortestPeriod() < echoTime() * (1 - 1e-6))
        all.push_back(types::warning(
            fmt::format("pings {:.3g} s apart are ambiguous in range, sound takes {:.3g} s to {:.4g} m and back; each "
                        "is rendered by itself",
                        shortestPeriod(), echoTime(), grid().range_max)));
    if (cut_off_ > 0)
        all.push_back(fmt::format("the last {} for pings of other sonars when the run stopped: not written",
                                  cut_off_ == 1 ? "ping waited" : "pings waited"));
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

void PingTask::check(types::Diagnostics& diagnostics) const {
    const auto read = [&](const std::string& property, const auto& table) {
        try {
            table();
        } catch (const types::ConfigError& error) {
            for (const types::Diagnostic& each : error.diagnostics()) diagnostics.push_back({property, each.text()});
        }
    };
    const SonarConfig located = locatedConfig();
    if (located.water && located.water->profile)
        read("water.profile", [&] { acoustics::SoundProfile::read(*located.water->profile); });
    if (!located.beam_pattern) return;
    const BeamPatternConfig& pattern = *located.beam_pattern;
    for (const auto& [side, array] : {std::pair("transmit", &pattern.transmit), std::pair("receive", &pattern.receive)})
        for (const auto& [angle, law] :
             {std::pair("azimuth", &array->azimuth), std::pair("elevation", &array->elevation)})
            if (*law && !(*law)->file.empty())
                read(fmt::format("beam_pattern.{}.{}.file", side, angle), [&] { acoustics::BeamPattern{**law}; });
}

bool PingTask::configureHook() {
    if (const std::string why = whyTooLarge(locatedConfig()); !why.empty())
        throw types::ConfigError("", name() + ".beam_pattern", why);
    if (const std::string why = whyStraight(locatedConfig()); !why.empty())
        throw types::ConfigError("", name() + ".water.profile", why);
    if (elements.connected() && !sonarConfig().elements)
        throw types::ConfigError("", name() + ".elements",
                                 "is connected; the sonar has none: give it `elements`, or remove the connection");
    if (elements.connected() && !rendersOnce())
        throw types::ConfigError("", name() + ".elements",
                                 "is connected; a sonar that renders a ping in many parts has no element signals");
    if (others.connected() && !sonarConfig().crosstalk)
        throw types::ConfigError(
            "", name() + ".others",
            "is connected; the sonar does not receive other sonars: give it `crosstalk: {}`, or remove the connection");
    sonarConfig().requireDevice(name());
    transmitted_ = {};
    is_changed_ = renderer_ != nullptr;
    if (!renderer_) plan_.reset();
    resetTrigger();
    return true;
}

framework::Outcome PingTask::restart() {
    std::unique_ptr<SonarRenderer> kept;
    const bool changed = is_changed_;
    if (renderer_ && !quality_ && renderer_->forget()) kept = std::move(renderer_);
    if (framework::Outcome outcome = cleanup(); !outcome) return outcome;
    if (framework::Outcome outcome = configure(); !outcome || !kept) return outcome;
    renderer_ = std::move(kept);
    is_changed_ = changed;
    diagnostics_.emplace(pingsPerTurn());
    updatePlan();
    return {};
}

void PingTask::updateHook() {
    if (others.connected()) return listen();
    if (readNext() && begin()) complete();
}

bool PingTask::begin() {
    if (const char* why = refusal()) {
        error(why);
        return false;
    }
    if (state() == framework::TaskState::RunTimeError) recover();
    if (transmission.connected()) transmit();
    return true;
}

void PingTask::prepareTransmission() {
    const SonarConfig config = locatedConfig();
    const Waveform form = waveform(config, grid());
    transmitted_.radiation = std::make_shared<SentPower>(config);
    if (config.crosstalk && config.crosstalk->source_level_db)
        transmitted_.source_level_db = *config.crosstalk->source_level_db;
    transmitted_.frequency_khz = form.frequency_khz;
    transmitted_.bandwidth_khz = form.bandwidth_khz;
    transmitted_.duration = form.duration;
}

void PingTask::transmit() {
    if (!transmitted_.radiation) prepareTransmission();
    const auto sent = std::make_shared<types::Transmission>(transmitted_);
    sent->time = takenScene().time;
    sent->sonar = takenScene().sonar;
    transmission.write(sent);
}

void PingTask::complete() {
    environment().rehearsing ? rehearse() : render();
    goOn();
}

void PingTask::receiveOthers() {
    types::TransmissionPtr sent;
    while (others.readNew(sent)) others_received_.add(sent);
}

void PingTask::listen() {
    receiveOthers();
    if (listening_ && (now() - listening_->scene.time).seconds() >= echoTime()) endListening();
    if (!readNext()) return;
    if (listening_) endListening();  // the next ping ends it
    if (!begin()) return;
    if (!activity().realtime()) {
        listening_ = taken();
        return;
    }
    const types::Time received = lastEcho(), ready = received - types::Time::fromSeconds(1.2 * render_seconds_ + 1e-3);
    if (ready > now() && !activity().sleepUntil(ready)) return;
    receiveOthers();
    others_received_.give(takenScene(), grid().range_max, grid().speed_of_sound);
    complete();
}

void PingTask::endListening() {
    swapTaken(*listening_);
    others_received_.give(takenScene(), grid().range_max, grid().speed_of_sound);
    complete();
    swapTaken(*listening_);
    heard_ = std::exchange(listening_, {});
}

PingTask::RenderedBeam PingTask::renderedBeam(size_t beam) const {
    if (!plan_) throw std::runtime_error("there is no ping yet");
    RenderedBeam rendered{locatedConfig(), heard_ ? heard_->scene : takenScene(), beam};
    rendered.config.quality = {};
    rendered.config.quality.rows = plan_->rows;
    rendered.config.quality.columns_per_beam = plan_->columns_per_beam;
    return rendered;
}

std::string PingTask::explainAt(const Place& place) {
    if (!explained_.second.empty() && explained_.first == place) return std::exchange(explained_.second, {});
    if (explanation_.valid() && explanation_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        explained_ = {explaining_, explanation_.get()};
        if (explaining_ == place) return std::exchange(explained_.second, {});
    }
    if (!explanation_.valid()) beginExplanation(place);
    return {};
}

void PingTask::beginExplanation(const Place& place) {
    if (!last_ping_) throw std::runtime_error("there is no ping yet");
    const types::Sonar& sample = *last_ping_;
    const auto [bearing_deg, range] = place;
    const auto apart = [bearing = types::radians(bearing_deg)](const types::Angle& beam) {
        return std::abs(std::remainder(beam.rad - bearing, 2 * std::numbers::pi));
    };
    const auto nearest = std::ranges::min_element(sample.bearings, {}, apart);
    if (!(apart(*nearest) <= std::max(sample.beam_width.rad, types::radians(1))))
        throw std::runtime_error(fmt::format(
            "the last ping has no beam at {:.2f} deg; the nearest one is at {:.2f} deg", bearing_deg, nearest->deg()));
    if (!(range >= 0 && range < sample.binStart(sample.bin_count)))
        throw std::runtime_error(fmt::format("the last ping has no bin at {:.3f} m; its bins end at {:.3f} m", range,
                                             sample.binStart(sample.bin_count)));
    const auto bin = std::min(static_cast<size_t>(range / sample.binWidth()), size_t{sample.bin_count} - 1);
    const auto row = static_cast<size_t>(nearest - sample.bearings.begin());
    const std::string head =
        fmt::format("ping at {:.3f} s, beam {} at {:.2f} deg, bin {} at {:.3f} m: {}\n", sample.time.seconds(), row,
                    nearest->deg(), bin, sample.binStart(static_cast<uint32_t>(bin)),
                    intensityText(double{sample.bins[row * sample.bin_count + bin]}));
    explaining_ = place;
    explanation_ = std::async(std::launch::async, [head, bin, beam = renderedBeam(row)]() -> std::string {
        try {
            types::useDefaultScheduling();
            return head + text(explainBin(beam.config, beam.scene, beam.beam, bin));
        } catch (const std::exception& error) {
            return head + "cannot be explained: " + error.what();
        }
    });
}

void PingTask::cleanupHook() {
    explanation_ = {};  // waits for its thread
    last_ping_.reset();
    renderer_.reset();
}

void PingTask::stopHook() {
    TriggeredTask::stopHook();
    cut_off_ += listening_ ? 1 : 0;
    listening_.reset();
    others_received_.clear();
}

void PingTask::rehearse() {
    const auto sample = std::make_shared<types::Sonar>();
    sample->time = takenScene().time;
    if (pose.connected()) pose.write(usedPose());
    ping.write(sample);
}

std::string PingTask::indivisible() const {
    if (others.connected()) return "others: the sonar receives pings of other sonars, which a shard does not have";
    if (!sonarConfig().choosesQuality()) return {};
    return "quality: is chosen from the pings before, which a shard does not have; give rows and columns_per_beam, "
           "such as a run of a few pings reports";
}

void PingTask::prepareRenderer() {
    if (renderer_ && geometry_ == takenScene().geometry && !is_changed_) return;
    const types::GeometryPtr before = std::exchange(geometry_, takenScene().geometry);  // kept until unused
    takenScene().moved.reserve(geometry_->objects.size());
    if (!renderer_) return makeRenderer();
    const bool has_plan = renderer_->setGeometry(geometry_);
    if (is_changed_) return changeRenderer();
    if (has_plan) updatePlan();
}

void PingTask::changeRenderer() {
    SonarConfig config = locatedConfig();
    if (!config.choosesQuality())
        quality_.reset();
    else if (!quality_ || !quality_->changeConfig(config))
        quality_.emplace(config, pingsPerTurn());
    if (quality_ && quality_->isChosen()) {
        const Quality quality = quality_->upcoming();
        config.quality = {};
        config.quality.rows = quality.rows;
        config.quality.columns_per_beam = quality.columns_per_beam;
    }
    renderer_->setConfig(initial(config));
    is_changed_ = false;
    diagnostics_.emplace(pingsPerTurn());
    updatePlan();
}

void PingTask::makeRenderer() {
    const SonarConfig config = locatedConfig();
    is_changed_ = false;
    quality_.reset();
    diagnostics_.emplace(pingsPerTurn());
    RenderOptions options;
    options.threads = renderThreads();
    renderer_ = std::make_unique<SonarRenderer>(initial(config), geometry_, options);
    if (config.choosesQuality()) quality_.emplace(config, pingsPerTurn());
    updatePlan();
}

const DetectionRules& PingTask::detectionRules() {
    if (!rules_) rules_ = DetectionRules::of(renderer_->renderPlan());
    return *rules_;
}

void PingTask::findStrongest(const types::Sonar& sample, const DetectionRules& rules,
                             std::vector<uint32_t>& strongest) {
    DetectionConfig any;
    any.threshold_db = -3000;
    detector_.take(sample, any, rules);
    strongest.resize(sample.beam_count);
    for (uint32_t beam = 0; beam < sample.beam_count; ++beam) {
        const auto found = detector_.strongest(beam);
        strongest[beam] = found ? static_cast<uint32_t>(found->bin) : sample.bin_count;
    }
}

void PingTask::updatePlan() {
    rules_.reset();
    plan_ = renderer_->plan();
    if (const auto outside = depthNotice(renderer_->renderPlan(), takenScene())) plan_->notices.push_back(*outside);
    if (quality_ && quality_->isChosen()) plan_->predicted_error = quality_->quality().error;
    culling_untold_ = true;
    plan_reported_ = false;
}

void PingTask::followQuality(types::Sonar& sample, double ms) {
    if (!quality_) return;
    const bool changed = quality_->follow(*renderer_, takenScene(), sample, ms, 1e3 * realtimePeriod());
    std::ranges::move(quality_->consumeNotices(), std::back_inserter(plan_->notices));
    if (!changed) return;
    rules_.reset();
    plan_->rows = quality_->quality().rows;
    plan_->columns_per_beam = quality_->quality().columns_per_beam;
    plan_->predicted_error = quality_->quality().error;
    plan_reported_ = false;
}

bool PingTask::renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                          types::SonarTruth* truth_of_ping) {
    renderer.setTruth(sample, truth_of_ping);
    renderer.render(scene, sample);
    return renderer.hasEchoes() || renderer.othersReceived() > 0;
}

RenderPlan PingTask::coverage(const types::Snapshot& /*scene*/) const { return renderer_->renderPlan(); }

std::string PingTask::findDiagnostic(bool received, const types::Sonar& sample) {
    return diagnostics_->follow(received, *renderer_, takenScene(), sample, [this] { return coverage(takenScene()); });
}

void PingTask::render() {
    prepareRenderer();
    const auto sample = pool_.take();
    const auto reported = acquireTruth();
    const auto signals = elements.connected() ? signals_.take() : nullptr;
    renderer_->setElements(*sample, signals.get());
    const Counts before = thread_counts;
    const double divided_before = divided_seconds;
    const auto start = std::chrono::steady_clock::now();
    const bool received = renderPing(*renderer_, takenScene(), *sample, reported.get());
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    render_seconds_ = took.count() / 1e3;
    for (const Stage& stage : renderStages(*renderer_)) recordStage(stage.name, stage.seconds);
    counted_.add(before, renderStages(*renderer_));
    if (counted_.pings > 1) {  // the first ping builds trees
        counted_.all_seconds += render_seconds_;
        counted_.divided_seconds += divided_seconds - divided_before;
    }
    if (std::exchange(culling_untold_, false) && rendersOnce()) {
        for (const Omitted& what : renderer_->omissions()) {
            plan_->omitted.push_back(describe(what, grid()));
            if (what.reason == Reason::Lacking) plan_->notices.push_back(types::warning(plan_->omitted.back().reason));
        }
    }
    followQuality(*sample, took.count());
    if (signals) renderer_->setElements(*sample, nullptr);
    if (signals) signals_.stock(*signals);
    if (const std::string diagnostic = findDiagnostic(received, *sample); !diagnostic.empty()) warn(diagnostic);
    stampBearings(*sample);
    pool_.stock(*sample);
    if (!std::exchange(plan_reported_, true)) refreshRecord();
    if (!waitForLastEcho()) return;
    if (pose.connected()) pose.write(usedPose());
    writeMore(*sample, takenScene().sonar);
    ping.write(sample);
    last_ping_ = sample;
    if (reported) writeTruth(*sample, reported);
    if (signals) elements.write(signals);
}

std::shared_ptr<types::SonarTruth> PingTask::acquireTruth() { return wantsTruth() ? truths_.take() : nullptr; }

void PingTask::nameObjects(types::SonarTruth& truth_of_ping) const {
    std::vector<std::string>& names = truth_of_ping.objects;
    names.resize(geometry_->objects.size());
    for (size_t i = 0; i < names.size(); ++i) names[i] = geometry_->objects[i].name;
}

void PingTask::writeTruth(const types::Sonar& sample, const std::shared_ptr<types::SonarTruth>& reported) {
    reported->copyGrid(sample);
    nameObjects(*reported);
    truths_.stock(*reported);
    if (truth.connected()) truth.write(reported);
    if (!returns.connected()) return;
    const auto found = all_returns_.take();
    findStrongest(sample, strongest_);
    found->take(sample, *reported, strongest_);
    all_returns_.stock(*found);
    returns.write(found);
}

types::Time PingTask::lastEcho() const {
    // No ping is ahead of the clock by more than a second, unless the clock has been set back meanwhile.
    const types::Time sent = std::min(std::max(takenScene().time, begun()), now() + types::Time::fromSeconds(1));
    return {sent.microseconds + static_cast<int64_t>(std::ceil(echoTime() * 1e6))};
}

bool PingTask::waitForLastEcho() { return !activity().realtime() || activity().sleepUntil(lastEcho()); }

}  // namespace insonify::sonar
