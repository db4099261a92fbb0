#pragma once
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/PingDiagnostics.hpp"
#include "components/sonar/QualityKeeper.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "types/RecurringDiagnostic.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"
#include "types/SonarElements.hpp"
#include "types/SonarReturns.hpp"
#include "types/SonarSettings.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** What the sonar tasks share: one ping for each snapshot, at the snapshot's time and sonar pose.
 *
 *  The renderer is made at the first snapshot, when the geometry is known, and again when the geometry changes. A
 *  snapshot that cannot be rendered (a pose that is not finite, a quaternion of no length, no geometry) leads to
 *  RunTimeError, from which the next good one recovers. A sonar that only more than a tenth of the speed of sound takes
 *  to its new place has been put there: a warning reports it, and the ping is made without a velocity from that way.
 *  In realtime the newest snapshot counts, and a ping is written once the last echo of its range has come back:
 *  2 range / c after its snapshot's time on the deployment's clock, and after the task took it, whichever is later.
 *  Pings thus never overlap. One whose listening is cut off by the stop is not written. A snapshot whose time is a
 *  second ahead of that clock is refused like the others. A quaternion that is not of unit length is normalised. Pings
 *  closer in time than sound's way to the range and back are rendered, each by itself, and told of in the notices. The
 *  quality is given, or a QualityKeeper chooses and keeps it; in realtime the period of the pings is its budget where
 *  nothing is said, as their stamps tell it.
 *
 *  `truth` and `returns` tell of each ping what its bins show, for as long as one of them is connected; nothing is
 *  computed for it otherwise, and the bins are the same either way.
 *
 *  `elements` tells what each element of a straight array heard, of a sonar that is configured to have some.
 *
 *  With `settings` connected there is a ping for each of them, and none else, as the driver of a device asks for it, at
 *  the time of asking in the newest snapshot's scene; they wait for the first snapshot. In realtime the newest of those
 *  that wait counts, and there is no ping for the others. What they name becomes the value of the property of that
 *  name, and stays. Settings that the sonar cannot have lead to RunTimeError, and to no ping.
 *
 *  Of a run that is cut into shards every ping is that of the whole run; its quality is to be given, for what is chosen
 *  depends on the pings before.
 *
 *  `pose` tells where each ping was rendered, carried on as it was; with `given_pose` connected there is a ping for
 *  each of these poses, in the newest snapshot's scene, so that what `pose` has told renders the same pings again. */
class PingTask : public framework::TaskContext, public framework::Planned, public framework::Divisible {
public:
    using TaskContext::TaskContext;
    /** Stops and cleans up: the renderer must go on the task's own thread. */
    ~PingTask() override;

    framework::InputPort<types::SnapshotPtr> snapshot{this, "snapshot", "sonar pose and scene at one instant"};
    framework::InputPort<types::Pose> given_pose{
        this, "given_pose",
        "drives the task in place of snapshots: the sonar in the world for each ping, as `pose` told it",
        framework::Need::Optional};
    framework::InputPort<types::SonarSettings> settings{
        this, "settings",
        "drives the task in place of snapshots: one ping for each of these, as it asks, in the newest snapshot's scene",
        framework::Need::Optional};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "one ping, noiseless, at the time of its snapshot"};
    framework::OutputPort<types::Pose> pose{this, "pose", "the sonar in the world as each ping had it, at its time"};

    framework::OutputPort<types::SonarTruthPtr> truth{
        this, "truth", "which objects the bins show, from where and at which angle; computed only when connected"};
    framework::OutputPort<types::SonarReturnsPtr> returns{
        this, "returns", "first and strongest return of each beam; computed only when connected"};

    framework::OutputPort<types::SonarElementsPtr> elements{
        this, "elements",
        "complex signals of the array's elements, of a sonar with `elements`; computed only when connected"};

    const types::Plan* plan() const override { return plan_ ? &*plan_ : nullptr; }
    std::vector<std::string> notices() const override;
    std::string indivisible() const override;

    /** The sonar to render, as configured. */
    virtual SonarConfig sonarConfig() const = 0;
    /** The same, its files found from where the deployment is. */
    SonarConfig locatedConfig() const;

