#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/EchoShape.hpp"
#include "components/sonar/multipath/TargetPaths.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::sonar {

class EchoField;

/** Adds the point targets of a scene to pings by the active sonar equation at each target's own place. The pattern of
 *  each beam is evaluated there, and the pulse about its own range (ACOUSTICS.md 5.14). Surfaces in front of a target
 *  hide it, except for thin walls. */
class PointTargets {
public:
    /** Needs a plan for model `physical`. Plan and geometry must outlive it. */
    PointTargets(const RenderPlan& plan, const types::Geometry& geometry);

    /** Switches to another geometry from the next ping on; the plan may have changed as well. */
    void setScene(const types::Geometry& geometry);
    /** Adds the echoes once the bins or the field are filled. Returns the number of targets with an echo in any beam.
     *  Allocates nothing where nothing reflects. */
    size_t add(PingInMaking& to);

    /** Adds an echo that returns along the same path, within the same ping, ignoring occlusion. Returns
     *  whether any beam has it. */
    bool addAlong(const TargetPath& path, double strength_db, PingInMaking& to);

    /** Returns whether any beam may receive from a direction, a unit vector in the sonar's axes. Quick: false is
     *  certain. */
    bool mayReceive(const glm::dvec3& direction) const;

private:
    /** One echo of a target: out along one path, back along another or the same. */
    struct Return {
        double range;  ///< Half of the two-way path [m].
        BeamAngles sent, received;
        double intensity;  ///< Without patterns and pulse [1/m^2].
        double sign;       ///< -1 where the water surface has inverted its pressure [1].
        double in_phase;   ///< Share of its amplitude that rough mirrors leave in phase [1].
        bool passes_walls;
    };
    /** Returns the beam angles of a path; none behind a straight array. */
    std::optional<BeamAngles> computeDirection(const glm::dvec3& direction) const;
    std::optional<Return> computeReturn(const TargetPath& out, const TargetPath& back, double strength_db) const;
    /** Returns the bent path to a target; none where there is no path. */
    static std::optional<TargetPath> findBentPath(const RayPaths& bent, const types::Snapshot& snapshot, size_t target);
    double powerIn(const Beam& beam, const Return& echo) const;
    /** Returns the sign or phase of the field pattern there, of magnitude 1. */
    std::complex<double> phaseIn(const Beam& beam, const Return& echo) const;
    /** Fills means_ for bins from `first_bin_`. Returns whether there are any. */
    bool spread(double range);
    /** Adds the echo of a pair of paths; `key` identifies the pair. Returns whether any beam has it. */
    bool addPair(const TargetPath& out, const TargetPath& back, double strength_db, PingInMaking& to, uint64_t key);
    /** Adds the echoes along a path through walls that ring. */
    bool addRinging(const TargetPath& path, double strength_db, PingInMaking& to, uint64_t key);
    /** Adds the echoes out along one path and back along another, through walls that ring. */
    bool addRinging(const TargetPath& out, const TargetPath& back, double strength_db, PingInMaking& to, uint64_t key);
    bool addTo(PingInMaking& to, const Return& echo) const;
    bool addTo(EchoField& field, const Return& echo, uint64_t key) const;
    /** Returns the share of the amplitude that rough mirrors leave in phase along a path [1]. */
    double inPhase(const TargetPath& path) const;

    const RenderPlan& plan_;
    std::optional<WallSights> walls_;  ///< None where no sound passes walls.
    std::optional<TargetPaths> paths_;
    double absorption_;  ///< Two-way loss of intensity [1/m].
    std::optional<EchoShape> shape_;
    std::vector<double> means_;  ///< Means of h, for bins from first_bin_ [1].
    size_t first_bin_ = 0;
};

}  // namespace insonify::sonar
