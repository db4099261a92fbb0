#include "components/sonar/SonarRenderer.hpp"

#include <algorithm>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/CastEchoes.hpp"
#include "components/sonar/DrawnEchoes.hpp"
#include "components/sonar/Plan.hpp"

namespace insonify::sonar {

struct SonarRenderer::Parts {
    Parts(const SonarConfig& sonar, types::GeometryPtr scene);
    ~Parts();
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;

    SonarConfig config;
    types::Plan plan;
    std::vector<Beam> beams;
    BinGrid bins;
    Stages stages{{{"cull", 0}, {"draw", 0}, {"read", 0}, {"deposit", 0}, {"beams", 0}}};
    bool drawn;
    std::unique_ptr<EchoRenderer> echoes;
};

SonarRenderer::Parts::Parts(const SonarConfig& sonar, types::GeometryPtr scene)
    : config(sonar), plan(makePlan(config, *scene)), beams(makeBeams(config)), bins(makeBinGrid(config)) {
    drawn = !config.castsRays();
    if (drawn) {
        const auto alone = gpu::EglContext::making();
        echoes = makeDrawnEchoes(config, std::move(scene), plan);
    } else {
        echoes = makeCastEchoes(config, std::move(scene));
    }
    plan.device = echoes->device();
    if (const std::string notice = echoes->notice(); !notice.empty()) plan.notices.push_back(notice);
}

SonarRenderer::Parts::~Parts() {
    if (!drawn) return;
    const auto alone = gpu::EglContext::making();
    echoes.reset();
}

void SonarRenderer::Parts::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    ping.time = snapshot.time;
    ping.timestamps.clear();
    ping.bin_duration.microseconds = bins.bin_duration_us;
    ping.beam_width = types::Angle::fromDeg(config.beamWidthDeg());
    ping.beam_height = types::Angle::fromDeg(config.beam_height_deg);
    ping.bearings.resize(beams.size());
    for (size_t k = 0; k < beams.size(); ++k) ping.bearings[k] = types::Angle::fromRad(beams[k].centre);
    ping.speed_of_sound = static_cast<float>(bins.speed_of_sound);
    ping.bin_count = static_cast<uint32_t>(bins.bin_count);
    ping.beam_count = static_cast<uint32_t>(beams.size());
    ping.bins.resize(beams.size() * static_cast<size_t>(bins.bin_count));
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
    parts_->echoes->setQuality(rows, columns_per_beam);
    parts_->config.quality.rows = parts_->plan.rows = rows;
    parts_->config.quality.columns_per_beam = parts_->plan.columns_per_beam = columns_per_beam;
}

std::span<const Stage> SonarRenderer::stages() const { return parts_->stages; }
bool SonarRenderer::heard() const { return parts_->echoes->heard(); }
std::vector<types::Omission> SonarRenderer::culled() const { return parts_->echoes->culled(); }
const types::Plan& SonarRenderer::plan() const { return parts_->plan; }
const std::string& SonarRenderer::device() const { return parts_->echoes->device(); }

}  // namespace insonify::sonar
