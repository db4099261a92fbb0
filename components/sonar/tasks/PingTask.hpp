#pragma once
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/sonar/base/Counters.hpp"
#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/multipath/OtherSonars.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/QualityKeeper.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/TriggeredTask.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarElements.hpp"
#include "types/samples/SonarReturns.hpp"
#include "types/samples/SonarTruth.hpp"
#include "types/samples/Transmission.hpp"

namespace insonify::sonar {

/** Base of the sonar tasks: renders one ping for each input that a TriggeredTask takes.
 *
 *  The renderer is made at the first ping, when the geometry is known. When the geometry changes, the renderer keeps
 *  its threads, its quality and its data of meshes that are still in use. When a property changes, such as the range
 *  that a driver requests, it keeps its threads, its quality and its data of the scene. A scene that cannot be rendered
 * leads to RunTimeError, from which the next good ping recovers. In realtime a ping is written once the last echo of
 * its range has arrived. That is 2 range / c after its snapshot's time on the deployment's clock, or after the task
 * took it, whichever is later. Pings thus never overlap. A ping that is still waiting for echoes at the stop is not
 * written. Pings closer in time than the travel time to the range and back are rendered independently, and a notice
 * reports them. The quality is given, or a QualityKeeper chooses and keeps it. In realtime its default budget is the
 * period of the pings, from their time stamps.
 *
 *  `truth` and `returns` describe what the bins of each ping show, while one of them is connected. Otherwise nothing is
 *  computed for them; the bins are the same either way. `elements` contains the signal of each element of a straight
 *  array, for a sonar that is configured to have one. `pose` records where each ping was rendered, after extrapolation,
 *  so that its values on `given_pose` render the same pings again.
 *
 *  With `others` connected, a ping is rendered once its last echo could have arrived, with all pulses of other sonars
 *  that were sent until then. In lockstep that is at the first sample after it, or when the next ping begins. A ping
 *  that still waits for pulses at the stop is not written, and a notice counts it.
 *
 *  In a run that is divided into shards every ping is that of the whole run. Its quality has to be given, because a
 *  chosen quality depends on the pings before. */
class PingTask : public TriggeredTask,
                 public framework::Planned,
                 public framework::Divisible,
                 public framework::Adjustable,
                 public framework::ReturnSource {
public:
    using TriggeredTask::TriggeredTask;
    /** Stops and cleans up, if that is due: the renderer must be destroyed on the task's own thread. */
    ~PingTask() override;

    framework::OutputPort<types::SonarPtr> ping{this, "ping", "one ping, noiseless, at the time of its snapshot"};
    framework::OutputPort<types::Pose> pose{this, "pose", "the sonar in the world at each ping, at its time"};

    framework::OutputPort<types::SonarTruthPtr> truth{
        this, "truth", "which objects the bins show, from where and at which angle; computed only when connected"};
    framework::OutputPort<types::SonarReturnsPtr> returns{
        this, "returns", "first and strongest return of each beam; computed only when connected"};

    framework::OutputPort<types::TransmissionPtr> transmission{
        this, "transmission", "each ping as it is sent, for the port `others` of other sonars"};
    framework::InputPort<types::TransmissionPtr> others{
        this, "others", "pings of other sonars, which a sonar with `crosstalk` receives; connect with a buffer",
        framework::Need::Optional};

    framework::OutputPort<types::SonarElementsPtr> elements{
        this, "elements",
        "complex signals of the array's elements, of a sonar with `elements`; computed only when connected"};

    framework::Operation<std::string(double, double)> explain{
        this, "explain",
        "what made the bin at a bearing [deg] and a slant range [m] of the last ping; empty while that is being found "
        "on another thread: call again",
        [this](double bearing_deg, double range) {
            return explainAt({bearing_deg, range});
        }};

    const types::Plan* plan() const override { return plan_ ? &*plan_ : nullptr; }
    types::Notices notices() const override;
    /** Reports files of sound speeds and of beams that cannot be used. */
    void check(types::Diagnostics& diagnostics) const override;
    std::string indivisible() const override;
    types::ReturnRules returnRules() const override { return makeReturnRules(sonarConfig()); }

    /** Returns what all pings have counted; those that only measure the quality do not count. Read when stopped. */
    const CountedPings& counted() const { return counted_; }
    /** Sets the number of threads of the next renderer; 0: the number of cores. */
    void useThreads(int threads) { threads_ = threads; }
    /** Cleans up and configures a stopped task, which then pings as if it had just been made. Keeps the renderer's data
     *  of the scene if no ping depends on the pings before. */
    framework::Outcome restart();

    /** Returns the configured sonar, with paths of files resolved against the deployment's folder. */
    SonarConfig locatedConfig() const;

    /** A beam of the last ping, for explainBin(): the scene with its sonar pose, the quality, and the beam in it. */
    struct RenderedBeam {
        SonarConfig config;
        types::Snapshot scene;
        std::optional<size_t> beam;  ///< None: the sum over all beams.
    };
    /** Returns a beam of the last ping, in the ping's order. Call it on the task's thread, or when stopped. Throws
     *  std::runtime_error before the first ping. */
    virtual RenderedBeam renderedBeam(size_t beam) const;

protected:
    /** Returns whether a ping is one rendering. The parts that each of several renderings omits are not reported. */
    virtual bool rendersOnce() const { return true; }
    /** Returns the number of threads that share a rendering; 0: the number of cores [1]. */
    virtual int renderThreads() const { return threads_; }
    /** Returns the time that the last ping spent in each stage. */
    virtual std::span<const Stage> renderStages(const SonarRenderer& renderer) const { return renderer.stages(); }
    /** Makes the ping of `scene`, and its truth unless `truth_of_ping` is null. Returns whether it has any echo. */
    virtual bool renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                            types::SonarTruth* truth_of_ping);
    /** Returns whether an output that needs truth is connected. */
    virtual bool wantsTruth() const { return truth.connected() || returns.connected(); }
    /** Copies the names of all objects into a truth. */
    void nameObjects(types::SonarTruth& truth_of_ping) const;
    /** Returns what a detector knows of the pings of the renderer. */
    const DetectionRules& detectionRules();
    /** Makes the last changes to a ping before it is written. */
    virtual void stampBearings(types::Sonar& /*sample*/) {}
    /** Advances a turning head after a ping has been rendered or rehearsed. */
    virtual void goOn() {}
    /** Writes the other outputs of a ping that is about to be written, from the pose where it was rendered. */
    virtual void writeMore(const types::Sonar& /*sample*/, const types::Pose& /*sonar*/) {}
    /** Fills the number of the strongest bin of each beam of a ping; bin_count: none. */
    virtual void findStrongest(const types::Sonar& sample, std::vector<uint32_t>& strongest) {
        findStrongest(sample, detectionRules(), strongest);
    }
    void findStrongest(const types::Sonar& sample, const DetectionRules& rules, std::vector<uint32_t>& strongest);
    /** Returns the plan of a sonar that covers in one ping what this sonar covers, to explain missing echoes. */
    virtual RenderPlan coverage(const types::Snapshot& scene) const;
    /** Returns the pings of one revolution of a turning head [1]. */
    virtual int pingsPerTurn() const { return 1; }

