#pragma once
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "components/framework/DynamicPorts.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/gazebo/Publisher.hpp"
#include "types/ReturnLevels.hpp"
#include "types/text/Notice.hpp"

namespace insonify::gazebo {

/** Messages of Gazebo that samples become. */
enum class MessageType { Image, LaserScan, PointCloudPacked, FloatV };

/** One topic that is sent with the samples of one port. */
struct TopicOut {
    std::string port, topic;
    MessageType type = MessageType::FloatV;
    std::string frame_id = "sonar";
    double threshold_db = -20;

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "input port that a connection leads to"}, self.port);
        visit({"topic", "", "as in Gazebo: /rov/sonar"}, self.topic);
        visit({"type", "", "type of Gazebo's message"}, self.type);
        visit({"frame_id", "", "frame of the message, in its header"}, self.frame_id);
        visit({"threshold_db", "dB",
               "of a LaserScan and of points of pings: min level of a return, relative to the "
               "strongest bin of its ping",
               -300, 0},
              self.threshold_db);
    }
};

struct PublisherConfig {
    std::vector<TopicOut> topics;
    std::string world;
    std::string partition;

    static void describe(auto& self, auto& visit) {
        visit({"topics", "", "what is sent; a port may have several"}, self.topics);
        visit({"world", "",
               "Gazebo's world, whose simulated time is the messages' stamp as soon as a gazebo::PoseTask "
               "reads it; empty: our time"},
              self.world);
        visit({"partition", "", "of Gazebo's transport; empty: GZ_PARTITION, or IGN_PARTITION"}, self.partition);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Sends samples on topics of Gazebo's transport.
 *
 *  Ports: an input for each connection to a port that `topics` names. A picture becomes an Image; a ping a Float_V (its
 *  bins, beam by beam, with bearings and sizes in the header), a LaserScan (first returns) or a PointCloudPacked;
 *  points and range images become a PointCloudPacked. A topic without readers costs nothing. A sample that does not
 *  fit its message is dropped and counted; a warning reports the first and then at most one every ten seconds. */
class PublisherTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    using Samples = std::tuple<types::Sonar, types::Image, types::PointCloud, types::DepthMap>;

    framework::Properties<PublisherConfig> config{this};

    /** Throws ConfigError for a port that no topic names, or a type that is not sent. */
    framework::InputPortBase* makeInput(const std::string& port, framework::OutputPortBase& source) override;
    void check(types::Diagnostics& diagnostics) const override;
    types::Notices notices() const override;
    bool reachesOutside() const override { return true; }

private:
    template <class Sample>
    struct Sending {
        types::ReturnRules returns;  ///< Of the sonar upstream.
    };

    bool configureHook() override;
    void updateHook() override;
    void cleanupHook() override;
    template <class Sample>
    void send(const std::string& port, const Sample& sample, const types::ReturnRules& returns);
    /** Returns the stamp of a message for a sample of our time. */
    types::Time getStamp(types::Time time) const;

    std::unique_ptr<Publisher> publisher_;
    std::string partition_;
    std::optional<uint64_t> known_changes_;  ///< Of the tasks' records, when the returns' rules were read.
    types::ThrottledWarning drops_{"message", "dropped"};
    framework::DynamicInputs<Samples, Sending> inputs_{this};
};

}  // namespace insonify::gazebo

template <>
struct insonify::types::EnumNames<insonify::gazebo::MessageType> {
    static constexpr std::string_view names[] = {"Image", "LaserScan", "PointCloudPacked", "Float_V"};
};
