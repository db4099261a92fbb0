#pragma once
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/surfaces/Motion.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

/** A table of rays that a sound speed profile bends. It maps the elevation at which sound leaves the sonar, and its
 *  travel time, to a place. The time is given as slant range at the sonar's own speed of sound. The table is made for a
 *  depth of the sonar, and again where a change of depth could cause an error of a hundredth of a bin
 *  (ACOUSTICS.md 5.19). */
class RayTable {
public:
    static constexpr int max_corners = 512;  ///< [1]
    static constexpr double beyond = 1.02;   ///< Rays extend to this share of the range, for cells at its edge [1].

    /** Place of a ray about the sonar, `spread` times the cosine of its elevation away and `rise` above it [m], and the
     *  rates of both with range [1]. In water with one speed, that of the sonar, `spread` is the range. */
    struct Place {
        double spread, rise, spread_rate, rise_rate;
    };

    RayTable(const acoustics::SoundProfile& profile, const BinGrid& grid);

    /** Sets the sonar's depth [m]. Returns whether the table was made again. Allocates only the first time. */
    bool place(double depth);
    /** Returns the place at an elevation in the world [rad] and a range [m], from 0 to slightly beyond the grid's
     *  range_max. */
    Place at(double elevation, double range) const;
    /** Returns the number of equal parts of the range from 0 to `beyond` in which rays are nearly straight [1]. */
    size_t corners() const { return ranges_.size() - 1; }
    /** Returns the angle between neighbouring rays of the table [rad]. */
    double elevationStep() const { return elevation_step_; }

private:
    void trace(size_t ray, double depth);
    void findTears();
    /** Interpolates one ray between two of its corners, by Hermite's cubic. */
    Place between(size_t ray, size_t corner, double share) const;

    acoustics::SoundProfile profile_;
    double nominal_;         ///< Speed of sound of the sonar [m/s].
    double range_step_;      ///< [m]
    double elevation_step_;  ///< [rad]
    double good_for_;        ///< Change of depth for which the table is valid [m].
    double depth_ = 0;       ///< Depth of the table [m].
    size_t rays_;
    std::vector<double> ranges_, times_;  ///< [m], [s]
    std::vector<acoustics::RayPoint> points_;
    std::vector<Place> places_;  ///< For each ray, from straight down to straight up, at each corner.
    /** Whether each ray and the next diverge there, as where one turns back from a layer that the other passes: between
     *  them is a shadow. */
    std::vector<uint8_t> torn_;
};

/** The apparent place of a plane, from the directions and the times of its echoes. All in sonar axes. */
struct ApparentPlane {
    glm::dvec3 normal{0};  ///< The plane is normal . place = 1 near the current direction [1/m].
    double cosine = 0;     ///< Cosine of the angle at which sound meets the true plane [1].
    double focus = 0;      ///< Intensity relative to straight rays of the same range [1].
};

/** A point whose echo arrives from an apparent place. */
struct EchoPoint {
    glm::dvec3 place;  ///< Apparent place, sonar axes [m].
    double focus;      ///< Intensity relative to straight rays of the same range [1].
};

/** Velocities above which motion within a ping changes it: by half a bin at the far edge, or by half the width of a
 *  beam (ACOUSTICS.md 12). */
struct MotionBound {
    double speed;  ///< [m/s]
    double turn;   ///< [rad/s]
};
MotionBound motionBound(const SonarConfig& config, const BinGrid& grid);

/** Returns the range that a chirp adds to an echo per m/s at which its object recedes, f T / B [s]. 0 without a chirp
 *  or without motion within a ping. */
double dopplerCoupling(const SonarConfig& config);

/** Sound paths that are not straight to the places of objects: bent by a sound speed profile, or because sonar and
 *  objects move and turn while sound travels. The place that returns an echo depends on the echo's direction and slant
 *  range (ACOUSTICS.md 5.19, 5.20).
 *
 *  The ray-tracer owns them instead of a PingEffect. Two effects, refraction and motion, share one object. It replaces
 *  how rays are traced and how planes become cells, which a call per tile could not do. */
class RayPaths {
public:
    static constexpr double max_focus = 4;  ///< Bound at caustics, where ray theory gives infinity [1].

    /** Needs a plan with refraction or motion within a ping. Plan and geometry outlive the paths. */
    RayPaths(const RenderPlan& plan, const types::Geometry& geometry);

    /** Switches to another geometry from the next ping on. */
    void setScene(const types::Geometry& geometry);
    /** Computes the paths of a ping; call it once per ping. Allocates nothing after the second. */
    void place(const types::Snapshot& snapshot);
    /** Returns whether all paths of this ping are effectively straight: nothing is bent, and nothing moves enough. */
    bool areStraight() const { return !table_ && !moves_; }
    /** Returns the motion of an object in this ping; null where it is at rest. */
    const Drift* drift(uint32_t object) const { return moves_ ? motion_->drift(object) : nullptr; }
    /** Returns the motion of one triangle of an object; fills `own` if the object deforms. */
    const Drift* findDrift(uint32_t object, uint32_t triangle, Drift& own) const {
        return moves_ ? motion_->findDrift(object, triangle, own) : nullptr;
    }
    /** Returns where an echo from a unit direction at a slant range [m] was returned: its place about the sonar when
     *  the pulse was sent [m]. `drift`: motion of its object. */
    glm::dvec3 at(const glm::dvec3& direction, double range, const Drift* drift = nullptr) const;
    /** Returns ranges between which all paths are nearly straight, from 0 [m]. */
    std::span<const double> corners() const { return corners_; }
    /** Returns the apparent plane of normal . place = distance, for a direction near a range [m]. */
    ApparentPlane apparent(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                           const Drift* drift) const;
    /** Returns the apparent place of a point target of this ping, as if its echo arrived along a straight ray: the
     *  place nearest to the straight one. `place`: of the target when the pulse was sent, sonar axes [m]. None where no
     *  path reaches it, as in a shadow. */
    std::optional<EchoPoint> received(const glm::dvec3& place, size_t target) const;
    /** Returns the max inverse range of echoes from places at an inverse distance or farther [1/m]. */
    double nearLimit(double inverse_distance) const;

private:
    void placeMotion(const types::Snapshot& snapshot);
    void placeCorners();
    /** Returns where a point that moves by `drift` was when the pulse was sent, over straight rays [m]. */
    glm::dvec3 movedBy(const glm::dvec3& direction, double range, const Drift* drift) const;
    double computeRange(const glm::dvec3& normal, double distance, const glm::dvec3& direction, double near,
                        const Drift* drift) const;

    const RenderPlan& plan_;
    std::optional<RayTable> table_;
    std::optional<Motion> motion_;
    double coupling_;  ///< dopplerCoupling() [s].
    double share_;     ///< Share of a turn during the flight by which echoes are turned [1].
    double stretch_;   ///< No point is further away than its slant range times this, apart from the coupling [1].
    glm::dmat3 world_from_sonar_{1};  ///< [1]
    bool moves_ = false;
    glm::dvec3 velocity_{0}, turn_{0};  ///< Motion of the sonar, in sonar axes [m/s], [rad/s].
    double fastest_ = 0;                ///< Max speed at which any point approaches or recedes [m/s].
    std::vector<double> corners_;
};

}  // namespace insonify::sonar
