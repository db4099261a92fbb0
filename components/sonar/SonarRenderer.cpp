#include "components/sonar/SonarRenderer.hpp"

#include <algorithm>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/CastEchoes.hpp"
#include "components/sonar/DrawnEchoes.hpp"
#include "components/sonar/PlanReport.hpp"

namespace insonify::sonar {

struct SonarRenderer::Parts {
    Parts(const SonarConfig& config, types::GeometryPtr scene);
    ~Parts();
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;

    RenderPlan plan;
    types::Plan told;
    Stages stages{{{"cull", 0}, {"draw", 0}, {"read", 0}, {"deposit", 0}, {"beams", 0}}};
    std::unique_ptr<EchoRenderer> echoes;
};

SonarRenderer::Parts::Parts(const SonarConfig& config, types::GeometryPtr scene)
    : plan(makeRenderPlan(config, *scene)), told(report(plan, *scene)) {
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

void SonarRenderer::Parts::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    ping.time = snapshot.time;
    ping.timestamps.clear();
    ping.bin_duration.microseconds = plan.grid.bin_duration_us;
    ping.beam_width = types::Angle::fromDeg(plan.config.beamWidthDeg());
    ping.beam_height = types::Angle::fromDeg(plan.config.beam_height_deg);
    ping.bearings.resize(plan.beams.size());
    for (size_t k = 0; k < plan.beams.size(); ++k) ping.bearings[k] = types::Angle::fromRad(plan.beams[k].centre);
    ping.speed_of_sound = static_cast<float>(plan.grid.speed_of_sound);
    ping.bin_count = static_cast<uint32_t>(plan.grid.bin_count);
    ping.beam_count = static_cast<uint32_t>(plan.beams.size());
    ping.bins.resize(plan.beams.size() * static_cast<size_t>(plan.grid.bin_count));
}

SonarRenderer::SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry)
    : parts_(std::make_unique<Parts>(config, std::move(geometry))) {}

SonarRenderer::~SonarRenderer() = default;

void SonarRenderer::render(const types::Snapshot& snapshot, types::Sonar& ping) {
    for (Stage& stage : parts_->stages) stage.seconds = 0;
    parts_->fillHeader(snapshot, ping);
    parts_->echoes->render(snapshot, ping, parts_->stages);
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
const RenderPlan& SonarRenderer::renderPlan() const { return parts_->plan; }
Features SonarRenderer::compiled() const { return parts_->echoes->compiled(); }
const types::Plan& SonarRenderer::plan() const { return parts_->told; }
const std::string& SonarRenderer::device() const { return parts_->echoes->device(); }

}  // namespace insonify::sonar
