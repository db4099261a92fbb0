#pragma once
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "components/framework/Deployment.hpp"
#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::deployer {

// The two ends of a deployment that advances step by step.
/** Writes the poses that a caller gives, at their time. Its outputs are those that connections name. */
class PoseFeed final : public framework::TaskContext, public framework::ClockSource {
public:
    using TaskContext::TaskContext;

    framework::OutputPortBase* makeOutput(const std::string& port) override {
        return &outputs_.make<types::Pose>(port, "poses that the caller gives").port;
    }
    std::optional<types::Time> nextTime() const override { return due_; }

    /** Sets the pose of a port for the next cycle. */
    void give(const std::string& port, types::Pose pose) {
        due_ = pose.time;
        given_[port] = std::move(pose);
        called_.raise();
    }

private:
    bool startHook() override {
        due_.reset();
        given_.clear();
        return true;
    }
    void updateHook() override {
        outputs_.forEach([&](auto& output) {
            const auto found = given_.find(output.port.name());
            if (found != given_.end()) output.port.write(found->second);
        });
        due_.reset();
        given_.clear();
    }

    framework::Event called_{this};  ///< The caller is outside of the deployment.
    framework::DynamicOutputs<std::tuple<types::Pose>> outputs_{this};
    std::optional<types::Time> due_;
    std::map<std::string, types::Pose> given_;
};

/** Receives pings from a deployment. */
struct PingReader : framework::TaskContext {
    explicit PingReader(std::string source) : TaskContext(std::move(source)) {}
    framework::InputPort<types::SonarPtr> ping{this, "ping", "of the last step"};
    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "of the same", framework::Need::Optional};
    framework::InputPort<types::DepthMapPtr> range_image{this, "range_image", "of the same, by a 3-D sonar",
                                                         framework::Need::Optional};
    framework::InputPort<types::SonarTruthPtr> range_truth{this, "range_truth", "what that shows",
                                                           framework::Need::Optional};
};

/** Options of a simulation. */
struct SimulationOptions {
    uint64_t seed = 0;                   ///< As `insonify run --seed`; 0: the deployment's own.
    std::vector<std::string> overrides;  ///< "task.property=value", as `insonify run --set`.
    bool truth = false;                  ///< Whether pings include their truth.
    int threads = 0;                     ///< Threads of each sonar; 0: the number of the machine's cores [1].
    std::optional<double> period;        ///< Between two steps; none: that of the replaced poses, or 0.1 [s].
    std::vector<std::string>
        objects;  ///< Nodes of the scene that the caller places as well, see Simulation::objectPort.
};

/** One ping of a step. */
struct SteppedPing {
    types::SonarPtr ping;
    types::SonarTruthPtr truth;        ///< Null if truth is off.
    types::DepthMapPtr range_image;    ///< With truth, from a 3-D sonar; null from other sonars.
    types::SonarTruthPtr range_truth;  ///< The truth of each cell of the range image, one bin per cell.
};

/** A deployment that advances one step per pose that the caller gives.
 *
 *  It has the deployment's tasks that contribute to pings, in lockstep. The caller replaces the tasks that write a
 *  scene's `pose`; tasks that move objects stay and follow simulated time. Results are the pings of the last task of
 *  each chain that takes pings: a receiver's, where there is one. Errors of the deployment are types::ConfigError.
 *  Errors of a step, and use by two threads at a time, are std::runtime_error. */
class Simulation {
public:
    Simulation(const std::string& deployment, SimulationOptions options);

    /** The ports whose poses the caller gives, "task.port". */
    const std::vector<std::string>& poses() const { return poses_; }
    /** Returns the port, one of poses(), that places a node of SimulationOptions::objects in every scene. */
    static std::string objectPort(const std::string& node);
    /** The ports whose pings step() returns, "task.port". */
    std::vector<std::string> pings() const;
    /** Whether the sonar of these pings, by their index in pings(), has range images. */
    bool hasRangeImages(size_t ping) const { return readers_[ping]->range_image.connected(); }
    /** Returns the notices of all tasks and their plans, "task: notice". Plans have theirs from the first ping on.
     *  Throws std::runtime_error while another thread steps. */
    types::Notices notices() const;
    /** Returns the warnings that tasks gave while they ran since the last call: of texts that differ by their numbers
     *  only, the first. None while another thread steps. */
    std::vector<std::string> consumeWarnings() {
        const std::unique_lock lock(in_use_, std::try_to_lock);
        return lock ? std::exchange(warnings_, {}) : std::vector<std::string>();
    }
    double period() const { return period_; }  ///< [s]
    double time() const { return time_; }      ///< Default time of the next step; for any thread [s].

    /** Gives each scene its pose at a time later than that of the step before [s]. Returns one entry for each of
     *  pings(), with a null ping where the step made none. */
    std::vector<SteppedPing> step(std::map<std::string, types::Pose> at, std::optional<double> time);
    /** Changes properties between steps, "task.property" to a value in YAML: all, or none. They stay after reset().
     *  Throws types::ConfigError as the same assignments in SimulationOptions::overrides, and std::runtime_error for
     *  properties that a running task cannot change. */
    void set(const std::map<std::string, std::string>& values);
    /** Names objects of the scenes that hide() may hide, before the first step: indices into Geometry::objects. */
    void setHideable(const std::vector<uint32_t>& objects);
    /** Hides these objects, and shows all others, from the next step on, also after reset(). */
    void hide(const std::vector<uint32_t>& objects);
    /** Throws std::invalid_argument for 0, the deployment's own seeds, which only a new simulation has. */
    static void refuseSeed(std::optional<uint64_t> seed);
    /** Returns to the state right after construction, with this seed, not 0; none: the same seed. The scene stays
     *  loaded. */
    void reset(std::optional<uint64_t> seed);

private:
    void replacePoses(framework::DeploymentSpec& spec);
    /** Throws for a node that a connection of the deployment moves. */
    void addObjects(framework::DeploymentSpec& spec, const std::vector<std::string>& nodes);
    void connectReaders(bool truth);
    /** Throws for a time that is not after the step before, or that needs hours of work of other tasks. */
    types::Time timeOfStep(double seconds) const;
    void start();
    /** Throws the message of a task in error. */
    void throwErrors() const;

    framework::Registry registry_;
    std::vector<std::string> poses_;
    std::vector<std::unique_ptr<PingReader>> readers_;  ///< Outlive the tasks that write to them.
    std::vector<std::string> warnings_;                 ///< For consumeWarnings().
    std::set<std::string> warned_;                      ///< Their texts without digits, since the start.
    std::unique_ptr<framework::Deployment> deployment_;
    std::vector<PoseFeed*> feeds_;
    double period_ = 0.1;
    double start_time_ = 0;
    std::atomic<double> time_{0};
    mutable std::mutex in_use_;
    std::optional<types::Time> last_;  ///< Time of the step before.
    std::set<std::string> own_seeds_;  ///< Tasks whose seed has been given by name.
};

}  // namespace insonify::deployer
