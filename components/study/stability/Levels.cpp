// Dynamic range: absorption and gain of a thousand decibels, loud and silent materials, specular lobes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/receiver/Receiver.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

constexpr double far_wall = 98.6993;  ///< [m]

/** Renders a wall ahead at 2 MHz. */
Probe twoMegahertzOn(SonarConfig& config, double wall, int bins) {
    config.bin_count = bins;
    config.range_rounding = sonar::RangeRounding::Exact;
    config.water = {.temperature_celsius = 10, .salinity_psu = 35, .depth = 10, .ph = 8.1};
    config.absorption.emplace().frequency_khz = 2000;
    setSamples(config, 1024, 64);
    return probe(config, lookingAt(makeScene({facingWall(0)}, {{wall, 0, 0}})));
}

/** Returns a ping after a receiver. */
types::Sonar received(receiver::Receiver receiver, const types::Sonar& intensities) {
    types::Sonar ping;
    receiver.receive(intensities, ping);
    return ping;
}

receiver::ReceiverConfig inLevels() {
    receiver::ReceiverConfig config;
    config.output = receiver::Output::LevelDb;
    return config;
}

/** Returns the level of the wall in a bin in double precision, its absorption integrated in slices; -3000 dB for no
 *  echo. */
double trueLevel(const SonarConfig& config, const Truth& truth, int bin) {
    constexpr int slices = 50;
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const double beta = sonar::makeAbsorption(config).intensityPerMetre();
    double energy = 0;  // relative to the absorption at the wall
    for (int i = 0; i < slices; ++i) {
        const double low = grid.edge(bin) + i * grid.bin_width / slices, high = low + grid.bin_width / slices;
        if (high <= far_wall) continue;
        energy += trueEnergy(config, 0, truth, low, high) *
                  std::exp(-beta * (0.5 * (std::max(low, far_wall) + high) - far_wall));
    }
    return energy > 0 ? 10 * std::log10(energy) - 10 * beta * far_wall / std::numbers::ln10 : -3000;
}

Outcome twoMegahertz(int bins, bool in_coarse_bins) {
    SonarConfig config = fan(1, 2, 1, 105);
    const Probe echoes = twoMegahertzOn(config, far_wall, bins);
    const types::Sonar levels = received(receiver::Receiver(inLevels()), echoes.ping);
    const Truth truth = planeTruth({1, 0, 0}, far_wall);
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const int first = static_cast<int>(far_wall / grid.bin_width),
              last = std::min(bins, first + 1 + static_cast<int>(1.25e-4 * far_wall / grid.bin_width));
    double worst = 0, lowest = 0;
    for (int bin = first; bin < last; ++bin) {
        const double level = trueLevel(config, truth, bin);
        lowest = std::min(lowest, level);
        worst = std::max(worst, std::abs(levels.bins[static_cast<size_t>(bin)] - level));
    }
    const double bound = in_coarse_bins ? sonar::makeAbsorption(config).db_per_m * grid.bin_width : 0.01;
    const bool reported = !in_coarse_bins || std::ranges::count(echoes.plan.notices, types::Notice::Kind::Warning,
                                                                &types::Notice::kind) > 0;
    return {echoes.conditions,
            fmt::format("levels down to {:.1f} dB in bins of {:.3g} m, off by {:.2g} dB; may be {:.2g}{}", lowest,
                        grid.bin_width, worst, bound, in_coarse_bins && reported ? ", as the plan warns" : ""),
            worst, echoes.isSound() && reported && worst <= bound ? Verdict::Pass : Verdict::Fail};
}

Outcome gain(double gain_db, double bound) {
    receiver::ReceiverConfig config;
    config.tvg = {.log_coefficient = 1000, .db_per_m = 1000, .max_db = gain_db};
    const Probe echoes = probe(fan(60, 40, 8, 20), lookingAt(makeScene({levelGround(-5)})));
    receiver::Receiver receiver(config);
    types::Sonar ping;
    receiver.receive(echoes.ping, ping);
    const double factor = std::pow(10, gain_db / 10), ceiling = static_cast<double>(std::numeric_limits<float>::max());
    double worst = 0;
    for (size_t i = 0; i < ping.bins.size(); ++i)
        worst = std::max(
            worst, off(ping.bins[i], std::min(echoes.ping.bins[i] * factor, echoes.ping.bins[i] > 0 ? ceiling : 0)));
    return within(
        bound, receiver.notices().empty() ? INFINITY : worst,
        fmt::format("a gain of {} dB: clamped there, and reported; intensities at most the max float", gain_db),
        echoes);
}

