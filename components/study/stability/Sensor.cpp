// Fans, beams, apertures, range bins, beam patterns and pulses at their limits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "components/noise/Noise.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

/** Returns a ping whose bins are all 1. */
types::Sonar items(int64_t microseconds, uint32_t beams, uint32_t bins) {
    types::Sonar ping;
    ping.time.microseconds = microseconds;
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bins.assign(size_t{beams} * bins, 1.0f);
    return ping;
}

types::Sonar noisy(const noise::NoiseConfig& config, const types::Sonar& clean) {
    types::Sonar result;
    noise::Noise(config).add(clean, result);
    return result;
}

/** Returns the correlation of the first two beams. */
double correlation(const types::Sonar& ping) {
    const size_t n = ping.bin_count;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < n; ++i) {
        const double a = ping.bins[i], b = ping.bins[n + i];
        x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
    }
    const auto count = static_cast<double>(n);
    return (xy - x * y / count) / std::sqrt((xx - x * x / count) * (yy - y * y / count));
}

Outcome seeds() {
    constexpr uint32_t bins = 20000;
    int wrong = 0;
    double worst = 0;
    noise::NoiseConfig config;
    config.speckle.emplace();
    for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, ~uint64_t{0}}) {
        config.seed = seed;
        const types::Sonar first = noisy(config, items(5, 2, bins));
        wrong += noisy(config, items(5, 2, bins)).bins != first.bins;
        wrong += noisy(config, items(6, 2, bins)).bins == first.bins;
        worst = std::max(worst, std::abs(correlation(first)));
    }
    wrong += worst > 4 / std::sqrt(bins);
    return {{{"samples", bins}},
            fmt::format("seeds 0, 1 and 2^64 - 1: the same again, another ping differs, beams correlate by at most "
                        "{:.1e} (bound {:.1e})",
                        worst, 4 / std::sqrt(bins)),
            worst,
            wrong ? Verdict::Fail : Verdict::Pass};
}

Outcome extremeShapes() {
    noise::NoiseConfig config;
    const auto drawn = [&](double shape) {
        config.speckle = {.law = noise::SpeckleLaw::K, .shape = shape};
        return noisy(config, items(7, 64, 1000)).bins;
    };
    const std::vector<float> patchy = drawn(1e-3);
    std::vector<float> even = drawn(1e6);
    const bool finite = std::ranges::all_of(patchy, [](float bin) { return bin >= 0 && std::isfinite(bin); });
    const float maximum = std::ranges::max(patchy);
    std::ranges::sort(even);
    double distance = 0;
    const auto count = static_cast<double>(even.size());
    for (size_t i = 0; i < even.size(); ++i)
        distance = std::max(distance, std::abs(-std::expm1(-double{even[i]}) - (static_cast<double>(i) + 0.5) / count));
    const double bound = 1.63 / std::sqrt(count);
    return {{{"samples", count}},
            fmt::format("shape 1e-3: finite, the largest of 64,000 is {:.0f} times the mean; 1e6: off the exponential "
                        "law by {:.1e} (bound {:.1e})",
                        maximum, distance, bound),
            distance,
            finite && maximum > 100 && distance < bound ? Verdict::Pass : Verdict::Fail};
}

using sonar::SonarConfig;
using types::radians;

/** Returns a room of 20 x 30 m, its bottom 4 m below the sonar, which is off its middle. No wall is at the edge of a
 *  bin, where the last digit of its distance would decide its bin. */
types::GeometryPtr room() {
    return makeScene({levelGround(-4, 100), quad({12.03f, -14.03f, -4}, {0, 30, 0}, {0, 0, 20}),
                      quad({-7.97f, -14.03f, -4}, {0, 30, 0}, {0, 0, 20}),
                      quad({-7.97f, 15.97f, -4}, {20, 0, 0}, {0, 0, 20}),
                      quad({-7.97f, -14.03f, -4}, {20, 0, 0}, {0, 0, 20})});
}

/** Returns the relative L2 between beam `a` of one ping and beam `b` of another. */
double beamDifference(const types::Sonar& one, uint32_t a, const types::Sonar& other, uint32_t b) {
    double error = 0, norm = 0;
    for (uint32_t k = 0; k < one.bin_count; ++k) {
        const double x = one.bins[size_t{a} * one.bin_count + k], y = other.bins[size_t{b} * other.bin_count + k];
        error += (x - y) * (x - y);
        norm += y * y;
    }
    return std::sqrt(error / norm);
}

