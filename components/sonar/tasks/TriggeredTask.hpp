#pragma once
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/renderer/QualityKeeper.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/text/Notice.hpp"

namespace insonify::sonar {

/** Takes the scene, the sonar pose and the time of each ping.
 *
 *  Each snapshot gives one ping, at its time and sonar pose; in realtime only the newest snapshot does. With
 *  `given_pose` connected, each pose received there gives one ping, in the newest snapshot's scene.
 *
 *  With `settings` connected, each sample received there gives one ping and snapshots give none, as the driver of a
 *  device requests pings. The ping is at the time of the request, in the newest snapshot's scene. Requests wait for the
 *  first snapshot. In realtime only the newest waiting request is used; the others give no ping. Values in the request
 *  become the values of the properties with the same names, and stay. Settings that the sonar cannot have lead to
 *  RunTimeError and no ping.
 *
 *  Refuses a pose that cannot be used (not finite, a quaternion of no length), a snapshot without geometry, and a
 *  snapshot that moves an object outside its geometry. In realtime it also refuses a snapshot whose time is more than a
 *  second ahead of the clock. A quaternion that is not of unit length is normalised. A sonar that moved faster than a
 *  tenth of the speed of sound since the last snapshot counts as repositioned. A warning reports it, and the ping gets
 *  no velocity from that displacement. */
class TriggeredTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::InputPort<types::SnapshotPtr> snapshot{this, "snapshot", "sonar pose and scene at one instant"};
    framework::InputPort<types::Pose> given_pose{
        this, "given_pose",
        "drives the task in place of snapshots: the sonar in the world for each ping, as recorded from `pose`",
        framework::Need::Optional};
    framework::InputPort<types::SonarSettings> settings{this, "settings",
                                                        "drives the task in place of snapshots: one ping for each "
                                                        "request, with its settings, in the newest snapshot's scene",
                                                        framework::Need::Optional};
    /** Returns the configuration of the sonar to render. */
    virtual SonarConfig sonarConfig() const = 0;

protected:
    /** Returns whether the sonar moved faster than a tenth of the speed of sound since the snapshot before. */
    bool jumped() const { return jumped_; }
    const BinGrid& grid() const { return grid_; }
    double echoTime() const { return 2 * grid_.range_max / grid_.speed_of_sound; }  ///< To the range and back [s].
    /** Returns the shortest time between two snapshots so far [s]; infinite before the second. */
    double shortestPeriod() const { return shortest_; }
    /** Returns the period of the pings in realtime [s]; 0 where it is not known, or not in realtime. */
    double realtimePeriod() const;

    /** Properties and their new numbers; none: the default. */
    using Changes = std::map<std::string, std::optional<double>>;
    /** Returns the requested settings that differ from the configuration, named as for a fan of beams. */
    virtual Changes changedBy(const types::SonarSettings& requested) const;
    /** Sets the bearing of a turning head from the next ping on. */
    virtual void turnHead(types::Angle /*bearing*/) {}
    /** Makes the last changes to a snapshot with a valid pose before it is rendered. Returns the reason for refusing
     *  it, or null. */
    virtual const char* setLook(types::Snapshot& /*scene*/) { return nullptr; }

    /** Forgets all snapshots and computes the grid of the current configuration. */
    void resetTrigger();
    /** Takes the input of the next ping, if there is one, into takenScene(), usedPose() and begun(). Returns whether
     * there was one. */
    bool readNext();
    /** Evaluates the input of the next ping. Returns the reason for refusing it, or null. */
    const char* refusal();
    types::Snapshot& takenScene() { return taken_.scene; }
    const types::Snapshot& takenScene() const { return taken_.scene; }
    const types::Pose& usedPose() const { return taken_.used; }  ///< Pose before normalisation.
    types::Time begun() const { return taken_.begun; }           ///< Time at which the input was taken.
    /** Input of one ping. */
    struct Taken {
        types::Snapshot scene;
        types::Pose used;
        types::Time begun;
    };
    const Taken& taken() const { return taken_; }
    /** Swaps the input of the next ping with another, for a ping that is rendered later than it is taken. */
    void swapTaken(Taken& other) { std::swap(taken_, other); }

    void stopHook() override { before_.reset(); }

private:
    /** Time and place of a snapshot. */
    struct Mark {
        types::Time time;
        glm::dvec3 position;
    };
    /** Updates the periods, and evaluates the displacement since the snapshot before. */
    void followSnapshot(const types::Snapshot& scene);
    /** Takes the next pose of `given_pose`, in the newest snapshot's scene. Poses wait until there is a snapshot. */
    bool readInputs();
    /** Takes the scene of a snapshot. In realtime its sonar pose is extrapolated to now, within its
     *  `max_extrapolation`. */
    void setScene(const types::Snapshot& scene);
    void applySettings(const types::SonarSettings& asked);
    /** Takes the next settings (in realtime the newest), in the newest snapshot's scene. They wait until there is a
     *  snapshot. */
    bool consumeRequest();

    BinGrid grid_;
    std::optional<Mark> before_;
    bool jumped_ = false;
    types::RecurringDiagnostic jumps_;
    /** The last jump that was reported: a looping trajectory makes it at each turn. */
    struct Jump {
        glm::dvec3 from{0}, to{0};
    };
    std::optional<Jump> reported_jump_;
    double shortest_ = std::numeric_limits<double>::infinity();
    PeriodMeter period_;
    Taken taken_;
    /** The property `speed_of_sound` before a driver set it; none: no driver has set it since its own was last asked
     *  for. */
    std::optional<std::optional<double>> own_speed_;
};

}  // namespace insonify::sonar