    bool configureHook() override;
    /** Applies a property that is set, from the next ping on. */
    bool propertiesHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void stopHook() override;
    void cleanupHook() override;

private:
    using Place = std::pair<double, double>;  ///< Bearing and slant range [deg, m].
    std::string explainAt(const Place& place);
    /** Starts to explain the bin at a place of the last ping. Throws std::runtime_error where the ping has no bin. */
    void beginExplanation(const Place& place);
    /** Takes the next ping, if there is one, and sends its pulse. Returns whether it can be rendered. */
    bool begin();
    void prepareTransmission();
    /** Writes the pulse of the ping that begins. */
    void transmit();
    /** Renders the ping that has begun, and advances. */
    void complete();
    void receiveOthers();
    /** Takes pings whose rendering waits until all pulses of others have arrived. */
    void listen();
    /** Renders the ping that waits for pulses, with those that arrived meanwhile. */
    void endListening();
    void render();
    /** Does only the work of a ping on which later pings depend. */
    void rehearse();
    /** Returns the truth that the next ping fills; null where no output needs it. */
    std::shared_ptr<types::SonarTruth> acquireTruth();
    void writeTruth(const types::Sonar& sample, const std::shared_ptr<types::SonarTruth>& reported);
    /** Returns the time in realtime at which the last echo of this ping's range is back. */
    types::Time lastEcho() const;
    /** Waits in realtime until lastEcho(). Returns false if the task is to stop. */
    bool waitForLastEcho();
    /** Makes the renderer, or switches it to the geometry and the configuration of the next ping. */
    void prepareRenderer();
    void makeRenderer();
    /** Switches the renderer to the present configuration, at the quality that it has. */
    void changeRenderer();
    void updatePlan();
    /** Returns the diagnostic of a ping that may be empty. */
    std::string findDiagnostic(bool received, const types::Sonar& sample);
    /** Updates the quality after a ping that took `ms` to render; may render it again. */
    void followQuality(types::Sonar& sample, double ms);

    std::unique_ptr<SonarRenderer> renderer_;
    std::optional<QualityKeeper> quality_;  ///< None where the quality is given.
    std::optional<PingDiagnostics> diagnostics_;
    std::optional<DetectionRules> rules_;  ///< None before they are needed.
    Detector detector_;                    ///< Of the strongest returns.
    std::vector<uint32_t> strongest_;      ///< Bin of each beam.
    bool culling_untold_ = false;          ///< Whether the plan still lacks what the first ping's culling omitted.
    int threads_ = 0;                      ///< Threads of the renderer [1].
    std::optional<types::Plan> plan_;      ///< Outlives the renderer, for the summary.
    bool plan_reported_ = false;           ///< Whether the record has the current plan.
    bool is_changed_ = false;              ///< Whether the renderer lacks the present configuration.
    types::GeometryPtr geometry_;          ///< The renderer's.
    types::Transmission transmitted_;      ///< Everything except time and pose; made for the first ping.
    OthersReceived others_received_;
    std::optional<Taken> listening_;  ///< The ping that waits for pulses of others.
    std::optional<Taken> heard_;      ///< The last ping that waited for them.
    double render_seconds_ = 0;       ///< Time that the last ping took [s].
    CountedPings counted_;
    types::SonarPtr last_ping_;
    std::future<std::string> explanation_;  ///< Being found, for `explaining_`.
    Place explaining_;
    std::pair<Place, std::string> explained_;  ///< The last text that is found; empty once it has been fetched.
    uint64_t cut_off_ = 0;                     ///< Pings that still waited for pulses at the stop [1].
    framework::SamplePool<types::Sonar> pool_;
    framework::SamplePool<types::SonarTruth> truths_;
    framework::SamplePool<types::SonarReturns> all_returns_;
    framework::SamplePool<types::SonarElements> signals_;
};

/** A forward-looking imaging sonar: a fan of beams per ping.
 *
 *  Bins hold E/S0 of the active sonar equation (`physical`) or means of S(n.d) (`cerqueira2017`), beam-first. The
 *  sonar frame is x ahead, y to port, z up; bearings are positive to port. */
class SonarTask final : public PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<SonarConfig> config{this};
    SonarConfig sonarConfig() const override { return config->fan(); }
};

}  // namespace insonify::sonar
