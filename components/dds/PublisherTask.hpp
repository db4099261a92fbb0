#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/LifecycleServer.hpp"
#include "components/dds/Node.hpp"
#include "components/dds/NodeReports.hpp"
#include "components/dds/ParameterServer.hpp"
#include "components/dds/Publication.hpp"
#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/text/Notice.hpp"

namespace insonify::framework {
class Deployment;
}

namespace insonify::dds {

/** Sends samples as ROS 2 messages.
 *
 *  Ports: an input for each connection to a port that `topics` names. Its samples may have any type of
 *  types/samples/Samples.hpp; `type` must be a message that this sample can become. A topic without readers costs
 * nothing. Poses are converted to `world_frame`. With `tf_static`, the frames of pings are published by the mount of
 * their scene, for late subscribers too. The frequency of a ping is its sonar's, unless a topic names another.
 *
 *  With `parameter_services` the node has the properties of all tasks as parameters, with `lifecycle` the states of a
 *  task; `diagnostics` and `rosout` report on all tasks: see ParameterServer.hpp, LifecycleServer.hpp, NodeReports.hpp.
 *
 *  Configure joins the domain and announces the node. Sending does not wait for readers: a reader that is more than
 *  `depth` messages behind misses some. A sample that cannot be sent, or does not fit its message, is dropped and
 *  counted. A warning reports the first drop and then at most one every ten seconds; a notice reports the sum at the
 *  end.
 *
 *  Stages: `send`, all topics of a sample. Latency is from the stamp of a sample until DDS has accepted its last
 *  topic. */
class PublisherTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<PublisherConfig> config{this};

    /** Throws ConfigError for a port that no topic names, or a type that is not sent. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Diagnostics& diagnostics) const override;
    types::Notices notices() const override;
    bool reachesOutside() const override { return true; }

private:
    /** The topics of an input. */
    template <class Sample>
    struct Topics {
        std::vector<std::unique_ptr<Publication<Sample>>> publications;
    };

    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;
    /** Returns the mounts of all frames of pings on the body. */
    ros::TFMessage mounts() const;
    void announceMounts(const std::string& topic);
    /** Keeps all warnings of the deployment for the reports. While tasks are made: none warns yet. */
    void listenToWarnings();
    void serve(const PublisherConfig& named, framework::Deployment& deployment);
    void readSonars();

    types::ThrottledWarning drops_{"message", "dropped"};
    std::optional<Node> node_;
    std::optional<Writer> tf_static_;
    std::atomic<bool> has_other_clock_{false};  ///< Than the wall clock.
    std::shared_ptr<LogLines> lines_;           ///< Null: nothing is reported.
    std::optional<ParameterServer> parameters_;
    std::optional<NodeReports> reports_;
    std::optional<LifecycleServer> lifecycle_;
    std::optional<NodeServer> server_;  ///< Ends before what it calls.
    uint64_t known_changes_ = 0;        ///< The count of changes in the tasks' records when the frequencies were read.
    framework::DynamicInputs<types::SampleTypes, Topics> inputs_{this};
};

/** Registers the tasks of this folder for deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::dds