/** Compares beams of a wide fan with those of a sonar of ten beams in the same direction. */
Outcome wideFan(double fov_deg) {
    const int beams = 360;
    const double width = fov_deg / beams;
    sonar::SonarConfig wide = fan(fov_deg, 40, beams, 25), narrow = fan(10 * width, 40, 10, 25);
    setSamples(wide, 2048, 4);
    setSamples(narrow, 2048, 4);
    const Probe all = probe(wide, lookingAt(room()));
    double worst = 0;
    for (const int first : {0, 40, 100, 175, 250, 310, 350}) {  // none contains a corner of the room
        const double bearing = -fov_deg / 2 + (first + 5) * width;
        const Probe few = probe(narrow, lookingAt(room(), {}, radians(bearing)));
        for (uint32_t k = 0; k < 10; ++k)
            worst = std::max(worst, beamDifference(all.ping, static_cast<uint32_t>(first) + k, few.ping, k));
    }
    return within(1e-3, worst, fmt::format("70 beams of {} in {} frusta, bin by bin", beams, all.plan.slabs), all);
}

Outcome seams(double fov_deg) {
    sonar::SonarConfig config = fan(fov_deg, 40, 360, 50);
    setSamples(config, 512);
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5)})));
    double worst = 0;
    for (uint32_t k = 0; k < 360; ++k)
        worst = std::max(worst, beamDifference(received.ping, k, received.ping, (k + 1) % 360));
    return within(1e-3, worst,
                  fmt::format("neighbouring beams over level ground in {} frusta, the last next to the first",
                              received.plan.slabs),
                  received);
}

/** Tests a fan of `beams` in front of a wall. */
Outcome beamsBeforeAWall(int beams, double fov_deg) {
    sonar::SonarConfig config = fan(fov_deg, 20, beams, 25);
    setSamples(config, 64, std::max(2, 64 / beams));
    const Probe received = probe(config, lookingAt(makeScene({facingWall(10)})));
    return within(1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 10)),
                  fmt::format("worst of {} beams against the closed form", beams), received);
}

Outcome moreBeamsThanColumns() {
    sonar::SonarConfig config = fan(1, 20, 1, 15);
    config.bearings_deg.resize(1000);
    for (size_t k = 0; k < 1000; ++k) config.bearings_deg[k] = 0.01 * (static_cast<double>(k) - 500);
    config.beam_width_deg = 1;
    setSamples(config, 256, 1);
    const Probe received = probe(config, lookingAt(makeScene({facingWall(10)})));
    return within(1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 10)),
                  "1000 beams 1 deg wide and 0.01 deg apart, one column per beam's width: none empty", received);
}

Outcome thinAperture() {
    const sonar::SonarConfig config = fan(20, 0.01, 20, 15);
    const Probe received = probe(config, lookingAt(makeScene({facingWall(10)})));
    return within(1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 10)), "0.01 deg on a wall", received);
}

Outcome oneRow() {
    sonar::SonarConfig config = fan(20, 10, 20, 15);
    setSamples(config, 1, 1);
    const Probe received = probe(config, lookingAt(makeScene({facingWall(10)})));
    return within(0.01, worstBeam(received, config, planeTruth({1, 0, 0}, 10)),
                  "10 deg on a wall by one row and one column per beam", received);
}

/** Tests a Gaussian beam, which has no sidelobes: its integral over azimuth is known. */
Outcome narrowBeam(double width_deg) {
    sonar::SonarConfig config = fan(40, 40, 4, 25);
    setSamples(config, 512, 1);
    acoustics::BeamLaw& law = config.beam_pattern.emplace().receive.azimuth.emplace();
    law.weighting = acoustics::Weighting::Gaussian;
    law.width_deg = width_deg;
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5)})));
    const double integral = radians(width_deg) / 2 * std::sqrt(std::numbers::pi / std::numbers::ln2);
    const double truth = planeTruth({0, 0, -1}, 5)({-integral / 2, integral / 2, radians(20)}, 0, 25);
    double worst = 0;
    for (uint32_t beam = 0; beam < 4; ++beam) worst = std::max(worst, off(received.energy(beam), truth));
    return within(0.01, worst, fmt::format("beams of {:g} deg every 10 deg, one column each, over a bottom", width_deg),
                  received);
}

types::Sonar pulsed(double bins_long, bool whole) {
    sonar::SonarConfig config = fan(20, 20, 4, 25);
    if (whole) config.pulse.emplace().duration_us = bins_long * 200;  // a bin of 0.1 m at 1000 m/s, there and back
    return probe(config, lookingAt(makeScene({facingWall(12)}))).ping;
}

