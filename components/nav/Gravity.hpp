#pragma once
#include <cmath>
#include <glm/vec3.hpp>

#include "types/Angle.hpp"

namespace insonify::nav {

/** Returns the normal gravity on the ellipsoid of WGS 84 at a latitude [deg], positive down [m/s^2]: Somigliana's
 *  closed formula, NIMA TR 8350.2, 3rd edition, equation 4-1. Its growth with depth, about 2.2e-6 m/s^2 per metre, is
 *  omitted. */
inline double normalGravity(double latitude_deg) {
    constexpr double at_equator = 9.7803253359, k = 0.00193185265241, eccentricity_squared = 0.00669437999013;
    const double sine = std::sin(types::radians(latitude_deg));
    return at_equator * (1 + k * sine * sine) / std::sqrt(1 - eccentricity_squared * sine * sine);
}

/** Returns the rotation of the earth at a latitude [deg] in the world, x north, y west, z up; WGS 84 [rad/s]. */
inline glm::dvec3 earthRotation(double latitude_deg) {
    constexpr double rate = 7.292115e-5;
    const double latitude = types::radians(latitude_deg);
    return {rate * std::cos(latitude), 0, rate * std::sin(latitude)};
}

}  // namespace insonify::nav
