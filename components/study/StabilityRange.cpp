// Range bins at their limits.
#include <fmt/format.h>

#include <cmath>

#include "components/sonar/BinGrid.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StabilityGroups.hpp"

namespace insonify::study {
namespace {

using sonar::SonarConfig;

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

Outcome noBlanking() {
    SonarConfig config = fan(60, 40, 16, 10), blanked = config;
    config.range_min = 0;
    const auto geometry = sceneOf({levelGround(-2), facingWall(5)});
    const Probe heard = probe(config, lookingAt(geometry)), plain = probe(blanked, lookingAt(geometry));
    return within(1e-6, difference(heard.ping, plain.ping), "range_min 0 where nothing is nearer than 0.1 m", heard);
}

}  // namespace

std::vector<StabilityCase> rangeCases() {
    return {{24, "One bin, before a wall", "the energy of many bins, to 1e-6",
             [] { return oneBin(sceneOf({facingWall(10)}), 0); }},
            {24, "One bin, over a grazed bottom", "the energy of many bins, to 1e-6",
             [] { return oneBin(sceneOf({levelGround(-5)}), 0.1); }},
            {24, "20,000 bins", "every beam to 1e-3 of the closed form", twentyThousandBins},
            {25, "Bins near the resolution of float", "first return in its bin", narrowBinsFarAway},
            {27, "range_min of 0", "as with a blanking that hides nothing", noBlanking}};
}

}  // namespace insonify::study
