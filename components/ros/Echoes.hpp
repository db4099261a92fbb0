#pragma once
#include <optional>

#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/Sonar.hpp"

namespace insonify::ros {

/** Returns the range of the centre of bin k of a ping [m]. */
inline float binCentre(const types::Sonar& ping, uint32_t k) { return static_cast<float>(ping.binStart(k + 0.5)); }

/** Returns the unit vector at a bearing (positive to port) in the plane of the fan. */
Vector3 directionOf(double bearing_rad, SensorFrame frame);

/** Returns the range from which on bins of a ping are returns [m]. */
double rangeMin(const SonarOptions& options);

/** Decides which bins of one ping are returns, by a threshold for types::ReturnLevels. It is relative to the strongest
 *  level of the ping; with a `reference_db`, to that level of a bin. Of levels in decibels only the range counts. */
class DetectionThreshold {
public:
    DetectionThreshold(const types::Sonar& ping, const SonarOptions& options);
    /** Whether bin `k` of a beam, which has this value, is a return. */
    bool isReturn(size_t k, float bin) const {
        const double gain = is_absolute_ ? levels_.gain(k) : 1;
        if (is_linear_) return levels_.at(k, static_cast<double>(bin)) >= minimum_ * gain;
        return k >= levels_.first() && bin >= static_cast<float>(minimum_);
    }
    /** Returns the first bin of a beam that is a return. */
    std::optional<uint32_t> firstOf(uint32_t beam) const;
    /** Whether a beam has no return, but a strong echo nearer than rangeMin(). */
    bool isTooNear(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    const types::ReturnLevels& levels_;
    bool is_linear_, is_absolute_;
    double minimum_;
};

/** Writes the bins in the order and type of the options. */
void fillImage(const types::Sonar& ping, const SonarOptions& options, SonarImageData& image);

}  // namespace insonify::ros
