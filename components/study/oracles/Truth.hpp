#pragma once
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace insonify::study {

/** Limits of azimuth (positive to port) and of elevation of one beam [rad]. */
struct BeamLimits {
    double azimuth_low, azimuth_high, half_height;
};

/** Returns the energy E/S0 that a beam receives between slant ranges r1 and r2 [m], without absorption: exact. */
using Truth = std::function<double(const BeamLimits& beam, double r1, double r2)>;

/** An interval of elevations [rad]. */
struct Elevations {
    double low, high;
};
/** Returns the elevations at which a plane is visible at an azimuth; empty: all. */
using Window = std::function<Elevations(double azimuth)>;

/** Returns the two-way weight of an elevation [1]; empty: 1. */
using Pattern = std::function<double(double elevation)>;

/** Returns the echo of the plane normal.p = distance (unit normal away from the sonar, sonar axes, distance above 0) of
 *  Lambert parameter 1. ACOUSTICS.md 9.6, with cos(theta) = distance / r: over a plane the integrand depends only on
 *  direction, and each bin is, at each azimuth, two intervals of elevation. */
Truth planeTruth(glm::dvec3 normal, double distance, Window window = {}, Pattern pattern = {});

/** Returns the echo of a sphere wholly inside one beam: ACOUSTICS.md 9.4. */
Truth sphereTruth(double radius, double centre);

/** Returns the echo of a disc that faces the sonar, wholly inside one beam: ACOUSTICS.md 9.5. */
Truth discTruth(double distance, double radius);

/** Returns the echo of a sphere in one beam, whose sigma_b is a function of the cosine [1]: ACOUSTICS.md 9.4. */
Truth sphereTruth(double radius, double centre, const std::function<double(double)>& section);

/** Returns the echo of water of a strength [1/m] under a level sonar; a bottom hides the rest: ACOUSTICS.md 9.10. */
Truth waterTruth(double strength, double height);

/** Returns the sum of echoes that do not hide each other. */
Truth sum(std::vector<Truth> parts);

}  // namespace insonify::study