/** Compares the sums of the bins with a pulse `bins_long` long and without a pulse. */
Outcome pulseEnergy(double bins_long, double expected) {
    const types::Sonar plain = pulsed(bins_long, false), received = pulsed(bins_long, true);
    const auto sum = [](const types::Sonar& ping) { return std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0); };
    const double deviation = off(sum(received), expected * sum(plain));
    return {{},
            fmt::format("a tone of {:g} bins: {:.6g} times what no pulse gives", bins_long, sum(received) / sum(plain)),
            deviation,
            deviation <= 1e-5 ? Verdict::Pass : Verdict::Fail};
}

/** Compares one bin with a thousand. */
Outcome oneBin(const types::GeometryPtr& geometry, double pitch) {
    SonarConfig many = fan(60, 40, 16, 50), one = many;
    setSamples(many, 1024);
    setSamples(one, 1024);
    many.bin_count = 1000;
    one.bin_count = 1;
    const Probe in_one = probe(one, lookingAt(geometry, {}, 0, pitch)),
                in_many = probe(many, lookingAt(geometry, {}, 0, pitch));
    const double deviation = off(in_one.energy(), in_many.energy());
    return within(1e-6, deviation, "the energy of one bin against the sum of 1000", in_one);
}

Outcome twentyThousandBins() {
    SonarConfig config = fan(20, 20, 20, 2000);
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5, 8000)})));
    return within(1e-3, worstBeam(received, config, planeTruth({0, 0, -1}, 5)),
                  "20 beams over a bottom 5 m below, to 2 km", received);
}

Outcome narrowBinsFarAway() {
    SonarConfig config = fan(1, 1, 1, 2000);
    config.bin_count = 65536;
    config.range_rounding = sonar::RangeRounding::Exact;
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const double distance = 1999.875;  // exact in float
    const Probe received = probe(config, lookingAt(makeScene({facingWall(static_cast<float>(distance))})));
    const int bin = static_cast<int>(distance / grid.bin_width);
    Outcome outcome = within(
        0, std::abs(received.firstReturn(0) - bin),
        fmt::format("bins of {:.3g} m, the narrowest allowed at 2 km; deviation in bins", grid.bin_width), received);
    outcome.conditions.push_back({"ulps_per_bin", grid.bin_width / 1.2207e-4});
    return outcome;
}

Outcome noBlanking() {
    SonarConfig config = fan(60, 40, 16, 10), blanked = config;
    config.range_min = 0;
    const auto geometry = makeScene({levelGround(-2), facingWall(5)});
    const Probe received = probe(config, lookingAt(geometry)), plain = probe(blanked, lookingAt(geometry));
    return within(1e-6, difference(received.ping, plain.ping), "range_min 0 where nothing is nearer than 0.1 m",
                  received);
}

}  // namespace

std::vector<StabilityCase> noiseCases() {
    return {{47, "Seeds 0 and 2^64 - 1", "identical again; beams uncorrelated, below 4 / sqrt(n)", seeds},
            {48, "K statistics of shape 1e-3 and 1e6", "finite with an extreme tail; exponential", extremeShapes}};
}

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
         {24, "One bin, before a wall", "the energy of many bins, to 1e-6",
          [] { return oneBin(makeScene({facingWall(10)}), 0); }},
         {24, "One bin, over a grazed bottom", "the energy of many bins, to 1e-6",
          [] { return oneBin(makeScene({levelGround(-5)}), 0.1); }},
         {24, "20,000 bins", "every beam to 1e-3 of the closed form", twentyThousandBins},
         {25, "Bins near the resolution of float", "first return in its bin", narrowBinsFarAway},
         {27, "range_min of 0", "as with a blanking that hides nothing", noBlanking},
         {30, "Vertical aperture of 0.01 deg", "to 1e-3 of the closed form", thinAperture},
         {30, "One image row", "to 1 % of the closed form", oneRow},
         {31, "Beams far narrower than their distance", "to 1 % of the closed form", [] { return narrowBeam(0.1); }},
         {59, "A pulse shorter than a bin", "its length over the bin's, to 1e-5", [] { return pulseEnergy(0.6, 0.6); }},
         {59, "A pulse longer than the range", "every bin has the whole energy, to 1e-5",
          [] { return pulseEnergy(1000, 250); }}});
    return cases;
}

}  // namespace insonify::study
