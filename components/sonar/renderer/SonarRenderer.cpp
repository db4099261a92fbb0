#include "components/sonar/renderer/SonarRenderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/bins/EchoField.hpp"
#include "components/sonar/bins/LineArray.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/surfaces/DeformedMeshes.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

/** Returns the objects whose meshes can deform, ascending. */
std::vector<uint32_t> deformable(const types::Geometry& geometry) {
    std::vector<uint32_t> objects;
    for (size_t i = 0; i < geometry.objects.size(); ++i)
        if (geometry.meshes[static_cast<size_t>(geometry.objects[i].mesh)].deformation)
            objects.push_back(static_cast<uint32_t>(i));
    return objects;
}

bool isFinite(const glm::dvec3& place) {
    return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

/** Returns the first bin that is negative or not finite. */
size_t firstWrong(const std::vector<float>& bins) {
    const auto wrong = [](float bin) { return !(bin >= 0 && bin <= std::numeric_limits<float>::max()); };
    return static_cast<size_t>(std::ranges::find_if(bins, wrong) - bins.begin());
}

}  // namespace

struct SonarRenderer::Parts {
    Parts(const SonarConfig& config, types::GeometryPtr given, const RenderOptions& options);
    ~Parts();
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;
    void start();
    void makeEchoes();
    void deform(const types::Snapshot& snapshot);
    bool setScene(types::GeometryPtr given);
    void changeConfig(const SonarConfig& config);
    /** Poses the meshes that deform, if there are any. */
    void updateShapes(const types::Snapshot& snapshot);
    void describePlan();
    types::SonarTruth* getTruth(const types::Sonar& ping) const { return &ping == reported_ping ? truth : nullptr; }

    types::GeometryPtr scene;                  ///< Geometry of the snapshots.
    std::unique_ptr<DeformedMeshes> deformed;  ///< Null: no mesh deforms.
    types::GeometryPtr geometry;               ///< That is rendered: the scene, or that of `deformed`.
    RenderPlan plan;
    PingEffects effects;
    types::Plan reported;
    Stages stages = empty_stages;
    std::unique_ptr<EchoRenderer> echoes;
    const types::Sonar* reported_ping = nullptr;
    types::SonarTruth* truth = nullptr;  ///< Filled with `reported_ping`; null: no truth.
    const types::Sonar* heard_ping = nullptr;
    types::SonarElements* signals = nullptr;  ///< Filled with `heard_ping`; null: no signals.
    std::optional<LineArray> array;           ///< Made at the first ping whose signals are taken.
};

SonarRenderer::Parts::Parts(const SonarConfig& config, types::GeometryPtr given, const RenderOptions& options)
    : scene(given), geometry(given), plan(makeRenderPlan(config, *given, options)), effects(plan, *given) {
    start();
    describePlan();
}

/** A rasterising renderer has its scene on the device, so it begins with all objects that can deform. */
void SonarRenderer::Parts::start() {
    if (plan.traces_rays || deformable(*scene).empty()) return makeEchoes();
    types::Snapshot rest;
    rest.geometry = scene;
    deform(rest);
}

void SonarRenderer::Parts::makeEchoes() {
    if (plan.traces_rays) {
        echoes = makeRayEchoes(plan, geometry, effects);
        return;
    }
    const auto alone = gpu::EglContext::making();
    echoes.reset();
    echoes = makeRasterEchoes(plan, geometry, effects);
}

void SonarRenderer::Parts::describePlan() {
    reported = report(plan, *geometry);
    reported.device = echoes->device();
    echoes->note(reported.notices);
}

/** Gives each object that a snapshot deforms a mesh of its own; where scenes are rasterised, each that can deform. */
void SonarRenderer::Parts::deform(const types::Snapshot& snapshot) {
    const std::vector<uint32_t> others = !plan.traces_rays ? deformable(*scene)
                                         : deformed        ? deformed->objects()
                                                           : std::vector<uint32_t>();
    const auto before = std::exchange(deformed, std::make_unique<DeformedMeshes>(snapshot, others));
    const types::GeometryPtr geometry_before = std::exchange(geometry, deformed->geometry());
    effects.setScene(*geometry);
    if (!plan.traces_rays) makeEchoes();
    echoes->deform(deformed.get(), geometry);
}

