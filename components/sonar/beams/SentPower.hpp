#pragma once
#include <optional>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/Directivity.hpp"
#include "types/Transmission.hpp"

namespace insonify::sonar {

/** Directions in which a sonar's transmitter radiates: by the laws of its `beam_pattern.transmit`; without one
 *  in azimuth evenly over the fan, without one in elevation evenly over the aperture. */
class SentPower final : public types::Radiation {
public:
    /** @throws types::ConfigError as Directivity does */
    explicit SentPower(const SonarConfig& config);
    double towards(const glm::dvec3& direction) const override;

private:
    bool conical_;
    double half_height_;  ///< [rad]
    Fan beams_;
    std::optional<Directivity> pattern_;
    bool has_azimuth_ = false, has_elevation_ = false;  ///< Transmit laws of the pattern.
};

}  // namespace insonify::sonar
