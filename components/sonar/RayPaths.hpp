#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "components/sonar/RayTable.hpp"
#include "components/sonar/RenderPlan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** A plane as the sonar hears it: not where it is, but where it seems to be from the directions and the times of its
 *  echoes. All in sonar axes. */
struct ApparentPlane {
    glm::dvec3 normal{0};  ///< Of the plane normal . place = 1 that seems to be about the direction at hand [1/m].
    double cosine = 0;     ///< Of the angle at which sound meets the true one [1].
    double focus = 0;      ///< Intensity there, over that of straight rays of the same range [1].
};

/** The ways that sound takes where it does not come straight from where an object is: bent by a profile of the speed
 *  of sound. What is heard from a direction at a slant range is at a place that depends on both. */
class RayPaths {
public:
    static constexpr double most_focus = 4;  ///< At a caustic rays would give infinitely much [1].

    /** Of a plan with Feature::Refraction, which outlives it. */
    explicit RayPaths(const RenderPlan& plan);

    /** Once a ping. */
    void place(const types::Snapshot& snapshot);
    /** What is heard from a direction, unit, at a slant range [m], is there about the sonar [m]. */
    glm::dvec3 at(const glm::dvec3& direction, double range) const;
    /** Ranges between which all ways are nearly straight, from 0 on [m]. */
    std::span<const double> corners() const { return table_.corners(); }
    /** Of the plane normal . place = distance as it is met in a direction near a range [m]. */
    ApparentPlane apparent(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double range) const;
    /** No place is further away than its slant range times this [1]. */
    double stretch() const { return stretch_; }

private:
    double rangeOf(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near) const;

    RayTable table_;
    double stretch_;
    glm::dmat3 world_from_sonar_{1};  ///< [1]
};

}  // namespace insonify::sonar
