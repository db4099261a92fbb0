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

/** The azimuth of a direction, unit, in the sonar's axes: of a conical fan its cone's bearing [rad]. */
inline double beamAzimuthOf(const glm::dvec3& direction, bool conical) {
    return conical ? std::asin(std::clamp(direction.y, -1.0, 1.0)) : std::atan2(direction.y, direction.x);
}

/** Of a point in the sonar's axes [m]; of the sonar's own place it is 0, 0. */
inline BeamAngles beamAnglesOf(const glm::dvec3& at, bool conical) {
    const glm::dvec3 direction = at / std::max(glm::length(at), 1e-12);
    return {beamAzimuthOf(direction, conical), std::asin(std::clamp(direction.z, -1.0, 1.0))};
}

}  // namespace insonify::sonar
