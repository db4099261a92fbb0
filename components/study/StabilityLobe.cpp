// Specular lobes at the ends of what they may be.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"

namespace insonify::study {
namespace {

/** A material that gives back what it mirrors, and next to nothing else. */
void makeMirror(types::Material& material, float reflection, float slope) {
    material.lambert_db = -200;
    material.reflection = reflection;
    material.roughness_slope = slope;
}

/** All of a plane mirror's echo is that of the sonar's image, at twice the distance: R^2 / (2 D)^2. */
Outcome mirrorAhead() {
    const auto geometry = copyOf(sceneOf({facingWall(10)}));
    makeMirror(geometry->materials[0], 0.5f, 0);
    sonar::SonarConfig config = fan(20, 20, 1, 15);
    config.frequency_khz = 750;
    double worst = 0;
    Probe heard;
    for (int rows : {16, 64, 256, 2048}) {
        setSamples(config, rows, rows);
        heard = probe(config, lookingAt(geometry));
        worst = std::max(worst, std::abs(10 * std::log10(heard.energy() * 1600)));
    }
    return within(1, worst, "levels in dB off the image's with 16 to 2048 rows and as many columns", heard);
}

/** A plate whose lobe is +60 dB at its peak, over a bottom of -80 dB. */
Outcome glintBesideBottom() {
    constexpr double ahead = 8.05;  // [m]
    const auto geometry = copyOf(sceneOf({levelGround(-5), quad({ahead, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[0].lambert_db = -80;
    makeMirror(geometry->materials[1], 1, 2.82e-4f);  // 1 / (4 pi s^2) is 1e6
    geometry->meshes[1].clusters[0].material = 1;
    sonar::SonarConfig config = fan(40, 40, 1, 16);
    setSamples(config, 512, 512);
    const Probe heard = probe(config, lookingAt(geometry));
    const auto sumOf = [&](size_t first, size_t last) {
        double sum = 0;
        for (size_t k = first; k < last; ++k) sum += heard.ping.bins[k];
        return sum;
    };
    const double glint = std::abs(10 * std::log10(sumOf(80, 84) * 4 * ahead * ahead));
    const double below = off(sumOf(148, 160), 1e-8 * trueEnergy(config, 0, planeTruth({0, 0, -1}, 5), 14.8, 16));
    return within(0.01, std::max(glint / 100, below),
                  fmt::format("glint off by {:.2g} dB, the bottom from 14.8 to 16 m by {:.1e}", glint, below), heard);
}

}  // namespace

std::vector<StabilityCase> lobeCases() {
    return {{38, "Specular lobe of a mirror", "finite; level independent of resolution to 1 dB", mirrorAhead},
            {39, "+60 dB glint beside a bottom of -80 dB", "glint to 1 dB, bottom to 1 %", glintBesideBottom}};
}

}  // namespace insonify::study
