#pragma once
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

/** What a simulation is made of. */
struct SimulationOptions {
    uint64_t seed = 0;                   ///< As of `insonify run --seed`; 0: the deployment's own.
    std::vector<std::string> overrides;  ///< "task.property=value", as of `insonify run --set`.
    bool truth = false;                  ///< Whether pings come with what they show.
    int threads = 0;                     ///< Of each sonar; 0: as many as the machine has cores [1].
    std::optional<double> period;        ///< Between two steps; none: that of the poses it replaces, or 0.1 [s].
    std::vector<std::string>
        objects;  ///< Nodes of the scene that the caller places as well, see Simulation::objectPort.
};

/** One ping that a step has made. */
struct SteppedPing {
    types::SonarPtr ping;
    types::SonarTruthPtr truth;        ///< Null where it was not asked for.
    types::DepthMapPtr range_image;    ///< With the truth, by a 3-D sonar; null by any other.
    types::SonarTruthPtr range_truth;  ///< What each cell of it shows, a bin for each.
    double bin_width = 0;              ///< Exact, where the ping's `bin_duration` is rounded; 0 without the truth [m].
};

/** A deployment that goes on by one pose at a time, given by who calls.
 *
 *  Of the deployment there are the tasks that lead to pings, in lockstep. Those that tell a scene's `pose` are replaced
 * by the caller; those that move objects stay and go by simulated time. It gives the pings of the last task of each
 * chain that takes them: a receiver's, where there is one. Errors of the deployment are types::ConfigError, those of a
 * step std::runtime_error, as is its use by two threads at a time. */
class Simulation {
public:
    Simulation(const std::string& deployment, SimulationOptions options);

    /** Ports whose poses are to be given, "task.port". */
    const std::vector<std::string>& poses() const { return poses_; }
    /** The one of them that places a node of SimulationOptions::objects in every scene. */
    static std::string objectPort(const std::string& node);
    /** Ports whose pings come back, "task.port". */
    std::vector<std::string> pings() const;
    /** Whether the sonar behind these pings, one of pings(), has range images. */
    bool hasRangeImages(size_t ping) const { return readers_[ping]->range_image.connected(); }
    double period() const { return period_; }  ///< [s]
    double time() const { return time_; }      ///< Of the next step where nothing else is said [s].

    /** Gives each scene its pose at a time, later than that of the step before [s]; one ping for each of pings(), with
     *  null where it made none. */
    std::vector<SteppedPing> step(std::map<std::string, types::Pose> at, std::optional<double> time);
    /** Back to the start, as if it had just been made with this seed, not 0; none: the same. The scene stays loaded. */
    void reset(std::optional<uint64_t> seed);

private:
    void replacePoses(framework::DeploymentSpec& spec);
    /** Throws for a node that a connection of the deployment moves. */
    void addObjects(framework::DeploymentSpec& spec, const std::vector<std::string>& nodes);
    void connectReaders(bool truth);
    /** Throws for one that cannot follow the step before, or only after hours of work of other tasks. */
    types::Time timeOfStep(double seconds) const;
    void start();
    /** Throws what a task says that is in error. */
    void throwErrors() const;

    framework::Registry registry_;
    std::vector<std::string> poses_;
    std::vector<std::unique_ptr<PingReader>> readers_;  ///< Outlive the tasks that write to them.
    std::unique_ptr<framework::Deployment> deployment_;
    std::vector<PoseFeed*> feeds_;
    double period_ = 0.1;
    double start_time_ = 0;
    double time_ = 0;
    std::mutex in_use_;
    std::optional<types::Time> last_;  ///< Of the step before.
    std::set<std::string> own_seeds_;  ///< Tasks whose seed has been given by name.
};

}  // namespace insonify::deployer
