#pragma once
// Smooth rigid bodies with known target strengths, as meshes with any number of facets around (ACOUSTICS.md 3.6).
#include <glm/vec2.hpp>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::study {

/** The geometry of a target and a sonar. */
struct Encounter {
    double frequency_khz = 300;
    double range = 10;  ///< To the nearest point of the body [m].
    int around = 64;    ///< Number of facets around the body [1].
    double turn = 0;    ///< Turn of the first facet, in facets [1].

    double wavelength() const { return 1.5 / frequency_khz; }  ///< At 1500 m/s [m].
    /** Returns L^2 / (lambda r) of a flat length [m]: below 1/4 it is far, above 5 near; in between it interferes with
     *  itself. */
    double fresnelNumber(double length) const { return length * length / (wavelength() * range); }
};

/** A body in front of a sonar at the origin that looks along x. */
struct Target {
    types::GeometryPtr scene;
    double size;         ///< Side of a square about the x axis at the range that contains all of its echo [m].
    double strength_db;  ///< Sum of a ping's bins times range^4 [dB].
};

/** Returns a surface of revolution about z as a mesh, from a profile of (radius, z) from below; `arc` of it about -x
 *  [rad]. */
types::Mesh revolved(const std::vector<glm::dvec2>& profile, int around, double turn, double arc);

Target ellipsoidTarget(const Encounter& encounter, double ahead, double aside, double up);  ///< Semi-axes [m].
Target cylinderTarget(const Encounter& encounter, double radius, double length, double tilt);
Target plateTarget(const Encounter& encounter, double width, double height);
/** Returns a cone, perpendicular to the middle of its side. */
Target coneTarget(const Encounter& encounter, double radius, double height);
/** Returns a cylinder with an ellipsoidal nose and a conical tail, broadside. */
Target hullTarget(const Encounter& encounter, double radius, double length);

/** Returns a sonar of one beam that contains all of a target, with `samples` rows and columns. */
sonar::SonarConfig targetSonar(const Encounter& encounter, const Target& target, int samples);
/** Returns 10 log10 of the ping's sum over 1 / range^4, minus the target's strength [dB]. */
double targetError(const Encounter& encounter, const Target& target, const sonar::SonarConfig& config);

}  // namespace insonify::study