protected:
    /** Last changes to a snapshot with a valid pose before it is rendered; a reason refuses it. */
    virtual const char* steer(types::Snapshot& /*scene*/) { return nullptr; }
    double binWidth() const { return grid_.bin_width; }  ///< Exact, where `bin_duration` of a ping is rounded [m].
    /** Whether the way from the snapshot before is no motion: faster than a tenth of the speed of sound. */
    bool jumped() const { return jumped_; }
    /** Whether a ping is one rendering. Of several the truth is not told, nor what each of them left out. */
    virtual bool rendersOnce() const { return true; }
    /** Where the time of the last ping went. */
    virtual std::span<const Stage> renderStages(const SonarRenderer& renderer) const { return renderer.stages(); }
    /** Makes the ping of `scene`; whether it has any echo. */
    virtual bool renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample);
    /** Of settings what differs from the configuration: names and YAML of properties, as a fan of beams has them. */
    virtual std::map<std::string, std::string> changedBy(const types::SonarSettings& asked) const;
    /** Where a turning head is to look from the next ping on. */
    virtual void turnHead(types::Angle /*bearing*/) {}
    /** Last changes to a ping before it is written. */
    virtual void stampBearings(types::Sonar& /*sample*/) {}
    /** A ping has been rendered or rehearsed: a head that turns goes on. */
    virtual void goOn() {}
    /** What else there is to tell of a ping that is about to be written, from where it was rendered. */
    virtual void tellMore(const types::Sonar& /*sample*/, const types::Pose& /*sonar*/) {}
    /** Of a sonar that looks where this one does in one ping, to tell why it hears nothing. */
    virtual RenderPlan coverage(const types::Snapshot& scene) const;
    /** Pings in which a turning head comes round [1]. */
    virtual int pingsPerTurn() const { return 1; }

    bool configureHook() override;
    /** A property that is set holds from the next ping on. */
    bool propertiesHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void stopHook() override { before_.reset(); }
    void cleanupHook() override { renderer_.reset(); }

private:
    /** Time and place of a snapshot. */
    struct Mark {
        types::Time time;
        glm::dvec3 position;
    };
    /** Evaluates the time and way since the snapshot before. */
    void followSnapshot(const types::Snapshot& scene);
    double echoTime() const { return 2 * grid_.range_max / grid_.speed_of_sound; }  ///< To the range and back [s].
    void render();
    /** Does what later pings depend on. */
    void rehearse();
    /** What the ping that is rendered next is to tell; null where nobody wants to know. */
    std::shared_ptr<types::SonarTruth> takeTruth();
    void writeElements(const types::Sonar& sample);
    void writeTruth(const types::Sonar& sample, const std::shared_ptr<types::SonarTruth>& told);
    /** The next of `given_pose`, in the newest snapshot's scene. */
    bool takeGiven();
    /** The scene of a snapshot, in realtime with its sonar where it is by now, as far as it may be carried on. */
    void aim(const types::Snapshot& scene);
    void applySettings(const types::SonarSettings& asked);
    /** The next settings, in realtime the newest, in the newest snapshot's scene; they wait until there is one. */
    bool takeAsked();
    /** What the next ping is of; in realtime the newest. */
    bool takeNext();
    /** In realtime, until the last echo of this ping's range is back; false: the task is to stop. */
    bool waitForLastEcho();
    void makeRenderer();
    /** What is to be told of a ping in which there may be nothing. */
    std::string diagnosticOf(bool heard, const types::Sonar& sample);
    /** Looks after the quality once a ping has been rendered, in `ms`; may render it again. */
    void followQuality(types::Sonar& sample, double ms);

    BinGrid grid_;
    std::optional<Mark> before_;
    bool jumped_ = false;
    types::RecurringDiagnostic jumps_;
    double shortest_ = std::numeric_limits<double>::infinity();  ///< Time between two snapshots so far [s].
    PeriodMeter period_;
    std::unique_ptr<SonarRenderer> renderer_;
    std::optional<QualityKeeper> quality_;  ///< None where the quality is given.
    std::optional<PingDiagnostics> diagnostics_;
    bool culling_untold_ = false;      ///< Whether the plan does not say yet what the first ping's culling left out.
    std::optional<types::Plan> plan_;  ///< Outlives the renderer, for the summary.
    bool plan_told_ = false;           ///< Whether the record has the plan as it is.
    types::GeometryPtr geometry_;      ///< The renderer's.
    types::Snapshot aimed_;
    types::Pose used_;   ///< The sonar in `aimed_`, as it came.
    types::Time begun_;  ///< When it was taken.
    framework::SamplePool<types::Sonar> pool_;
    framework::SamplePool<types::SonarTruth> truths_;
    framework::SamplePool<types::SonarReturns> all_returns_;
    framework::SamplePool<types::SonarElements> signals_;
};

/** Why a pose cannot be used, null when it can; makes its quaternion one of unit length. */
const char* normalisePose(types::Pose& pose);

}  // namespace insonify::sonar
