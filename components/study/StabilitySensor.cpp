// Fans, beams and apertures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

/** A room of 20 x 30 m, its bottom 4 m below the sonar, which stands off its middle. No wall stands at the edge of a
 *  bin, where the last digit of its distance decides in which bin it is heard. */
types::GeometryPtr room() {
    return sceneOf({levelGround(-4, 100), quad({12.03f, -14.03f, -4}, {0, 30, 0}, {0, 0, 20}),
                    quad({-7.97f, -14.03f, -4}, {0, 30, 0}, {0, 0, 20}),
                    quad({-7.97f, 15.97f, -4}, {20, 0, 0}, {0, 0, 20}),
                    quad({-7.97f, -14.03f, -4}, {20, 0, 0}, {0, 0, 20})});
}

/** Relative L2 between beam `a` of one ping and beam `b` of another. */
double beamDifference(const types::Sonar& one, uint32_t a, const types::Sonar& other, uint32_t b) {
    double error = 0, norm = 0;
    for (uint32_t k = 0; k < one.bin_count; ++k) {
        const double x = one.bins[size_t{a} * one.bin_count + k], y = other.bins[size_t{b} * other.bin_count + k];
        error += (x - y) * (x - y);
        norm += y * y;
    }
    return std::sqrt(error / norm);
}

/** Beams of a wide fan against those of a sonar of ten that looks the same way. */
Outcome wideFan(double fov_deg) {
    const int beams = 360;
    const double width = fov_deg / beams;
    sonar::SonarConfig wide = fan(fov_deg, 40, beams, 25), narrow = fan(10 * width, 40, 10, 25);
    setSamples(wide, 2048, 4);
    setSamples(narrow, 2048, 4);
    const Probe all = probe(wide, lookingAt(room()));
    double worst = 0;
    for (const int first : {0, 40, 100, 175, 250, 310, 350}) {  // none has a corner of the room
        const double bearing = -fov_deg / 2 + (first + 5) * width;
        const Probe few = probe(narrow, lookingAt(room(), {}, radians(bearing)));
        for (uint32_t k = 0; k < 10; ++k)
            worst = std::max(worst, beamDifference(all.ping, static_cast<uint32_t>(first) + k, few.ping, k));
    }
    return within(1e-3, worst, fmt::format("70 beams of {} in {} slabs, bin by bin", beams, all.plan.slabs), all);
}

Outcome seams(double fov_deg) {
    sonar::SonarConfig config = fan(fov_deg, 40, 360, 50);
    setSamples(config, 512);
    const Probe heard = probe(config, lookingAt(sceneOf({levelGround(-5)})));
    double worst = 0;
    for (uint32_t k = 0; k < 360; ++k)
        worst = std::max(worst, beamDifference(heard.ping, k, heard.ping, (k + 1) % 360));
    return within(
        1e-3, worst,
        fmt::format("neighbouring beams over level ground in {} slabs, the last beside the first", heard.plan.slabs),
        heard);
}

/** A fan of `beams` before a wall. */
Outcome beamsBeforeAWall(int beams, double fov_deg) {
    sonar::SonarConfig config = fan(fov_deg, 20, beams, 25);
    setSamples(config, 64, std::max(2, 64 / beams));
    const Probe heard = probe(config, lookingAt(sceneOf({facingWall(10)})));
    return within(1e-3, worstBeam(heard, config, planeTruth({1, 0, 0}, 10)),
                  fmt::format("worst of {} beams against the closed form", beams), heard);
}

Outcome moreBeamsThanColumns() {
    sonar::SonarConfig config = fan(1, 20, 1, 15);
    config.bearings_deg.resize(1000);
    for (size_t k = 0; k < 1000; ++k) config.bearings_deg[k] = 0.01 * (static_cast<double>(k) - 500);
    config.beam_width_deg = 1;
    setSamples(config, 256, 1);
    const Probe heard = probe(config, lookingAt(sceneOf({facingWall(10)})));
    return within(1e-3, worstBeam(heard, config, planeTruth({1, 0, 0}, 10)),
                  "1000 beams 1 deg wide and 0.01 deg apart, one column per beam's width: none empty", heard);
}

Outcome thinAperture() {
    const sonar::SonarConfig config = fan(20, 0.01, 20, 15);
    const Probe heard = probe(config, lookingAt(sceneOf({facingWall(10)})));
    return within(1e-3, worstBeam(heard, config, planeTruth({1, 0, 0}, 10)), "0.01 deg on a wall", heard);
}

Outcome oneRow() {
    sonar::SonarConfig config = fan(20, 10, 20, 15);
    setSamples(config, 1, 1);
    const Probe heard = probe(config, lookingAt(sceneOf({facingWall(10)})));
    return within(0.01, worstBeam(heard, config, planeTruth({1, 0, 0}, 10)),
                  "10 deg on a wall by one row and one column per beam", heard);
}

}  // namespace

std::vector<StabilityCase> sensorCases() {
    std::vector<StabilityCase> cases;
    for (const double fov : {179.0, 180.0, 359.9, 360.0})
        cases.push_back({21, fmt::format("Fan of {} deg", fov), "each beam as in a sonar of ten beams, to 1e-3",
                         [fov] { return wideFan(fov); }});
    for (const double fov : {180.0, 360.0})
        cases.push_back(
            {21, fmt::format("Seams of a fan of {} deg", fov), "none above 1e-3", [fov] { return seams(fov); }});
    cases.insert(
        cases.end(),
        {{23, "One beam", "to 1e-3 of the closed form", [] { return beamsBeforeAWall(1, 20); }},
         {23, "4096 beams", "to 1e-3 of the closed form", [] { return beamsBeforeAWall(4096, 120); }},
         {23, "More beams than columns", "no beam empty: each to 1e-3 of the closed form", moreBeamsThanColumns},
         {30, "Vertical aperture of 0.01 deg", "to 1e-3 of the closed form", thinAperture},
         {30, "One image row", "to 1 % of the closed form", oneRow}});
    return cases;
}

}  // namespace insonify::study