void SonarRenderer::Parts::updateShapes(const types::Snapshot& snapshot) {
    if (snapshot.deformed.empty() && !deformed) return;
    const auto start = std::chrono::steady_clock::now();
    if (!deformed || !deformed->serves(snapshot)) deform(snapshot);
    if (!deformed->changes(snapshot)) return;
    echoes->updateShapes(snapshot);
    effects.updateShapes(snapshot);
    stages[CullStage].seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool SonarRenderer::Parts::setScene(types::GeometryPtr given) {
    if (given == scene) return false;
    const std::unique_ptr<DeformedMeshes> deformed_before = std::move(deformed);
    if (deformed_before && plan.traces_rays) echoes->deform(nullptr, scene);
    scene = given;
    const bool same_plan =
        given->materials == geometry->materials && given->normal_maps.sharesAll(geometry->normal_maps);
    if (same_plan) {
        effects.setScene(*given);
    } else {
        plan = makeRenderPlan(plan.config, *given, plan.options);
        effects = PingEffects(plan, *given);
    }
    const types::GeometryPtr before = std::exchange(geometry, given);  // kept until unused
    if (!echoes->setScene(std::move(given), same_plan)) start();
    if (!same_plan) describePlan();
    return !same_plan;
}

void SonarRenderer::Parts::changeConfig(const SonarConfig& config) {
    const bool traced_rays = plan.traces_rays;
    RenderPlan next = makeRenderPlan(config, *scene, plan.options);
    if (!traced_rays && next.traces_rays) {
        const auto alone = gpu::EglContext::making();
        echoes.reset();
    }
    plan = std::move(next);
    effects = PingEffects(plan, *geometry);
    array.reset();
    if (deformed) deformed->forget();
    if (traced_rays != plan.traces_rays || !echoes->changePlan()) start();
    describePlan();
}

SonarRenderer::Parts::~Parts() {
    if (plan.traces_rays) return;
    const auto alone = gpu::EglContext::making();
    echoes.reset();
}

void SonarRenderer::Parts::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    ping.time = snapshot.time;
    ping.timestamps.clear();
    ping.bin_duration.microseconds = plan.grid.bin_duration_us;
    ping.bin_width = plan.config.range_rounding == RangeRounding::Exact ? plan.grid.bin_width : 0;
    ping.beam_width = types::Angle::fromDeg(plan.config.beamWidthDeg());
    ping.beam_height = types::Angle::fromDeg(plan.config.beam_height_deg);
    ping.bearings.resize(plan.beams.size());
    for (size_t row = 0; row < plan.beams.size(); ++row)
        ping.bearings[row] = types::Angle::fromRad(plan.beams.tableBearing(row));
    ping.speed_of_sound = static_cast<float>(plan.grid.speed_of_sound);
    ping.bin_count = static_cast<uint32_t>(plan.grid.bin_count);
    ping.beam_count = static_cast<uint32_t>(plan.beams.size());
    ping.bins.resize(plan.beams.size() * static_cast<size_t>(plan.grid.bin_count));
}

SonarRenderer::SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry, const RenderOptions& options)
    : parts_(std::make_unique<Parts>(config, std::move(geometry), options)) {}

SonarRenderer::~SonarRenderer() = default;

void SonarRenderer::render(const types::Snapshot& snapshot, types::Sonar& ping) {
    INSONIFY_CHECK(std::abs(glm::length(snapshot.sonar.orientation) - 1) < 1e-6,
                   glm::length(snapshot.sonar.orientation));
    INSONIFY_CHECK(isFinite(snapshot.sonar.position), snapshot.sonar.position);
    parts_->stages = empty_stages;
    parts_->updateShapes(snapshot);
    parts_->fillHeader(snapshot, ping);
    types::SonarTruth* const truth = parts_->getTruth(ping);
    if (truth) truth->copyGrid(ping);
    parts_->effects.begin({snapshot, truth});
    parts_->echoes->setTruth(truth);
    parts_->echoes->render(snapshot, ping, parts_->stages);
    parts_->echoes->setTruth(nullptr);
    finish(snapshot, ping);
    if (&ping == parts_->heard_ping && parts_->signals) computeElements(ping, *parts_->signals);
    if (!truth) return;
    types::SonarTruth::forEachArray(*truth, [&](const char*, auto& numbers, auto) {
        parts_->plan.beams.toTableOrder(std::span(numbers), truth->bin_count);
    });
}

void SonarRenderer::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    parts_->fillHeader(snapshot, ping);
}

