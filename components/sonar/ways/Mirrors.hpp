#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** The plane n.p = D. */
struct MirrorPlane {
    glm::dvec3 normal{0};  ///< Unit [1].
    double distance = 0;   ///< [m]

    glm::dvec3 turned(const glm::dvec3& way) const { return way - 2 * glm::dot(normal, way) * normal; }
    glm::dvec3 image(const glm::dvec3& place) const {
        return place - 2 * (glm::dot(normal, place) - distance) * normal;
    }
};

/** Share of the sound that a material reflects as a mirror does, where `bounces` reflections of a way are asked for
 *  [1]: one that is declared to, or from two on one that is smooth and no shell (ACOUSTICS.md 5.23); 0: it does not. */
double reflectedPower(const types::Material& material, int bounces);

/** Mean square slope of a sea surface in a wind [m/s], of both its directions together; 0 without wind [1].
 *  ACOUSTICS.md 5.24. */
double slopeOfSea(double wind);

/** What of a pressure a sea surface reflects as a mirror does, in phase, the rest of it scattered about: by its rms
 *  height in the wind [m/s], wavelength [m] and sine of the grazing angle [1]. ACOUSTICS.md 5.24. */
double coherentReflection(double wind, double wavelength, double sine_grazing);

/** The water surface of one ping, from below. */
class WaterMirror {
public:
    explicit WaterMirror(const SonarConfig& config);

    /** Once a ping. */
    void place(const types::Snapshot& snapshot, double range_max);
    /** Whether it reflects in this ping. */
    bool reflects() const { return reflects_; }
    /** In sonar axes; its normal is up. */
    const MirrorPlane& plane() const { return plane_; }
    /** How far it is along a way from a place, sonar axes, in lengths of the way; infinite where it is not ahead. */
    double distance(const glm::dvec3& from, const glm::dvec3& way) const;
    /** A part of it about `at` that the wind has tilted, which faces sound that comes along `way`; `key` tells which
     *  one of the ping. Flat without wind. */
    MirrorPlane facet(const glm::dvec3& at, const glm::dvec3& way, uint64_t key) const;
    /** Why it does not reflect in this ping; none where it does or is not asked to. */
    std::optional<LeftOut> leftOut() const { return left_out_; }

private:
    bool wanted_;
    double slope_;  ///< Of one direction, rms [1].
    uint64_t ping_ = 0;
    bool reflects_ = false;
    MirrorPlane plane_;
    std::optional<LeftOut> left_out_;
};

}  // namespace insonify::sonar
