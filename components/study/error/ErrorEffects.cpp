#include "components/study/error/ErrorEffects.hpp"

#include <algorithm>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/study/Probe.hpp"

namespace insonify::study {
namespace {

constexpr double frequency_khz = 100;  ///< The max frequency of TR 9407.

acoustics::BeamLaw beamOf(acoustics::Weighting weighting, double width_deg) {
    acoustics::BeamLaw law;
    law.weighting = weighting;
    law.width_deg = width_deg;
    return law;
}

void addPattern(sonar::SonarConfig& config) {
    const double fan_deg = config.fieldOfViewDeg(), beam_deg = fan_deg / config.beam_count;
    sonar::BeamPatternConfig& pattern = config.beam_pattern.emplace();
    pattern.transmit.azimuth = beamOf(acoustics::Weighting::Gaussian, std::min(1.08 * fan_deg, 180.0));
    pattern.transmit.elevation = beamOf(acoustics::Weighting::Uniform, config.beam_height_deg);
    pattern.receive.azimuth = beamOf(acoustics::Weighting::Taylor, 4 * beam_deg);
    pattern.receive.azimuth->sidelobe_db = -25;
    pattern.receive.elevation = beamOf(acoustics::Weighting::Uniform, 1.25 * config.beam_height_deg);
}

void addPulse(sonar::SonarConfig& config) {
    acoustics::PulseConfig& pulse = config.pulse.emplace();
    pulse.bandwidth_khz = 1e-3 * config.speedOfSound() / (2 * 0.6 * sonar::makeBinGrid(config).bin_width);
    pulse.window = acoustics::PulseWindow::Hann;
}

void addSeabed(StudyScene& scene) {
    scene.config.frequency_khz = frequency_khz;
    const auto geometry = copyOf(scene.snapshot.geometry);
    if (std::ranges::all_of(geometry->materials, [](const types::Material& m) { return m.seabed.empty(); }))
        for (types::Material& material : geometry->materials) material.seabed = "medium_sand";
    scene.snapshot.geometry = geometry;
}

}  // namespace

StudyScene withEffect(const StudyScene& plain, Effect effect) {
    StudyScene scene = plain;
    scene.truth = nullptr;
    switch (effect) {
        case Effect::PatternAndPulse:
            scene.name += "_pattern_and_pulse";
            addPattern(scene.config);
            addPulse(scene.config);
            break;
        case Effect::Seabed:
            scene.name += "_seabed";
            addSeabed(scene);
            break;
        case Effect::Volume:
            scene.name += "_volume";
            scene.config.volume = {{{}, {}, -50}};
            break;
        case Effect::Multipath:
            scene.name += "_multipath";
            scene.config.multipath.emplace().surface.emplace();
            if (!scene.snapshot.water_surface) scene.snapshot.water_surface = scene.snapshot.sonar.position.z + 3;
            break;
        case Effect::Coherent:
            scene.name += "_coherent";
            scene.config.frequency_khz = frequency_khz;
            scene.config.speckle.emplace().coherent = true;
            break;
    }
    return scene;
}

}  // namespace insonify::study
