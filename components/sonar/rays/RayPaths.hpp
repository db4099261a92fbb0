#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/places/Motion.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/RayTable.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** A plane where it seems to be by the directions and the times of its echoes. All in sonar axes. */
struct ApparentPlane {
    glm::dvec3 normal{0};  ///< The plane is normal . place = 1 about the direction at hand [1/m].
    double cosine = 0;     ///< Cosine of the angle at which sound meets the true plane [1].
    double focus = 0;      ///< Intensity there, over that of straight rays of the same range [1].
};

/** A point whose echo comes from another place. */
struct HeardPoint {
    glm::dvec3 place;  ///< Where it seems to be, sonar axes [m].
    double focus;      ///< Intensity there, over that of straight rays of the same range [1].
};

/** The ways that sound takes where it does not come straight from where an object is: bent by a profile of the speed
 *  of sound, or because sonar and objects move and turn while it is under way. What is heard from a direction at a
 *  slant range is at a place that depends on both (ACOUSTICS.md 5.19, 5.20).
 *
 *  The ray-tracer owns them instead of a PingEffect: two effects, refraction and motion, share one object, and it
 * replaces how rays are cast and how planes become cells, which a call per tile could not. */
class RayPaths {
public:
    static constexpr double max_focus = 4;  ///< At a caustic rays would give infinitely much [1].

    /** The plan has refraction or motion within a ping. Plan and geometry outlive the paths. */
    RayPaths(const RenderPlan& plan, const types::Geometry& geometry);

    /** Switches to another geometry from the next ping on. */
    void takeScene(const types::Geometry& geometry);
    /** Once a ping. Allocates nothing after the second. */
    void place(const types::Snapshot& snapshot);
    /** Whether all ways of this ping are as good as straight: nothing is bent, and nothing moves enough. */
    bool areStraight() const { return !table_ && !moves_; }
    /** How an object moves in this ping; null where it does not. */
    const Drift* drift(uint32_t object) const { return moves_ ? motion_->drift(object) : nullptr; }
    /** The same of one of its triangles; `own` is filled where the object deforms. */
    const Drift* driftOf(uint32_t object, uint32_t triangle, Drift& own) const {
        return moves_ ? motion_->driftOf(object, triangle, own) : nullptr;
    }
    /** What is heard from a direction, unit, at a slant range [m], was there about the sonar when the pulse was sent
     *  [m]; of an object that moves by `drift`. */
    glm::dvec3 at(const glm::dvec3& direction, double range, const Drift* drift = nullptr) const;
    /** Ranges between which all ways are nearly straight, from 0 on [m]. */
    std::span<const double> corners() const { return corners_; }
    /** Returns the apparent plane of normal . place = distance, as it is met in a direction near a range [m]. */
    ApparentPlane apparent(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                           const Drift* drift) const;
    /** From where a point target of this ping is heard that was there about the sonar, sonar axes, when the pulse was
     *  sent [m]: the place that is nearest to the straight one, as if it were heard along a straight ray; none where
     *  there is none, as in a shadow. */
    std::optional<HeardPoint> heard(const glm::dvec3& place, size_t target) const;
    /** The greatest inverse range at which something is heard that is within an inverse distance [1/m]. */
    double nearLimit(double inverse_distance) const;

private:
    void placeMotion(const types::Snapshot& snapshot);
    void placeCorners();
    /** Returns where a place that moves by `drift` was when the pulse was sent, over straight rays [m]. */
    glm::dvec3 movedBy(const glm::dvec3& direction, double range, const Drift* drift) const;
    double rangeOf(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                   const Drift* drift) const;

    const RenderPlan& plan_;
    std::optional<RayTable> table_;
    std::optional<Motion> motion_;
    double coupling_;  ///< dopplerCoupling() [s].
    double share_;     ///< Share of a turn during the flight by which echoes are turned [1].
    double stretch_;   ///< No place is further away than its slant range times this, but for the coupling [1].
    glm::dmat3 world_from_sonar_{1};  ///< [1]
    bool moves_ = false;
    glm::dvec3 velocity_{0}, turn_{0};  ///< The sonar's, in sonar axes [m/s], [rad/s].
    double fastest_ = 0;                ///< At which any place comes nearer or goes away, at most [m/s].
    std::vector<double> corners_;
};

}  // namespace insonify::sonar
