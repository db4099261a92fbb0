#include "components/sonar/tasks/AltimeterTask.hpp"

#include "components/sonar/renderer/SonarRenderer.hpp"

namespace insonify::sonar {
namespace {

constexpr int near_samples = 16;  ///< Of the beam, in each direction, in the search for surfaces that are too near.

}  // namespace

SonarConfig AltimeterConfig::beam() const {
    SonarConfig one = sonar;
    one.bearings_deg = {0};
    return one;
}

bool AltimeterTask::isTooNear() {
    if (!(config->sonar.range_min > 0)) return false;
    const types::Snapshot& scene = takenScene();
    if (near_) {
        near_->setGeometry(scene.geometry);
    } else {
        SonarConfig near;
        near.bearings_deg = {0};
        near.beam_width_deg = config->beam().beamWidthDeg();
        near.beam_height_deg = config->sonar.beam_height_deg;
        near.beam_geometry = config->sonar.beam_geometry;
        near.range = config->sonar.range_min;
        near.range_min = 0;
        near.range_rounding = RangeRounding::Exact;
        near.bin_count = 1;
        near.quality.rows = near.quality.columns_per_beam = near_samples;
        near.visibility = Visibility::Cpu;  // beside a renderer that may rasterise
        near_ = std::make_unique<SonarRenderer>(near, scene.geometry, RenderOptions{.threads = 1});
    }
    near_->render(scene, near_ping_);
    return near_->hasEchoes();
}

void AltimeterTask::cleanupHook() {
    near_.reset();
    PingTask::cleanupHook();
}

bool AltimeterTask::configureHook() {
    near_.reset();
    return PingTask::configureHook();
}

void AltimeterTask::writeMore(const types::Sonar& sample, const types::Pose& /*sonar*/) {
    if (!range.connected()) return;
    types::Range reported;
    reported.time = sample.time;
    detector_.take(sample, config->detection, detectionRules());
    if (const auto found = detector_.first(0))
        reported.range = found->range;
    else if (isTooNear())
        reported.range = types::Range::too_near;
    reported.range_min = config->sonar.range_min;
    reported.range_max = sample.binWidth() * sample.bin_count;
    reported.field_of_view = sample.beam_width;
    range.write(reported);
}

}  // namespace insonify::sonar
