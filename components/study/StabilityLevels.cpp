// Dynamic range: absorption and gain of a thousand decibels, loud and silent materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

bool tells(const types::Plan& plan, const std::string& words) {
    return std::ranges::any_of(plan.notices, [&](const std::string& notice) { return notice.find(words) != std::string::npos; });
}

/** `output: level_db` at 2 MHz, against the closed form with absorption inside the bins, which it takes in slices. */
Outcome twoMegahertz() {
    SonarConfig config = fan(4, 10, 2, 420);
    config.bin_count = 1050;
    config.output = sonar::Output::LevelDb;
    config.water = {.temperature_celsius = 10, .salinity_psu = 35, .depth = 10, .ph = 8.1};
    config.absorption.emplace().frequency_khz = 2000;
    const double distance = 398.7, beta = sonar::makeAbsorption(config).intensityPerMetre();
    const Truth truth = planeTruth({1, 0, 0}, distance);
    const Probe heard = probe(config, lookingAt(copyOf(sceneOf({facingWall(0)}, {{distance, 0, 0}}))));
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    double worst = 0, lowest = 0;
    for (int bin = 0; bin < grid.bin_count; ++bin) {
        constexpr int slices = 200;
        double energy = 0, at = 0;
        for (int i = 0; i < slices; ++i) {
            const double low = grid.edge(bin) + i * grid.bin_width / slices, high = low + grid.bin_width / slices;
            const double part = high <= distance ? 0 : truth({-0.0349065850398866, 0, 0.0872664625997165}, low, high);
            at = grid.edge(bin) + grid.bin_width / 2;
            energy += part * std::exp(-beta * (0.5 * (std::max(low, distance) + high) - at));
        }
        const double got = heard.ping.bins[static_cast<size_t>(bin)];
        const double level = energy > 0 ? 10 * std::log10(energy) - 10 * beta * at / std::numbers::ln10 : -3000;
        if (energy > 1e-12) lowest = std::min(lowest, level);
        if (energy > 1e-12 || energy == 0) worst = std::max(worst, std::abs(got - level));
    }
    const bool finite = std::ranges::all_of(heard.ping.bins, [](float bin) { return std::isfinite(bin); });
    return {heard.conditions, fmt::format("levels down to {:.1f} dB; deviation in dB", lowest), worst, finite && worst <= 0.01 ? Verdict::Pass : Verdict::Fail};
}

Outcome gainOf(double gain_db, double tolerance) {
    SonarConfig plain = fan(60, 40, 8, 20), loud = plain;
    loud.tvg = {.log_coefficient = 1000, .db_per_m = 1000, .max_db = gain_db};
    const auto scene = lookingAt(sceneOf({levelGround(-5)}));
    const Probe heard = probe(loud, scene), quiet = probe(plain, scene);
    const double factor = std::pow(10, gain_db / 10), ceiling = static_cast<double>(std::numeric_limits<float>::max());
    double worst = 0;
    for (size_t i = 0; i < heard.ping.bins.size(); ++i)
        worst = std::max(worst, off(heard.ping.bins[i], std::min(quiet.ping.bins[i] * factor, quiet.ping.bins[i] > 0 ? ceiling : 0)));
    return within(tolerance, tells(heard.plan, "reaches its max_db") ? worst : INFINITY, fmt::format("a gain of {} dB: clamped there, told in the plan; intensities at most the largest float", gain_db), heard);
}

Outcome silence() {
    SonarConfig config = fan(60, 40, 8, 20);
    config.output = sonar::Output::LevelDb;
    config.tvg = {.log_coefficient = 50, .db_per_m = 1, .max_db = 100};
    const Probe heard = probe(config, lookingAt(std::make_shared<types::Geometry>()));
    const double deviation = std::ranges::count_if(heard.ping.bins, [](float bin) { return bin != -3000.0f; });
    return none(deviation, "level_db of no echo is -3000 dB in every bin", heard.conditions);
}

Outcome weakAbsorption() {
    const auto scene = lookingAt(sceneOf({levelGround(-5)}));
    SonarConfig config = fan(60, 40, 8, 50);
    const Probe plain = probe(config, scene);
    config.absorption.emplace().db_per_m = 0;
    const double zero = difference(probe(config, scene).ping, plain.ping);
    config.absorption->db_per_m = 1e-12;
    const double tiny = difference(probe(config, scene).ping, plain.ping);
    config.absorption->db_per_m = 1e-4;
    const Probe heard = probe(config, scene);
    double weak = 0;
    for (size_t i = 0; i < heard.ping.bins.size(); ++i) {
        const double r = heard.ping.binStart(static_cast<double>(i % heard.ping.bin_count) + 0.5);
        weak = std::max(weak, off(heard.ping.bins[i], plain.ping.bins[i] * std::pow(10, -2e-4 * r / 10)));
    }
    return within(1e-6, zero > 0 ? INFINITY : std::max(tiny, weak), fmt::format("0: bit-identical to none; 1e-12 dB/m off by {:.1e}; 1e-4 dB/m off by {:.1e}", tiny, weak), heard);
}

