#pragma once
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/sonar/fan/BinGrid.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "components/sonar/quality/QualityKeeper.hpp"
#include "types/RecurringDiagnostic.hpp"
#include "types/Snapshot.hpp"
#include "types/SonarSettings.hpp"

namespace insonify::sonar {

/** Decides of what the next ping is: when it is, and where the sonar is in which scene.
 *
 *  There is a ping for each snapshot, at its time and sonar pose; in realtime for the newest. With `given_pose`
 *  connected there is one for each of these poses, in the newest snapshot's scene.
 *
 *  With `settings` connected there is a ping for each of them, and none else, as the driver of a device asks for it, at
 *  the time of asking in the newest snapshot's scene; they wait for the first snapshot. In realtime the newest of those
 *  that wait counts, and there is no ping for the others. What they name becomes the value of the property of that
 *  name, and stays. Settings that the sonar cannot have lead to RunTimeError, and to no ping.
 *
 *  Refused are a pose that cannot be used (not finite, a quaternion of no length), a snapshot without geometry or one
 *  that moves an object beyond it, and in realtime one whose time is a second ahead of the clock. A quaternion that is
 *  not of unit length is normalised. A sonar that only more than a tenth of the speed of sound takes to its new place
 *  has been put there: a warning reports it, and the ping is made without a velocity from that way. */
class AimedTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::InputPort<types::SnapshotPtr> snapshot{this, "snapshot", "sonar pose and scene at one instant"};
    framework::InputPort<types::Pose> given_pose{
        this, "given_pose",
        "drives the task in place of snapshots: the sonar in the world for each ping, as `pose` told it",
        framework::Need::Optional};
    framework::InputPort<types::SonarSettings> settings{
        this, "settings",
        "drives the task in place of snapshots: one ping for each of these, as it asks, in the newest snapshot's scene",
        framework::Need::Optional};
    /** The sonar to render, as configured. */
    virtual SonarConfig sonarConfig() const = 0;

protected:
    /** Whether the way from the snapshot before is no motion: faster than a tenth of the speed of sound. */
    bool jumped() const { return jumped_; }
    const BinGrid& grid() const { return grid_; }
    double binWidth() const { return grid_.bin_width; }  ///< Exact, where `bin_duration` of a ping is rounded [m].
    double echoTime() const { return 2 * grid_.range_max / grid_.speed_of_sound; }  ///< To the range and back [s].
    /** The shortest time between two snapshots so far [s]; infinite before the second. */
    double shortestPeriod() const { return shortest_; }
    /** The period of the pings in realtime; 0: not known, or not in realtime [s]. */
    double realtimePeriod() const;

    /** Of settings what differs from the configuration: names and YAML of properties, as a fan of beams has them. */
    virtual std::map<std::string, std::string> changedBy(const types::SonarSettings& asked) const;
    /** Where a turning head is to look from the next ping on. */
    virtual void turnHead(types::Angle /*bearing*/) {}
    /** Last changes to a snapshot with a valid pose before it is rendered; a reason refuses it. */
    virtual const char* steer(types::Snapshot& /*scene*/) { return nullptr; }

    /** Forgets all snapshots, for a sonar with another grid. */
    void resetAim();
    /** Takes what the next ping is of, if anything is there: aimed(), usedPose() and begun() are of it. */
    bool takeNext();
    /** Evaluates it; why it is refused, null where it is not. */
    const char* refusal();
    types::Snapshot& aimed() { return taken_.scene; }
    const types::Snapshot& aimed() const { return taken_.scene; }
    const types::Pose& usedPose() const { return taken_.used; }  ///< The sonar in aimed(), as it came.
    types::Time begun() const { return taken_.begun; }           ///< When it was taken.
    /** What a ping is of. */
    struct Taken {
        types::Snapshot scene;
        types::Pose used;
        types::Time begun;
    };
    const Taken& taken() const { return taken_; }
    /** Swaps what the next ping is of with another, for a ping that is rendered later than it is taken. */
    void swapTaken(Taken& other) { std::swap(taken_, other); }

    void stopHook() override { before_.reset(); }

private:
    /** Time and place of a snapshot. */
    struct Mark {
        types::Time time;
        glm::dvec3 position;
    };
    /** Evaluates the time and way since the snapshot before. */
    void followSnapshot(const types::Snapshot& scene);
    /** The next of `given_pose`, in the newest snapshot's scene. */
    bool takeGiven();
    /** Takes the scene of a snapshot, in realtime with its sonar where it is by now, as far as it may be carried on. */
    void takeScene(const types::Snapshot& scene);
    void applySettings(const types::SonarSettings& asked);
    /** The next settings, in realtime the newest, in the newest snapshot's scene; they wait until there is one. */
    bool takeAsked();

    BinGrid grid_;
    std::optional<Mark> before_;
    bool jumped_ = false;
    types::RecurringDiagnostic jumps_;
    double shortest_ = std::numeric_limits<double>::infinity();
    PeriodMeter period_;
    Taken taken_;
};

}  // namespace insonify::sonar
