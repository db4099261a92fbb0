#pragma once
// Smooth rigid bodies with known target strengths, as meshes of any number of facets round (ACOUSTICS.md 3.6).
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Geometry.hpp"

namespace insonify::study {

/** How a target is met by sound. */
struct Encounter {
    double frequency_khz = 300;
    double range = 10;  ///< To the nearest point of the body [m].
    int around = 64;    ///< Facets round the body [1].
    double turn = 0;    ///< By which its first facet is turned, in facets [1].

    double wavelength() const { return 1.5 / frequency_khz; }  ///< At 1500 m/s [m].
    /** L^2 / (lambda r) of a flat length [m]: below 1/4 it is far, above 5 near, and between it interferes by itself.
     */
    double fresnelNumber(double length) const { return length * length / (wavelength() * range); }
};

/** A body before a sonar at the origin that looks along x. */
struct Target {
    types::GeometryPtr scene;
    double size;         ///< Of a square about the x axis at the range that holds all of its echo [m].
    double strength_db;  ///< Sum of a ping's bins times range^4 [dB].
};

/** A surface of revolution about z through (radius, z), from below, as a mesh; `arc` of it about -x [rad]. */
types::Mesh revolved(const std::vector<glm::dvec2>& profile, int around, double turn, double arc);

Target ellipsoidTarget(const Encounter& met, double ahead, double aside, double up);  ///< Semi-axes [m].
Target cylinderTarget(const Encounter& met, double radius, double length, double tilt);
Target plateTarget(const Encounter& met, double width, double height);
/** Square to the middle of its side. */
Target coneTarget(const Encounter& met, double radius, double height);
/** A cylinder with an ellipsoidal nose and a conical tail, broadside. */
Target hullTarget(const Encounter& met, double radius, double length);

/** One beam that holds all of a target, with that many rows and as many columns. */
sonar::SonarConfig targetSonar(const Encounter& met, const Target& target, int samples);
/** 10 log10 of the ping's sum over 1 / range^4, less the target's strength [dB]. */
double targetError(const Encounter& met, const Target& target, const sonar::SonarConfig& config);

}  // namespace insonify::study
