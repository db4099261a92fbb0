// Range bins, the speed of sound and the frequency at their limits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/PlanReport.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/study/Bounds.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

/** Whether any notice of a configuration holds `words`. */
bool warns(const SonarConfig& config, const std::string& words) {
    return std::ranges::any_of(sonar::configNotices(config),
                               [&](const std::string& notice) { return notice.find(words) != std::string::npos; });
}

/** One bin against a thousand. */
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
    const Probe heard = probe(config, lookingAt(sceneOf({levelGround(-5, 8000)})));
    return within(1e-3, worstBeam(heard, config, planeTruth({0, 0, -1}, 5)),
                  "20 beams over a bottom 5 m below, to 2 km", heard);
}

Outcome tooManyBins() {
    SonarConfig config = fan(120, 20, 4096, 2000);
    config.bin_count = 20000;
    return none(faultsOf(config).empty(),
                "4096 beams of 20,000 bins, 328 MB a ping: refused with the number that may be");
}

Outcome narrowBinsFarAway() {
    SonarConfig config = fan(1, 1, 1, 2000);
    config.bin_count = 65536;
    config.range_rounding = sonar::RangeRounding::Exact;
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const double distance = 1999.875;  // exact in float
    const Probe heard = probe(config, lookingAt(sceneOf({facingWall(static_cast<float>(distance))})));
    const int bin = static_cast<int>(distance / grid.bin_width);
    Outcome outcome = within(
        0, std::abs(heard.firstReturn(0) - bin),
        fmt::format("bins of {:.3g} m, the narrowest at 2 km that may be; deviation in bins", grid.bin_width), heard);
    outcome.conditions.push_back({"ulps_per_bin", grid.bin_width / 1.2207e-4});
    return outcome;
}

/** A plate at each of 400 bin edges: the first echo is in the bin that begins there. */
Outcome surfaceOnABinEdge() {
    SonarConfig config = fan(10, 10, 1, 50);
    config.speed_of_sound = 1250;
    config.bin_count = 400;  // 0.125 m, exact in binary
    config.range_min = 0.05;
    setSamples(config, 16);
    const auto geometry = sceneOf({facingWall(0)});
    types::Snapshot snapshot = lookingAt(geometry);
    Probe heard = probe(config, snapshot);
    sonar::SonarRenderer renderer(config, geometry);
    int wrong = 0;
    for (int bin = 1; bin < 400; ++bin) {
        snapshot.sonar.position.x = -0.125 * bin;
        renderer.render(snapshot, heard.ping);
        wrong += heard.firstReturn(0) != bin;
    }
    return within(0, wrong, fmt::format("{} of 399 exact edges in another bin", wrong), heard);
}

template <class... Change>
Outcome refused(const std::string& got, const Change&... change) {
    int accepted = 0;
    const auto judge = [&](const auto& wrong) {
        SonarConfig config;
        accepted += !faultsOf(config).empty();
        wrong(config);
        accepted += faultsOf(config).empty();
    };
    (judge(change), ...);
    return none(accepted, got);
}

Outcome badRanges() {
    return refused(
        "range 0, -5, NaN, inf; range_min above range, equal to it, negative, NaN: each refused",
        [](SonarConfig& c) { c.range = 0; }, [](SonarConfig& c) { c.range = -5; },
        [](SonarConfig& c) { c.range = NAN; }, [](SonarConfig& c) { c.range = INFINITY; },
        [](SonarConfig& c) { c.range_min = 60; }, [](SonarConfig& c) { c.range_min = 50; },
        [](SonarConfig& c) { c.range_min = -1; }, [](SonarConfig& c) { c.range_min = NAN; });
}

Outcome noBlanking() {
    SonarConfig config = fan(60, 40, 16, 10), blanked = config;
    config.range_min = 0;
    const auto geometry = sceneOf({levelGround(-2), facingWall(5)});
    const Probe heard = probe(config, lookingAt(geometry)), plain = probe(blanked, lookingAt(geometry));
    return within(1e-6, difference(heard.ping, plain.ping), "range_min 0 where nothing is nearer than 0.1 m", heard);
}

Outcome badSpeeds() {
    return refused(
        "speed_of_sound 0, -1500, NaN, inf, 1e9: each refused", [](SonarConfig& c) { c.speed_of_sound = 0; },
        [](SonarConfig& c) { c.speed_of_sound = -1500; }, [](SonarConfig& c) { c.speed_of_sound = NAN; },
        [](SonarConfig& c) { c.speed_of_sound = INFINITY; }, [](SonarConfig& c) { c.speed_of_sound = 1e9; });
}

Outcome frequencies() {
    Probe heard;
    int wrong = 0;
    for (const double kilohertz : {0.0, 10'000.0})
        for (const auto law : {acoustics::AbsorptionLaw::FrancoisGarrison, acoustics::AbsorptionLaw::AinslieMccolm}) {
            SonarConfig config = fan(60, 40, 16, 50);
            config.water.emplace();
            config.absorption.emplace().frequency_khz = kilohertz;
            config.absorption->law = law;
            heard = probe(config, lookingAt(sceneOf({levelGround(-1)})));
            wrong += !(heard.ping.bins[35] > 0) || !heard.isSound();
            wrong += !warns(config, "outside its law's validity") || !faultsOf(config).empty();
        }
    return none(wrong, "0 Hz and 10 MHz by both laws: a warning, finite echoes", heard.conditions);
}

}  // namespace

std::vector<StabilityCase> rangeCases() {
    return {{24, "One bin, before a wall", "the energy of many bins, to 1e-6",
             [] { return oneBin(sceneOf({facingWall(10)}), 0); }},
            {24, "One bin, over a grazed bottom", "the energy of many bins, to 1e-6",
             [] { return oneBin(sceneOf({levelGround(-5)}), 0.1); }},
            {24, "20,000 bins", "every beam to 1e-3 of the closed form", twentyThousandBins},
            {24, "4096 beams of 20,000 bins", "refused: more than memory should hold", tooManyBins},
            {25, "Bins near the resolution of float", "first return in its bin", narrowBinsFarAway},
            {26, "Bin edge exactly on a surface", "half-open: in the bin that begins there", surfaceOnABinEdge},
            {27, "range 0 or negative, range_min above range", "refused", badRanges},
            {27, "range_min of 0", "as with a blanking that hides nothing", noBlanking},
            {28, "Speed of sound 0, negative, NaN, 1e9", "refused", badSpeeds},
            {29, "Frequency of 0 and of 10 MHz", "a warning; finite", frequencies}};
}

}  // namespace insonify::study
