#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "components/sonar/echo/EchoShape.hpp"
#include "components/sonar/fan/BeamFan.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/ways/TargetWays.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

class EchoField;

/** Adds the point targets of a scene to pings: the active sonar equation at each target's own place, with the pattern
 *  of each beam there and the pulse about its own range (ACOUSTICS.md 5.14). What stands before a target hides it. */
class PointTargets {
public:
    /** Of a plan for model `physical`; plan and geometry must outlive it. */
    PointTargets(const RenderPlan& plan, const types::Geometry& geometry);

    /** Another geometry from the next ping on; the plan may be another one as well. */
    void takeScene(const types::Geometry& geometry);
    /** Once the bins are filled, or `field` is, where there is one; how many targets any beam hears. `bent`: the ways
     * of this ping, null where they are straight. Allocates nothing where nothing reflects. */
    size_t add(const types::Snapshot& snapshot, types::Sonar& ping, EchoField* field, const RayPaths* bent);

    /** Adds an echo that comes back the way it went, in the same place of the same ping, but for what hides it. Returns
     *  whether any beam has it. */
    bool addAlong(const TargetWay& way, double strength_db, types::Sonar& ping, EchoField* field);

    /** Whether any beam may hear a direction, a unit vector in the sonar's axes. Quick: false is certain. */
    bool mayHear(const glm::dvec3& direction) const;

private:
    /** One echo of a target: out one way, back another or the same. */
    struct Return {
        double range;  ///< Half of the way out and back [m].
        BeamAngles sent, heard;
        double intensity;  ///< But for patterns and the pulse [1/m^2].
        double sign;       ///< -1 where the water surface has turned its pressure round [1].
        double in_phase;   ///< Share of its amplitude that rough mirrors leave in phase [1].
    };
    /** None behind a straight array. */
    std::optional<BeamAngles> directionOf(const glm::dvec3& way) const;
    std::optional<Return> returnOf(const TargetWay& out, const TargetWay& back, double strength_db) const;
    /** None where it is not heard. */
    static std::optional<TargetWay> bentWay(const RayPaths& bent, const types::Snapshot& snapshot, size_t target);
    double powerIn(const Beam& beam, const Return& echo) const;
    /** Sign or phase of the field pattern there, of magnitude 1. */
    std::complex<double> phaseIn(const Beam& beam, const Return& echo) const;
    /** Fills means_ for bins from `first` on; whether there is any. */
    bool spread(double range);
    bool addTo(types::Sonar& ping, const Return& echo) const;
    bool addTo(EchoField& field, const Return& echo, uint64_t key) const;
    /** What a rough surface leaves in phase along a way [1]. */
    double inPhase(const TargetWay& way) const;

    const RenderPlan& plan_;
    std::optional<TargetWays> ways_;
    double absorption_;  ///< Two-way, of intensity [1/m].
    std::optional<EchoShape> shape_;
    std::vector<double> means_;  ///< Of h, for bins from first_bin_ on [1].
    size_t first_bin_ = 0;
};

}  // namespace insonify::sonar
