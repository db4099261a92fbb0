#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace insonify::sonar {

/** Where a point lies from a sonar, as its beams see it [rad]. */
struct BeamAngles {
    double azimuth;    ///< Positive to port: about the z-axis; of a conical fan above the plane square to the y-axis.
    double elevation;  ///< Above the sonar's plane.
};

/** Of a point in the sonar's axes [m]; of the sonar's own place it is 0, 0. */
inline BeamAngles beamAnglesOf(const glm::dvec3& at, bool conical) {
    const double range = std::max(glm::length(at), 1e-12);
    const auto above = [range](double part) { return std::asin(std::clamp(part / range, -1.0, 1.0)); };
    return {conical ? above(at.y) : std::atan2(at.y, at.x), above(at.z)};
}

}  // namespace insonify::sonar
