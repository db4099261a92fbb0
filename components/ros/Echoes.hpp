#pragma once
#include <optional>

#include "components/ros/Options.hpp"
#include "components/ros/SonarMessages.hpp"
#include "types/Sonar.hpp"

namespace insonify::ros {

/** Returns the range of the centre of bin k of a ping [m]. */
inline float binCentre(const types::Sonar& ping, uint32_t k) { return static_cast<float>(ping.binStart(k + 0.5)); }

/** Returns the unit vector at a bearing (positive to port) in the plane of the fan. */
Vector3 directionOf(double bearing_rad, SensorFrame frame);

/** Decides which bins of one ping are returns, by a threshold. */
class DetectionThreshold {
public:
    DetectionThreshold(const types::Sonar& ping, const SonarOptions& options);
    bool isReturn(float bin) const { return bin >= minimum_; }
    /** Returns the first bin of a beam that is a return. */
    std::optional<uint32_t> firstOf(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    float minimum_;
};

/** Writes the bins in the order and type of the options. */
void fillImage(const types::Sonar& ping, const SonarOptions& options, SonarImageData& image);

}  // namespace insonify::ros
