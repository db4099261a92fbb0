#include "components/sonar/ways/WayPatterns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/fan/BeamFan.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

constexpr int pattern_steps = 2048;

}  // namespace

WayPatterns::WayPatterns(const RenderPlan& plan)
    : plan_(plan),
      conical_(plan.features.has(Feature::Conical)),
      has_azimuth_(plan.has(Pass::Beamform)),
      reach_(std::sin(types::radians(plan.sampled.beam_height_deg) / 2)),
      beam_width_(has_azimuth_ ? plan.directivity->halfPowerAzimuth() : types::radians(plan.config.beamWidthDeg())) {
    const bool patterned = plan.directivity && plan.directivity->hasElevation();
    for (int i = 0; i <= pattern_steps; ++i) {
        const double angle = std::asin(reach_ * (2.0 * i / pattern_steps - 1));
        sent_.push_back(patterned ? plan.directivity->sentElevation(angle) : 1);
        received_.push_back(patterned ? plan.directivity->receivedElevation(angle) : 1);
        if (has_azimuth_) azimuths_.push_back(plan.directivity->sentAzimuth(pi * (2.0 * i / pattern_steps - 1)));
    }
}

WayPatterns::Way WayPatterns::wayOf(const glm::dvec3& direction) const {
    return {beamAzimuthOf(direction, conical_), direction.z, !conical_ || direction.x >= 0};
}

double WayPatterns::elevation(const std::vector<double>& table, double sine) const {
    const double at = 0.5 * pattern_steps * (1 + sine / reach_);
    if (!(at >= 0 && at <= pattern_steps)) return 0;
    const auto i = std::min(static_cast<size_t>(at), size_t{pattern_steps - 1});
    const double part = at - static_cast<double>(i);
    return table[i] * (1 - part) + table[i + 1] * part;
}

double WayPatterns::sentAzimuth(double azimuth) const {
    if (!has_azimuth_) return plan_.cells.spans(azimuth) ? 1 : 0;
    const double at = 0.5 * pattern_steps * (1 + std::remainder(azimuth, 2 * pi) / pi);
    const auto i = std::min(static_cast<size_t>(at), size_t{pattern_steps - 1});
    const double part = at - static_cast<double>(i);
    return azimuths_[i] * (1 - part) + azimuths_[i + 1] * part;
}

double WayPatterns::power(const Way& sent, const Way& received) const {
    if (!sent.received || !received.received) return 0;
    const double here = sentAzimuth(received.azimuth);
    return here > 0
               ? elevation(sent_, sent.sine) * elevation(received_, received.sine) * sentAzimuth(sent.azimuth) / here
               : 0;
}

double WayPatterns::received(const Way& way) const {
    const double here = way.received ? sentAzimuth(way.azimuth) : 0;
    return here > 0 ? elevation(received_, way.sine) / here : 0;
}

bool WayPatterns::inOneBeam(const Way& a, const Way& b) const {
    return std::abs(std::remainder(a.azimuth - b.azimuth, 2 * pi)) < beam_width_;
}

}  // namespace insonify::sonar
