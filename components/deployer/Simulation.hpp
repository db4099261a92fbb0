#pragma once
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/deployer/StepTasks.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Registry.hpp"
#include "types/Pose.hpp"

namespace insonify::deployer {

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
    std::vector<std::string> notices() const;
    double period() const { return period_; }  ///< [s]
    double time() const { return time_; }      ///< Default time of the next step; for any thread [s].

    /** Gives each scene its pose at a time later than that of the step before [s]. Returns one entry for each of
     *  pings(), with a null ping where the step made none. */
    std::vector<SteppedPing> step(std::map<std::string, types::Pose> at, std::optional<double> time);
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
