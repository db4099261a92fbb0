#pragma once
#include <span>

#include "components/sonar/Motion.hpp"
#include "components/sonar/RayPaths.hpp"
#include "components/sonar/TargetWays.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** The ways of sound to point targets where they are not straight: bent by a profile of the speed of sound, or because
 *  sonar and targets move while it is under way (ACOUSTICS.md 5.19, 5.20). */
class BentTargets {
public:
    /** Of a plan with Feature::Refraction or Feature::MotionInPing; both must outlive it. */
    BentTargets(const RenderPlan& plan, const types::Geometry& geometry);

    /** Once a ping. */
    void place(const types::Snapshot& snapshot);
    /** Whether all ways of this ping are as good as straight. */
    bool areStraight() const { return paths_.areStraight(); }
    /** The way to a target of this ping that begins nearest to the straight one; none where there is none, as in a
     *  shadow. Valid until it is asked for another's. */
    std::span<const TargetWay> wayTo(const types::PointTarget& target, size_t index);

private:
    const RenderPlan& plan_;
    RayPaths paths_;
    Motion motion_;
    types::Pose sonar_;
    TargetWay way_;
};

}  // namespace insonify::sonar
