// Beam patterns and pulses at the ends of what they may be.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

/** A Gaussian beam, which has no sidelobes: its integral over azimuth is known. */
Outcome narrowBeam(double width_deg) {
    sonar::SonarConfig config = fan(40, 40, 4, 25);
    setSamples(config, 512, 1);
    acoustics::BeamLaw& law = config.beam_pattern.emplace().receive.azimuth.emplace();
    law.weighting = acoustics::Weighting::Gaussian;
    law.width_deg = width_deg;
    const Probe heard = probe(config, lookingAt(sceneOf({levelGround(-5)})));
    const double integral = radians(width_deg) / 2 * std::sqrt(std::numbers::pi / std::numbers::ln2);
    const double truth = planeTruth({0, 0, -1}, 5)({-integral / 2, integral / 2, radians(20)}, 0, 25);
    double worst = 0;
    for (uint32_t beam = 0; beam < 4; ++beam) worst = std::max(worst, off(heard.energy(beam), truth));
    return within(0.01, worst, fmt::format("beams of {:g} deg every 10 deg, one column each, over a bottom", width_deg),
                  heard);
}

types::Sonar pulsed(double bins_long, bool whole) {
    sonar::SonarConfig config = fan(20, 20, 4, 25);
    if (whole) config.pulse.emplace().duration_us = bins_long * 200;  // a bin of 0.1 m at 1000 m/s, there and back
    return probe(config, lookingAt(sceneOf({facingWall(12)}))).ping;
}

/** Sums of the bins of a pulse so many bins long, over those without a pulse. */
Outcome pulseEnergy(double bins_long, double expected) {
    const types::Sonar plain = pulsed(bins_long, false), heard = pulsed(bins_long, true);
    const auto sum = [](const types::Sonar& ping) { return std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0); };
    const double deviation = off(sum(heard), expected * sum(plain));
    return {{},
            fmt::format("a tone of {:g} bins: {:.6g} times what no pulse gives", bins_long, sum(heard) / sum(plain)),
            deviation,
            deviation <= 1e-5 ? Verdict::Pass : Verdict::Fail};
}

}  // namespace

std::vector<StabilityCase> patternCases() {
    return {
        {31, "Beams far narrower than their distance", "to 1 % of the closed form", [] { return narrowBeam(0.1); }},
        {59, "A pulse shorter than a bin", "its length over the bin's, to 1e-5", [] { return pulseEnergy(0.6, 0.6); }},
        {59, "A pulse longer than the range", "every bin has the whole energy, to 1e-5",
         [] { return pulseEnergy(1000, 250); }}};
}

}  // namespace insonify::study
