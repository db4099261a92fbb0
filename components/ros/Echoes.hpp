#pragma once
#include <optional>
#include <span>

#include "components/ros/Options.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::ros {

/** Of bin k of a ping [m]. */
inline float binCentre(const types::Sonar& ping, uint32_t k) { return static_cast<float>(ping.binStart(k + 0.5)); }

/** Unit vector at a bearing (positive to port) in the plane of the fan. */
Vector3 directionOf(double bearing_rad, SensorFrame frame);

/** What is a return of one ping: a threshold on its bins. */
class DetectionThreshold {
public:
    DetectionThreshold(const types::Sonar& ping, const SonarOptions& options);
    bool isReturn(float bin) const { return bin >= least_; }
    /** The first bin of a beam that is a return. */
    std::optional<uint32_t> firstOf(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    float least_;
};

/** Writes the bins in the order and the numbers of the options. */
void fillImage(const types::Sonar& ping, const SonarOptions& options, SonarImageData& image);

}  // namespace insonify::ros
