#pragma once
#include <memory>
#include <optional>
#include <span>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/sonar/AimedTask.hpp"
#include "components/sonar/OthersHeard.hpp"
#include "components/sonar/PingDiagnostics.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/sonar/quality/QualityKeeper.hpp"
#include "types/Sonar.hpp"
#include "types/SonarElements.hpp"
#include "types/SonarReturns.hpp"
#include "types/SonarTruth.hpp"
#include "types/Transmission.hpp"

namespace insonify::sonar {

/** What the sonar tasks share: a ping of each scene that an AimedTask aims at.
 *
 *  The renderer is made at the first ping, when the geometry is known. When the geometry changes it keeps its threads,
 *  its quality and what it has made of meshes that are still there. What cannot be rendered leads to RunTimeError, from
 *  which the next good ping recovers. In realtime a ping is written once the last echo of its range has come back:
 *  2 range / c after its snapshot's time on the deployment's clock, and after the task took it, whichever is later.
 *  Pings thus never overlap. One whose listening is cut off by the stop is not written. Pings closer in time than
 *  sound's way to the range and back are rendered, each by itself, and told of in the notices. The quality is given, or
 *  a QualityKeeper chooses and keeps it; in realtime the period of the pings is its budget where nothing is said, as
 *  their stamps tell it.
 *
 *  `truth` and `returns` tell of each ping what its bins show, for as long as one of them is connected; nothing is
 *  computed for it otherwise, and the bins are the same either way. `elements` tells what each element of a straight
 *  array heard, of a sonar that is configured to have some. `pose` tells where each ping was rendered, carried on as it
 *  was, so that it renders the same pings again as `given_pose`.
 *
 *  With `others` connected a ping is rendered once its last echo could have come, with all pulses of other sonars that
 *  were sent until then. In lockstep that is at the first sample after it, or when the next ping begins; a ping that is
 *  still listened to at the stop is not written, and a notice counts it.
 *
 *  Of a run that is cut into shards every ping is that of the whole run; its quality is to be given, for what is chosen
 *  depends on the pings before. */
class PingTask : public AimedTask, public framework::Planned, public framework::Divisible {
public:
    using AimedTask::AimedTask;
    /** Stops and cleans up: the renderer must go on the task's own thread. */
    ~PingTask() override;

    framework::OutputPort<types::SonarPtr> ping{this, "ping", "one ping, noiseless, at the time of its snapshot"};
    framework::OutputPort<types::Pose> pose{this, "pose", "the sonar in the world as each ping had it, at its time"};

    framework::OutputPort<types::SonarTruthPtr> truth{
        this, "truth", "which objects the bins show, from where and at which angle; computed only when connected"};
    framework::OutputPort<types::SonarReturnsPtr> returns{
        this, "returns", "first and strongest return of each beam; computed only when connected"};

    framework::OutputPort<types::TransmissionPtr> transmission{
        this, "transmission", "each ping as it is sent, for the port `others` of other sonars"};
    framework::InputPort<types::TransmissionPtr> others{
        this, "others", "pings of other sonars, which a sonar with `crosstalk` hears; connect with a buffer",
        framework::Need::Optional};

    framework::OutputPort<types::SonarElementsPtr> elements{
        this, "elements",
        "complex signals of the array's elements, of a sonar with `elements`; computed only when connected"};

    const types::Plan* plan() const override { return plan_ ? &*plan_ : nullptr; }
    std::vector<std::string> notices() const override;
    std::string indivisible() const override;

    /** Sets the number of threads of the next renderer; 0: the number of cores. */
    void useThreads(int threads) { threads_ = threads; }
    /** Cleans up and configures a stopped task, which then pings as if it had just been made. Keeps the renderer's
     *  data of the scene if no ping depends on the pings before. */
    framework::Outcome restart();

    /** The sonar as configured, its files found from where the deployment is. */
    SonarConfig locatedConfig() const;

protected:
    /** Whether a ping is one rendering. What each of several left out is not reported. */
    virtual bool rendersOnce() const { return true; }
    /** Where the time of the last ping went. */
    virtual std::span<const Stage> renderStages(const SonarRenderer& renderer) const { return renderer.stages(); }
    /** Makes the ping of `scene`, and its truth unless `truth_of_ping` is null; returns whether it has any echo. */
    virtual bool renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                            types::SonarTruth* truth_of_ping);
    /** Whether somebody is connected who takes truth. */
    virtual bool wantsTruth() const { return truth.connected() || returns.connected(); }
    /** Gives a truth the names of all objects. */
    void nameObjects(types::SonarTruth& truth_of_ping) const;
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
    void stopHook() override;
    void cleanupHook() override { renderer_.reset(); }

private:
    /** Takes the next ping, if there is one, and sends its pulse. Returns whether it can be rendered. */
    bool begin();
    void prepareTransmission();
    /** Writes the pulse of the ping that begins. */
    void transmit();
    /** Renders what has been begun, and goes on. */
    void complete();
    void hearOthers();
    /** Takes pings whose rendering waits until all pulses of others have arrived. */
    void listen();
    /** Renders the ping that is listened to, with what arrived meanwhile. */
    void endListening();
    void render();
    /** Does what later pings depend on. */
    void rehearse();
    /** What the ping that is rendered next is to tell; null where nobody wants to know. */
    std::shared_ptr<types::SonarTruth> takeTruth();
    void writeElements(const types::Sonar& sample);
    void writeTruth(const types::Sonar& sample, const std::shared_ptr<types::SonarTruth>& told);
    /** In realtime, when the last echo of this ping's range is back. */
    types::Time lastEcho() const;
    /** In realtime, until then; false: the task is to stop. */
    bool waitForLastEcho();
    /** Makes the renderer, or gives it the geometry of the next ping. */
    void prepareRenderer();
    void takePlan();
    /** What is to be told of a ping in which there may be nothing. */
    std::string diagnosticOf(bool heard, const types::Sonar& sample);
    /** Looks after the quality once a ping has been rendered, in `ms`; may render it again. */
    void followQuality(types::Sonar& sample, double ms);

    std::unique_ptr<SonarRenderer> renderer_;
    std::optional<QualityKeeper> quality_;  ///< None where the quality is given.
    std::optional<PingDiagnostics> diagnostics_;
    bool culling_untold_ = false;      ///< Whether the plan does not say yet what the first ping's culling left out.
    int threads_ = 0;                  ///< Of the renderer [1].
    std::optional<types::Plan> plan_;  ///< Outlives the renderer, for the summary.
    bool plan_told_ = false;           ///< Whether the record has the plan as it is.
    types::GeometryPtr geometry_;      ///< The renderer's.
    types::Transmission transmitted_;  ///< All but time and place; made for the first ping.
    OthersHeard others_heard_;
    std::optional<Taken> listening_;  ///< The ping that is listened to.
    double render_seconds_ = 0;       ///< Time that the last ping took [s].
    uint64_t cut_off_ = 0;            ///< Pings that were still listened to at the stop [1].
    framework::SamplePool<types::Sonar> pool_;
    framework::SamplePool<types::SonarTruth> truths_;
    framework::SamplePool<types::SonarReturns> all_returns_;
    framework::SamplePool<types::SonarElements> signals_;
};

}  // namespace insonify::sonar
