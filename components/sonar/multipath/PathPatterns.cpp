#include "components/sonar/multipath/PathPatterns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/beams/BeamFan.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

constexpr size_t table_cells = 1024;

}  // namespace

PathPatterns::PathPatterns(const RenderPlan& plan)
    : plan_(plan),
      conical_(plan.features.has(Feature::Conical)),
      has_azimuth_(plan.has(Pass::Beamform)),
      reach_(std::sin(types::radians(plan.sampled.beam_height_deg) / 2)),
      beam_width_(has_azimuth_ ? plan.directivity->halfPowerAzimuth() : types::radians(plan.config.beamWidthDeg())) {
    constexpr acoustics::AdaptiveTable::Bound bound{0.0115, 1e-5};
    if (plan.directivity && plan.directivity->hasElevation()) {
        const auto makeTable = [&](double (Directivity::*law)(double) const) {
            const auto at = [&](double sine) {
                return ((*plan.directivity).*law)(std::asin(std::clamp(sine, -1.0, 1.0)));
            };
            return acoustics::AdaptiveTable(at, -reach_, reach_, bound, table_cells);
        };
        sent_ = makeTable(&Directivity::sentElevation);
        received_ = makeTable(&Directivity::receivedElevation);
    }
    if (has_azimuth_)
        azimuths_ = acoustics::AdaptiveTable([&](double azimuth) { return plan.directivity->sentAzimuth(azimuth); },
                                             -pi, pi, bound, table_cells);
}

PathPatterns::Direction PathPatterns::toDirection(const glm::dvec3& direction) const {
    return {beamAzimuth(direction, conical_), direction.z, !conical_ || direction.x >= 0};
}

double PathPatterns::elevation(const acoustics::AdaptiveTable& table, double sine) const {
    if (!(std::abs(sine) <= reach_)) return 0;
    return table.empty() ? 1 : table.at(sine);
}

double PathPatterns::sentAzimuth(double azimuth) const {
    if (!has_azimuth_) return plan_.cells.spans(azimuth) ? 1 : 0;
    return azimuths_.at(std::remainder(azimuth, 2 * pi));
}

double PathPatterns::power(const Direction& sent, const Direction& received) const {
    if (!sent.received || !received.received) return 0;
    const double here = sentAzimuth(received.azimuth);
    return here > 0
               ? elevation(sent_, sent.sine) * elevation(received_, received.sine) * sentAzimuth(sent.azimuth) / here
               : 0;
}

double PathPatterns::received(const Direction& direction) const {
    const double here = direction.received ? sentAzimuth(direction.azimuth) : 0;
    return here > 0 ? elevation(received_, direction.sine) / here : 0;
}

bool PathPatterns::inOneBeam(const Direction& a, const Direction& b) const {
    return std::abs(std::remainder(a.azimuth - b.azimuth, 2 * pi)) < beam_width_;
}

}  // namespace insonify::sonar
