#pragma once
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/dds/NodeConfig.hpp"

namespace insonify::dds {

/** The message type of the poses. */
enum class PoseType { Odometry, PoseStamped };

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

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::PoseType> {
    static constexpr std::string_view names[] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped"};
};
template <>
struct insonify::types::EnumNames<insonify::dds::StampFrom> {
    static constexpr std::string_view names[] = {"message", "arrival"};
};
