#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Node.hpp"
#include "components/dds/PublisherConfig.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::dds {

/** Sends samples as ROS 2 messages.
 *
 *  Ports: an input for each connection that names one that `topics` knows: pings (types::SonarPtr), poses
 *  (types::Pose) and pictures (types::ImagePtr); their topics may be of the types that such a sample can be. A topic
 *  that nobody reads costs nothing. Poses are turned into `world_frame`.
 *
 *  Configure joins the domain and announces the node. Sending waits for no reader: one that is more than `depth`
 *  messages behind misses some. What cannot be sent at all is counted, and told at the end. A sample that its message
 *  cannot hold ends in Exception. Stages: `send`, of all topics of a sample. */
class PublisherTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<PublisherConfig> config{this};

    /** Throws ConfigError for a port that no topic names, or a type that is not sent. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Problems& problems) const override;
    std::vector<std::string> notices() const override;

private:
    /** One input and its topics. */
    class Inlet {
    public:
        virtual ~Inlet() = default;
        virtual framework::InputPortBase& port() const = 0;
        virtual std::string messages() const = 0;  ///< That can be made of its samples.
        virtual void open(Node& node, const PublisherConfig& config) = 0;
        virtual void close() = 0;
        virtual bool send() = 0;  ///< Whether there was a sample.
        virtual void addLosses(std::vector<std::string>& notices) const = 0;
    };
    template <class Carried>
    class TypedInlet;
    template <class Carried>
    bool addInlet(const std::string& port, framework::OutputPortBase& source);

    bool configureHook() override;
    void updateHook() override;
    void cleanupHook() override;

    std::optional<Node> node_;
    std::vector<std::unique_ptr<Inlet>> inlets_;
};

}  // namespace insonify::dds