Outcome weakAbsorption() {
    const auto scene = lookingAt(makeScene({levelGround(-5)}));
    SonarConfig config = fan(60, 40, 8, 50);
    const Probe plain = probe(config, scene);
    config.absorption.emplace().db_per_m = 0;
    const double zero = difference(probe(config, scene).ping, plain.ping);
    config.absorption->db_per_m = 1e-12;
    const double tiny = difference(probe(config, scene).ping, plain.ping);
    config.absorption->db_per_m = 1e-4;
    const Probe echoes = probe(config, scene);
    double weak = 0;
    for (size_t i = 0; i < echoes.ping.bins.size(); ++i) {
        const double r = echoes.ping.binStart(static_cast<double>(i % echoes.ping.bin_count) + 0.5);
        weak = std::max(weak, off(echoes.ping.bins[i], plain.ping.bins[i] * std::pow(10, -2e-4 * r / 10)));
    }
    return within(
        1e-6, zero > 0 ? INFINITY : std::max(tiny, weak),
        fmt::format("0: bit-identical to none; 1e-12 dB/m off by {:.1e}; 1e-4 dB/m off by {:.1e}", tiny, weak), echoes);
}

/** Renders a plate of a material in front of a wall. */
Probe plateBeforeWall(const SonarConfig& config, float lambert_db, float reflectivity) {
    const auto geometry = makeCopy(makeScene({facingWall(10), facingWall(5.05f, 20)}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[1].lambert_db = lambert_db;
    geometry->materials[1].reflectivity = reflectivity;
    geometry->meshes[1].clusters[0].material = 1;
    return probe(config, lookingAt(geometry));
}

Outcome silentSurfaces() {
    SonarConfig config = fan(20, 20, 4, 15);
    const Probe physical = plateBeforeWall(config, -1000, 1);
    config.model = sonar::Model::Cerqueira2017;
    const Probe published = plateBeforeWall(config, 0, 0);
    double worst = physical.energy();
    for (uint32_t beam = 0; beam < 4; ++beam)
        for (uint32_t k = 0; k < 150; ++k) {
            const float bin = published.ping.bins[beam * 150 + k];
            if (k == 50)
                worst = std::max(worst, off(bin, 6.144174e-6));
            else if (k > 55)
                worst = std::max(worst, double{bin});
        }
    return within(1e-4, worst, "no echo in physical, S(0) = 6.1e-6 in cerqueira2017; the wall behind has no echo",
                  published);
}

Outcome fullReflectivity() {
    SonarConfig config = fan(2, 2, 1, 15);
    config.model = sonar::Model::Cerqueira2017;
    const Probe echoes = plateBeforeWall(config, 0, 1);
    return within(1e-4, off(echoes.ping.bins[50], 0.99753), "S(1) of a surface square to the beam", echoes);
}

constexpr double plate_at = 8.05;  ///< [m]

/** Returns a bottom of -80 dB, and in front of it a plate of 2 x 2 m of +20 dB, the loudest that a file may have. */
std::shared_ptr<types::Geometry> plateOverBottom() {
    const auto geometry = makeCopy(makeScene({levelGround(-5), quad({plate_at, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[0].lambert_db = -80;
    geometry->materials[1].lambert_db = 20;
    geometry->meshes[1].clusters[0].material = 1;
    return geometry;
}

/** Returns the echo of the plate: ACOUSTICS.md 9.5, the wide window. */
double plateEnergy() {
    constexpr int cells = 200;
    double sum = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const double u = ((i + 0.5) / cells * 2 - 1) / plate_at, v = ((j + 0.5) / cells * 2 - 1) / plate_at;
            sum += std::pow(1 + u * u + v * v, -3);
        }
    return 100 * sum * 4 / (cells * cells) / std::pow(plate_at, 4);
}

double sumEnergy(const Probe& echoes, uint32_t first, uint32_t last) {
    double sum = 0;
    for (uint32_t k = first; k < last; ++k) sum += echoes.ping.bins[k];
    return sum;
}

Outcome plateNextToBottom() {
    SonarConfig config = fan(40, 40, 1, 16);
    setSamples(config, 512, 512);  // the plate ends within a cell
    const Probe echoes = probe(config, lookingAt(plateOverBottom()));
    // The bottom from the aperture's edge on is visible below the plate, except where the plate hides it.
    const Truth bottom = planeTruth({0, 0, -1}, 5);
    const double plate = off(sumEnergy(echoes, 80, 84), plateEnergy());
    const double below = off(sumEnergy(echoes, 148, 160), 1e-8 * trueEnergy(config, 0, bottom, 14.8, 16));
    return within(0.01, std::max(plate, below),
                  fmt::format("plate off by {:.1e}, the bottom from 14.8 to 16 m by {:.1e}", plate, below), echoes);
}

/** Makes a material that returns what it mirrors, and almost nothing else. */
void makeMirror(types::Material& material, float reflection, float slope) {
    material.lambert_db = -200;
    material.reflection = reflection;
    material.roughness_slope = slope;
}

/** A plane mirror's echo is that of the sonar's image, at twice the distance: R^2 / (2 D)^2. */
Outcome mirrorAhead() {
    const auto geometry = makeCopy(makeScene({facingWall(10)}));
    makeMirror(geometry->materials[0], 0.5f, 0);
    sonar::SonarConfig config = fan(20, 20, 1, 15);
    config.frequency_khz = 750;
    double worst = 0;
    Probe echoes;
    for (int rows : {16, 64, 256, 2048}) {
        setSamples(config, rows, rows);
        echoes = probe(config, lookingAt(geometry));
        worst = std::max(worst, std::abs(10 * std::log10(echoes.energy() * 1600)));
    }
    return within(1, worst, "levels in dB off the image's with 16 to 2048 rows and columns", echoes);
}

/** Tests a plate whose lobe is +60 dB at its peak, over a bottom of -80 dB. */
Outcome glintNextToBottom() {
    constexpr double ahead = 8.05;  // [m]
    const auto geometry = makeCopy(makeScene({levelGround(-5), quad({ahead, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[0].lambert_db = -80;
    makeMirror(geometry->materials[1], 1, 2.82e-4f);  // 1 / (4 pi s^2) is 1e6
    geometry->meshes[1].clusters[0].material = 1;
    sonar::SonarConfig config = fan(40, 40, 1, 16);
    setSamples(config, 512, 512);
    const Probe echoes = probe(config, lookingAt(geometry));
    const auto computeSum = [&](size_t first, size_t last) {
        double sum = 0;
        for (size_t k = first; k < last; ++k) sum += echoes.ping.bins[k];
        return sum;
    };
    const double glint = std::abs(10 * std::log10(computeSum(80, 84) * 4 * ahead * ahead));
    const double below = off(computeSum(148, 160), 1e-8 * trueEnergy(config, 0, planeTruth({0, 0, -1}, 5), 14.8, 16));
    return within(0.01, std::max(glint / 100, below),
                  fmt::format("glint off by {:.2g} dB, the bottom from 14.8 to 16 m by {:.1e}", glint, below), echoes);
}

}  // namespace

std::vector<StabilityCase> levelCases() {
    return {{32, "2 MHz at 99 m", "level_db to 0.01 dB of double precision at -350 dB",
             [] { return twoMegahertz(65536, false); }},
            {32, "2 MHz at 99 m in wide bins", "to the absorption of half a bin, and the plan warns",
             [] { return twoMegahertz(262, true); }},
            {33, "TVG gain of 1e20", "clamped and reported; to 1e-6", [] { return gain(200, 1e-6); }},
            {33, "TVG gain of 1e100", "finite: clamped at the max float", [] { return gain(1000, 1e-6); }},
            {35, "No and hardly any absorption", "continuous, to 1e-6", weakAbsorption},
            {36, "Reflectivity of 0", "no echo, but a shadow", silentSurfaces},
            {38, "Specular lobe of a mirror", "finite; level independent of resolution to 1 dB", mirrorAhead},
            {39, "+20 dB plate next to a bottom of -80 dB", "both to 1 %", plateNextToBottom},
            {39, "+60 dB glint next to a bottom of -80 dB", "glint to 1 dB, bottom to 1 %", glintNextToBottom},
            {40, "Sigmoid at both ends", "S(1) = 0.99753 (S(0): case 36)", fullReflectivity}};
}

}  // namespace insonify::study
