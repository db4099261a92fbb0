#pragma once
#include <glm/vec3.hpp>

namespace insonify::nav {

/** Normal gravity on the ellipsoid of WGS 84 at a latitude [deg], positive down [m/s^2]: Somigliana's closed formula,
 *  NIMA TR 8350.2, 3rd edition, equation 4-1. That it grows by some 2e-6 of it per metre of depth is left out. */
double normalGravity(double latitude_deg);

/** Rotation of the earth in the world, x north, y west, z up, at a latitude [deg]; WGS 84 [rad/s]. */
glm::dvec3 earthRotation(double latitude_deg);

}  // namespace insonify::nav
