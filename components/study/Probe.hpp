#pragma once
#include <string>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/StabilityStudy.hpp"
#include "components/study/oracles/Truth.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** One ping of a case, and under what conditions it came about. */
struct Probe {
    types::Sonar ping;
    types::Plan plan;
    Conditions conditions;  ///< Those of ACOUSTICS.md 11.
    std::string device;     ///< Name of the OpenGL renderer.

    double energy() const;  ///< Sum of all bins.
    double energy(uint32_t beam) const;
    int firstReturn(uint32_t beam) const;  ///< Bin of the first echo, -1 for none.
    bool isSound() const;                  ///< All bins are finite and none is negative.
};

/** A new renderer and its first ping. */
Probe probe(const sonar::SonarConfig& config, const types::Snapshot& snapshot);

/** A fan with bins of 0.1 m at 1000 m/s: whole microseconds. */
sonar::SonarConfig fan(double fov_deg, double height_deg, int beams, double range);
/** Sets the samples of a beam: rows, and columns per beam. */
void setSamples(sonar::SonarConfig& config, int rows, int columns_per_beam = 2);
/** A sonar that looks ahead along x, turned by yaw and then pitched down [rad]. */
types::Snapshot lookingAt(types::GeometryPtr geometry, glm::dvec3 position = {}, double yaw = 0, double pitch = 0);
/** A copy of a scene to change. */
std::shared_ptr<types::Geometry> copyOf(const types::GeometryPtr& geometry);

types::Mesh levelGround(float z, float width = 1000);     ///< [m]
types::Mesh facingWall(float x, float half_width = 200);  ///< Square to the x axis [m].

/** Relative L2 difference of all bins; infinite when b is silent and a is not. */
double difference(const types::Sonar& a, const types::Sonar& b);
/** |a / b - 1|. */
double off(double a, double b);
/** What a beam of `config` hears in all its bins, or between two ranges [m]. */
double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth);
double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth, double r1, double r2);
/** Largest |energy / truth - 1| over the beams. */
double worstBeam(const Probe& heard, const sonar::SonarConfig& config, const Truth& truth);

/** Passes when the deviation is at most `tolerance` and the ping is sound. */
Outcome within(double tolerance, double deviation, const std::string& got, const Probe& heard);

}  // namespace insonify::study
