#pragma once
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace insonify::study {

/** Limits of azimuth (positive to port) and of elevation that one beam hears [rad]. */
struct BeamLimits {
    double azimuth_low, azimuth_high, half_height;
};

/** Energy E/S0 that a beam hears between slant ranges r1 and r2 [m], without absorption: exact. */
using Truth = std::function<double(const BeamLimits& beam, double r1, double r2)>;

/** A stretch of elevations [rad]. */
struct Elevations {
    double low, high;
};
/** Which elevations of a plane are seen at an azimuth; all of them when empty. */
using Window = std::function<Elevations(double azimuth)>;

/** What is heard of an elevation, there and back [1]; all of it when empty. */
using Pattern = std::function<double(double elevation)>;

/** Echo of the plane normal.p = distance (unit normal away from the sonar, sonar axes, distance above 0) of Lambert
 *  parameter 1. ACOUSTICS.md 9.6, with cos(theta) = distance / r: over a plane the integrand depends on direction
 *  alone, and each bin is, at each azimuth, two stretches of elevation. */
Truth planeTruth(glm::dvec3 normal, double distance, Window window = {}, Pattern pattern = {});

/** The echo of a sphere wholly inside one beam: ACOUSTICS.md 9.4. */
Truth sphereTruth(double radius, double centre);

/** A disc of a radius that faces the sonar, wholly inside one beam: ACOUSTICS.md 9.5. */
Truth discTruth(double distance, double radius);

/** A sphere wholly inside one beam that gives back sigma_b of a cosine [1], ACOUSTICS.md 9.4. */
Truth sphereTruth(double radius, double centre, const std::function<double(double)>& section);

/** Water of a strength [1/m] over a bottom under a level sonar, which hides it: ACOUSTICS.md 9.10. */
Truth waterTruth(double strength, double height);

/** Echoes that do not hide one another. */
Truth sum(std::vector<Truth> parts);

}  // namespace insonify::study