bool SonarRenderer::isRemembered(const types::Snapshot& snapshot) const {
    const RenderPlan& plan = parts_->plan;
    return plan.profile || plan.config.motion_in_ping || !snapshot.moved.empty() || !snapshot.deformed.empty() ||
           parts_->deformed;
}

void SonarRenderer::follow(const types::Snapshot& snapshot) {
    parts_->updateShapes(snapshot);
    parts_->echoes->follow(snapshot);
}

void SonarRenderer::setTruth(const types::Sonar& ping, types::SonarTruth* truth) {
    parts_->reported_ping = &ping;
    parts_->truth = truth;
}

void SonarRenderer::finish(const types::Snapshot& snapshot, types::Sonar& ping) {
    const auto start = std::chrono::steady_clock::now();
    Accumulator& echoes = parts_->echoes->accumulator();
    PingInMaking made{snapshot, ping, echoes.field(), parts_->echoes->bent(), parts_->getTruth(ping)};
    parts_->effects.addEchoes(made);
    echoes.detect(ping);
    parts_->effects.addToBins(ping);
    INSONIFY_CHECK(ping.bins.size() == size_t{ping.beam_count} * ping.bin_count, ping.bins.size(), ping.beam_count,
                   ping.bin_count);
    INSONIFY_CHECK(firstWrong(ping.bins) == ping.bins.size(), firstWrong(ping.bins), ping.bins[firstWrong(ping.bins)]);
    parts_->plan.beams.toTableOrder(std::span(ping.bins), ping.bin_count);
    parts_->stages[BeamStage].seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool SonarRenderer::computeAlike(const types::Sonar& ping, types::Sonar& alike) const {
    if (!parts_->plan.has(Pass::RingDown)) return false;
    alike.time = ping.time;
    static_cast<types::RangeBins&>(alike) = ping;
    alike.beam_count = ping.beam_count;
    alike.bin_count = ping.bin_count;
    alike.bins.assign(ping.bins.size(), 0);
    parts_->effects.addAlike(alike);
    parts_->plan.beams.toTableOrder(std::span(alike.bins), alike.bin_count);
    return true;
}

void SonarRenderer::setElements(const types::Sonar& ping, types::SonarElements* signals) {
    if (signals && !(parts_->plan.sumsFields() && parts_->plan.config.elements))
        throw std::logic_error("the sonar has no elements");
    parts_->heard_ping = &ping;
    parts_->signals = signals;
}

void SonarRenderer::computeElements(const types::Sonar& ping, types::SonarElements& signals) {
    const EchoField* field = parts_->echoes->accumulator().field();
    if (!parts_->array) parts_->array.emplace(lineArray(parts_->plan.config));
    computeSignals(parts_->plan, *field, *parts_->array, signals);
    signals.time = ping.time;
}

bool SonarRenderer::forget() {
    parts_->effects = PingEffects(parts_->plan, *parts_->geometry);
    if (parts_->deformed) parts_->deformed->forget();
    return parts_->echoes->forget();
}

bool SonarRenderer::setGeometry(types::GeometryPtr geometry) { return parts_->setScene(std::move(geometry)); }

void SonarRenderer::setConfig(const SonarConfig& config) { parts_->changeConfig(config); }

void SonarRenderer::setQuality(int rows, int columns_per_beam) {
    parts_->plan.setQuality(rows, columns_per_beam);
    parts_->reported.rows = rows;
    parts_->reported.columns_per_beam = columns_per_beam;
    parts_->effects.updateQuality();
    parts_->echoes->updateQuality();
}

std::span<const Stage> SonarRenderer::stages() const { return parts_->stages; }
bool SonarRenderer::hasEchoes() const { return parts_->echoes->hasEchoes(); }
std::vector<Omitted> SonarRenderer::omissions() const {
    std::vector<Omitted> all = parts_->echoes->culled();
    std::ranges::move(parts_->effects.omissions(), std::back_inserter(all));
    return all;
}
size_t SonarRenderer::othersReceived() const { return parts_->effects.received(); }
const RenderPlan& SonarRenderer::renderPlan() const { return parts_->plan; }
const types::GeometryPtr& SonarRenderer::geometry() const { return parts_->geometry; }
const types::Plan& SonarRenderer::plan() const { return parts_->reported; }
const std::string& SonarRenderer::device() const { return parts_->echoes->device(); }

}  // namespace insonify::sonar
