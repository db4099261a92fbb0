#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Node.hpp"
#include "components/dds/ParameterServer.hpp"
#include "components/dds/Publication.hpp"
#include "components/dds/PublisherConfig.hpp"
#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/TaskContext.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::dds {

/** Sends samples as ROS 2 messages.
 *
 *  Ports: an input for each connection that names one that `topics` knows, of any type in types/Samples.hpp; their
 *  topics may be of the types that such a sample can be. A topic that nobody reads costs nothing. Poses are turned into
 *  `world_frame`. With `tf_static` the frames of pings are told with the mount of the scene from which they come, to
 *  who comes later as well. The frequency of a ping is its sonar's, unless a topic names another.
 *
 *  With `parameter_services` the node has the properties of all tasks as parameters: see ParameterServer.hpp.
 *
 *  Configure joins the domain and announces the node. Sending waits for no reader: one that is more than `depth`
 *  messages behind misses some. What cannot be sent, or what its message cannot hold, is dropped and counted: a warning
 *  tells it at the first and then every ten seconds at most, and a notice tells the sum at the end. Stages: `send`, of
 *  all topics of a sample. Latency is that of a sample's last topic, from its stamp until DDS has it. */
class PublisherTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<PublisherConfig> config{this};

    /** Throws ConfigError for a port that no topic names, or a type that is not sent. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Diagnostics& diagnostics) const override;
    std::vector<std::string> notices() const override;
    bool reachesOutside() const override { return true; }

private:
    /** The topics of an input. */
    template <class Sample>
    struct Topics {
        std::vector<std::unique_ptr<Publication<Sample>>> publications;
    };

    bool configureHook() override;
    void updateHook() override;
    void cleanupHook() override;
    /** Where the frames of all pings sit. */
    ros::TFMessage mounts() const;
    void announceMounts(const std::string& topic);
    void takeFrequencies();

    types::ThrottledWarning drops_{"message", "dropped"};
    std::optional<Node> node_;
    std::optional<Writer> tf_static_;
    std::optional<ParameterServer> parameters_;
    uint64_t known_changes_ = 0;  ///< Of the tasks' records, when the frequencies were taken.
    framework::DynamicInputs<types::SampleTypes, Topics> inputs_{this};
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::dds
