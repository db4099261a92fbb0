#include "components/sonar/beams/SentPower.hpp"

#include <cmath>

#include "types/Angle.hpp"

namespace insonify::sonar {

SentPower::SentPower(const SonarConfig& config)
    : conical_(config.beam_geometry == BeamGeometry::Conical),
      half_height_(types::radians(config.beam_height_deg) / 2),
      beams_(makeBeams(config)) {
    if (!config.beam_pattern) return;
    pattern_.emplace(config);
    has_azimuth_ = config.beam_pattern->transmit.azimuth.has_value();
    has_elevation_ = config.beam_pattern->transmit.elevation.has_value();
}

double SentPower::towards(const glm::dvec3& direction) const {
    if (conical_ && direction.x < 0) return 0;
    const BeamAngles at = beamAnglesOf(direction, conical_);
    const double across = has_azimuth_ ? pattern_->sentAzimuth(at.azimuth) : beams_.spans(at.azimuth);
    const double along =
        has_elevation_ ? pattern_->sentElevation(at.elevation) : std::abs(at.elevation) <= half_height_;
    return across * along;
}

}  // namespace insonify::sonar
