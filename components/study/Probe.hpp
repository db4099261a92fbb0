#pragma once
#include <string>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/Truth.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Plan.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::study {

/** One ping of a case, and its conditions. */
struct Probe {
    types::Sonar ping;
    types::Plan plan;
    Conditions conditions;  ///< The conditions of ACOUSTICS.md 11.
    std::string device;     ///< Name of the OpenGL renderer.

    double energy() const;  ///< Returns the sum of all bins.
    double energy(uint32_t beam) const;
    int firstReturn(uint32_t beam) const;  ///< Returns the bin of the first echo, -1 for none.
    bool isSound() const;                  ///< Returns whether all bins are finite and not negative.
};

/** Renders the first ping of a new renderer. */
Probe probe(const sonar::SonarConfig& config, const types::Snapshot& snapshot);

/** Returns a fan with bins of 0.1 m at 1000 m/s, which last whole microseconds. */
sonar::SonarConfig fan(double fov_deg, double height_deg, int beams, double range);
/** Sets the samples of a beam: rows, and columns per beam. */
void setSamples(sonar::SonarConfig& config, int rows, int columns_per_beam = 2);
/** Returns a snapshot of a sonar that looks ahead along x, turned by yaw and then pitched down [rad]. */
types::Snapshot lookingAt(types::GeometryPtr geometry, glm::dvec3 position = {}, double yaw = 0, double pitch = 0);
/** Returns a copy of a scene to change. */
std::shared_ptr<types::Geometry> makeCopy(const types::GeometryPtr& geometry);

types::Mesh levelGround(float z, float width = 1000);     ///< [m]
types::Mesh facingWall(float x, float half_width = 200);  ///< Perpendicular to the x axis [m].

/** Returns the relative L2 difference of all bins; infinite if b is silent and a is not. */
double difference(const types::Sonar& a, const types::Sonar& b);
/** Returns |a / b - 1|. */
double off(double a, double b);
/** Returns the energy that a beam of `config` receives in all its bins, or between two ranges [m]. */
double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth);
double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth, double r1, double r2);
/** Returns the max |energy / truth - 1| over the beams. */
double worstBeam(const Probe& received, const sonar::SonarConfig& config, const Truth& truth);

/** Returns a pass if the deviation is at most `tolerance` and the ping is sound. */
Outcome within(double tolerance, double deviation, const std::string& got, const Probe& received);

}  // namespace insonify::study
