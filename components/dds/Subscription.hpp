#pragma once
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/ros/Messages.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/Notice.hpp"

namespace insonify::dds {

/** The message type of the poses. */
enum class PoseType { Odometry, PoseStamped, PoseWithCovarianceStamped };

/** The source of a pose's time. */
enum class StampFrom { Message, Arrival };

/** One output port with the poses of one topic. */
struct TopicIn {
    std::string topic, port = "pose";
    PoseType type = PoseType::Odometry;
    StampFrom stamp = StampFrom::Message;

    static void describe(auto& self, auto& visit) {
        visit({"topic", "", "as in ROS: /auv/odometry"}, self.topic);
        visit({"port", "", "output port that connections lead from"}, self.port);
        visit({"type", "", "type of the ROS message"}, self.type);
        visit({"stamp", "",
               "time of a pose: its message's, or that of its arrival, for a sender whose clock is not ours (a "
               "simulator's, a bag's)"},
              self.stamp);
    }
};

struct SubscriberConfig {
    NodeConfig node;
    std::vector<TopicIn> topics;
    Reliability reliability = Reliability::BestEffort;
    int depth = 1;

    static void describe(auto& self, auto& visit) {
        visit({"topics", "", "topics that are read"}, self.topics);
        visit({"reliability", "", "reliable receives nothing from best-effort writers"}, self.reliability);
        visit({"depth", "1", "messages that wait to be taken; 1: only the newest is handed on", 1, 1000}, self.depth);
        NodeConfig::describe(self.node, visit);
    }
    /** Resolves the names of topics and the node in a deployment. @param task the name of the reading task */
    SubscriberConfig namedBy(const types::RosNames& names, const std::string& task) const {
        SubscriberConfig named = *this;
        named.node.node_name = node.nameIn(names, task);
        for (TopicIn& topic : named.topics) topic.topic = names.topic(topic.topic, named.node.node_name);
        return named;
    }
    void check(types::Diagnostics& diagnostics) const {
        node.check(diagnostics);
        if (topics.empty()) diagnostics.push_back({"topics", "is empty; must hold a topic"});
        std::set<std::string> ports;
        for (size_t i = 0; i < topics.size(); ++i) {
            const std::string path = "topics[" + std::to_string(i) + "].";
            if (const std::string diagnostic = diagnosticOfTopic(topics[i].topic); !diagnostic.empty())
                diagnostics.push_back({path + "topic", diagnostic});
            if (!ports.insert(topics[i].port).second)
                diagnostics.push_back({path + "port", "is " + topics[i].port + " a second time"});
        }
    }
};

/** Decodes and checks the poses of one topic. */
class Subscription {
public:
    /** @param arrived as in Reader
     *  @param drops counts the messages that are dropped
     *  @param odd counts the poses whose quaternion is not near unit length
     *  Both counters must outlive this. */
    Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, types::ThrottledWarning& drops,
                 types::ThrottledWarning& odd, std::function<void()> arrived);

    /** Takes the next valid pose, in Rock's axes, with an orientation of unit length. The time is `now` if the message
     *  has no stamp, or if the topic is configured so.
     *
     *  Returns false and leaves `pose` unchanged if there is none, or after 64 drops; more() then returns true. Bytes
     *  that cannot be decoded or exceed 64 KiB are dropped, and poses that are not finite or without an orientation.
     *  Stamps are dropped if they are more than a second ahead of `now` or before that of the previous pose. Earlier
     *  stamps are accepted once the sender is gone or no valid pose arrived for a second: a looped bag and a reset
     *  simulator begin anew. */
    bool take(types::Time now, types::Pose& pose);

    /** Returns why no pose arrives, from the domain's discovery: no writer, a writer of another type or quality, or
     *  writers that send nothing valid. */
    std::string absence(Node& node) const;

    /** Returns whether take() stopped before it had looked at all messages. */
    bool more() const { return more_; }

private:
    void decode(types::Pose& pose);
    template <class Message>
    void decodeAs(Message& message, types::Pose& pose);
    /** Returns an empty text for a valid pose. */
    std::string findDiagnostic(types::Time now, const types::Pose& pose);

    std::string topic_;
    uint32_t domain_;
    Reliability reliability_;
    PoseType type_;
    ros::WorldFrame world_frame_;
    Bytes bytes_;
    types::Pose read_;
    std::tuple<ros::Odometry, ros::PoseStamped, ros::PoseWithCovarianceStamped> messages_;  ///< As in PoseType.
    ros::Time stamp_;  ///< Stamp of the last message, with its nanoseconds.
    uint64_t sender_ = 0, newest_sender_ = 0;
    types::Time newest_, newest_came_;
    bool stamped_on_arrival_, more_ = false;
    types::ThrottledWarning &drops_, &odd_;
    Reader reader_;
};

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::PoseType> {
    static constexpr std::string_view names[] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                                                 "geometry_msgs/PoseWithCovarianceStamped"};
};
template <>
struct insonify::types::EnumNames<insonify::dds::StampFrom> {
    static constexpr std::string_view names[] = {"message", "arrival"};
};
