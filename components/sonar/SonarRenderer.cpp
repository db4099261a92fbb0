#include "components/sonar/SonarRenderer.hpp"

#include <chrono>
#include <stdexcept>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/EchoField.hpp"
#include "components/sonar/LineArray.hpp"
#include "components/sonar/PlanReport.hpp"
#include "components/sonar/PointTargets.hpp"

namespace insonify::sonar {
namespace {

constexpr Stages no_time{{{"cull", 0}, {"draw", 0}, {"read", 0}, {"deposit", 0}, {"beams", 0}}};

/** The transmitter, as every beam hears it in its first bins (ACOUSTICS.md 5.15). */
class RingDown {
public:
    /** Of a plan whose pulse has one. */
    explicit RingDown(const RenderPlan& plan);
    /** Once the bins are filled. Allocates nothing. */
    void add(types::Sonar& ping) const;

private:
    std::vector<float> bins_;  ///< Of each beam, as far as anything is left.
};

RingDown::RingDown(const RenderPlan& plan) {
    for (int k = 0; k < plan.grid.bin_count; ++k) {
        const double heard = plan.config.pulse->ring_down->mean(plan.grid.edge(k), plan.grid.edge(k + 1));
        if (static_cast<float>(heard) == 0) return;
        bins_.push_back(static_cast<float>(heard));
    }
}

void RingDown::add(types::Sonar& ping) const {
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        for (size_t k = 0; k < bins_.size(); ++k) ping.bins[beam * ping.bin_count + k] += bins_[k];
}

}  // namespace

struct SonarRenderer::Parts {
    Parts(const SonarConfig& config, types::GeometryPtr scene, const RenderOptions& options);
    ~Parts();
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;
    void addTargets(const types::Snapshot& snapshot, types::Sonar& ping);

    types::GeometryPtr geometry;
    RenderPlan plan;
    types::Plan told;
    Stages stages = no_time;
    std::unique_ptr<EchoRenderer> echoes;
    const types::Sonar* told_ping = nullptr;
    types::SonarTruth* truth = nullptr;   ///< Filled with that ping; null: none is.
    std::optional<PointTargets> targets;  ///< From the first ping with any on.
    std::optional<RingDown> ring_down;
    std::optional<LineArray> array;  ///< From the first ping whose signals are taken on.
    size_t targets_heard = 0;        ///< In the last ping [1].
    std::optional<LeftOut> targets_left_out;
};

SonarRenderer::Parts::Parts(const SonarConfig& config, types::GeometryPtr scene, const RenderOptions& options)
    : geometry(scene), plan(makeRenderPlan(config, *scene, options)), told(report(plan, *scene)) {
    if (plan.has(Pass::RingDown)) ring_down.emplace(plan);
    if (plan.casts_rays) {
        echoes = makeCastEchoes(plan, std::move(scene));
    } else {
        const auto alone = gpu::EglContext::making();
        echoes = makeDrawnEchoes(plan, std::move(scene));
    }
    told.device = echoes->device();
    if (const std::string notice = echoes->notice(); !notice.empty()) told.notices.push_back(notice);
}

SonarRenderer::Parts::~Parts() {
    if (plan.casts_rays) return;
    const auto alone = gpu::EglContext::making();
    echoes.reset();
}

void SonarRenderer::Parts::addTargets(const types::Snapshot& snapshot, types::Sonar& ping) {
    if (plan.config.model != Model::Physical) return;
    targets_heard = 0;
    targets_left_out.reset();
    const size_t all = snapshot.targets.size();
    if (all == 0) {
        targets_left_out = LeftOut{Effect::PointTargets, Reason::NoneInScene};
        return;
    }
    if (!targets) targets.emplace(plan, *geometry);
    targets_heard = targets->add(snapshot, ping, echoes->field(), echoes->bent());
    if (targets_heard < all)
        targets_left_out = LeftOut{Effect::PointTargets, Reason::OutOfView, static_cast<double>(all - targets_heard),
                                   static_cast<double>(all)};
}

void SonarRenderer::Parts::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    ping.time = snapshot.time;
    ping.timestamps.clear();
    ping.bin_duration.microseconds = plan.grid.bin_duration_us;
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
    parts_->stages = no_time;
    parts_->fillHeader(snapshot, ping);
    types::SonarTruth* const truth = &ping == parts_->told_ping ? parts_->truth : nullptr;
    if (truth) truth->takeGrid(ping);
    parts_->echoes->setTruth(truth);
    parts_->echoes->render(snapshot, ping, parts_->stages);
    parts_->echoes->setTruth(nullptr);
    finish(snapshot, ping);
    if (!truth) return;
    types::SonarTruth::forEachArray(*truth, [&](const char*, auto& numbers, auto) {
        parts_->plan.beams.toTableOrder(std::span(numbers), truth->bin_count);
    });
}

void SonarRenderer::setTruth(const types::Sonar& ping, types::SonarTruth* truth) {
    parts_->told_ping = &ping;
    parts_->truth = truth;
}

void SonarRenderer::finish(const types::Snapshot& snapshot, types::Sonar& ping) {
    const auto start = std::chrono::steady_clock::now();
    parts_->addTargets(snapshot, ping);
    if (const EchoField* field = parts_->echoes->field()) field->detect(ping);
    if (parts_->ring_down) parts_->ring_down->add(ping);
    parts_->plan.beams.toTableOrder(std::span(ping.bins), ping.bin_count);
    parts_->stages[BeamStage].seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void SonarRenderer::takeElements(const types::Sonar& ping, types::SonarElements& signals) {
    const EchoField* field = parts_->echoes->field();
    if (!field || !parts_->plan.config.elements) throw std::logic_error("the sonar has no elements");
    if (!parts_->array) parts_->array.emplace(lineArrayOf(parts_->plan.config));
    takeSignals(parts_->plan, *field, *parts_->array, signals);
    signals.time = ping.time;
}

void SonarRenderer::setQuality(int rows, int columns_per_beam) {
    parts_->plan.setQuality(rows, columns_per_beam);
    parts_->told.rows = rows;
    parts_->told.columns_per_beam = columns_per_beam;
    parts_->echoes->takeQuality();
}

std::span<const Stage> SonarRenderer::stages() const { return parts_->stages; }
bool SonarRenderer::hasEchoes() const { return parts_->echoes->hasEchoes(); }
std::vector<LeftOut> SonarRenderer::culled() const { return parts_->echoes->culled(); }
size_t SonarRenderer::targetsHeard() const { return parts_->targets_heard; }
std::optional<LeftOut> SonarRenderer::targetsLeftOut() const { return parts_->targets_left_out; }
const RenderPlan& SonarRenderer::renderPlan() const { return parts_->plan; }
const types::Plan& SonarRenderer::plan() const { return parts_->told; }
const std::string& SonarRenderer::device() const { return parts_->echoes->device(); }

}  // namespace insonify::sonar