/** A plate of a material before a wall. */
Probe plateBeforeWall(const SonarConfig& config, float lambert_db, float reflectivity) {
    const auto geometry = copyOf(sceneOf({facingWall(10), facingWall(5.05f, 20)}));
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
            if (k == 50) worst = std::max(worst, off(bin, 6.144174e-6));
            else if (k > 55) worst = std::max(worst, double{bin});
        }
    return within(1e-4, worst, "no echo in physical, S(0) = 6.1e-6 in cerqueira2017; the wall behind is not heard", published);
}

Outcome fullReflectivity() {
    SonarConfig config = fan(2, 2, 1, 15);
    config.model = sonar::Model::Cerqueira2017;
    const Probe heard = plateBeforeWall(config, 0, 1);
    return within(1e-4, off(heard.ping.bins[50], 0.99753), "S(1) of a surface square to the beam", heard);
}

Outcome energyCreating() {
    const Probe heard = plateBeforeWall(fan(20, 20, 4, 15), -4.9f, 1);
    return none(!tells(heard.plan, "gives back more than it gets"), "lambert_db of -4.9: a warning in the plan", heard.conditions);
}

/** A plate 60 dB louder than 1 beside a bottom of -80 dB. */
Outcome glintBesideBottom() {
    const SonarConfig config = fan(40, 40, 1, 20);
    const auto geometry = copyOf(sceneOf({levelGround(-5), quad({8.05f, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[0].lambert_db = -80;
    geometry->materials[1].lambert_db = 60;
    geometry->meshes[1].clusters[0].material = 1;
    const Probe heard = probe(config, lookingAt(geometry));
    double glint = 0, truth = 0, bottom = 0;
    for (int i = 0; i < 1000; ++i)
        for (int j = 0; j < 1000; ++j) {
            const double u = ((i + 0.5) / 500 - 1) / 8.05, v = ((j + 0.5) / 500 - 1) / 8.05;
            truth += std::pow(1 + u * u + v * v, -3) * 4e-6 / std::pow(8.05, 4) * 1e6;
        }
    for (uint32_t k = 80; k < 84; ++k) glint += heard.ping.bins[k];
    double expected = 0;
    for (uint32_t k = 165; k < 200; ++k) {  // beyond what the plate hides
        bottom += heard.ping.bins[k];
        expected += 1e-8 * planeTruth({0, 0, -1}, 5)({-0.349065850398866, 0.349065850398866, 0.349065850398866}, 0.1 * k, 0.1 * (k + 1));
    }
    const Probe alone = probe(config, lookingAt(copyOf([&] {
        auto only = copyOf(geometry);
        only->objects.pop_back();
        return only;
    }())));
    double unhidden = 0;
    for (uint32_t k = 165; k < 200; ++k) unhidden += alone.ping.bins[k];
    const double loud = off(glint, truth), quiet = off(unhidden, expected);
    const double kept = bottom / unhidden;
    return within(0.01, std::max(loud, quiet), fmt::format("plate off by {:.1e}, bottom alone by {:.1e}, {:.0f} % of it heard beside the plate", loud, quiet, 100 * kept), heard);
}

}  // namespace

std::vector<StabilityCase> levelCases() {
    return {{32, "2 MHz at 400 m", "level_db to 0.01 dB of double precision at -1000 dB", twoMegahertz},
            {33, "TVG gain of 1e20", "clamped and reported; to 1e-6", [] { return gainOf(200, 1e-6); }},
            {33, "TVG gain of 1e100", "finite: clamped at the largest float", [] { return gainOf(1000, 1e-6); }},
            {34, "log10 of 0 in decibels", "a floor of -3000 dB, never -inf or NaN", silence},
            {35, "No and hardly any absorption", "continuous, to 1e-6", weakAbsorption},
            {36, "Reflectivity of 0", "no echo, but a shadow", silentSurfaces},
            {37, "Lambert parameter above 1/pi", "a warning: it creates energy", energyCreating},
            {39, "+60 dB glint beside a bottom of -80 dB", "both to 1 %", glintBesideBottom},
            {40, "Sigmoid at both ends", "S(1) = 0.99753 (S(0): case 36)", fullReflectivity}};
}

}  // namespace insonify::study
