#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/dds/MessageType.hpp"
#include "components/dds/NodeConfig.hpp"

namespace insonify::dds {

/** Options whose frame is the task's. */
inline ros::SonarOptions withoutFrame() {
    ros::SonarOptions options;
    options.frame_id.clear();
    return options;
}

/** One port's samples as one topic's messages. */
struct TopicOut {
    std::string port, topic;
    MessageType type = MessageType::ProjectedSonarImage;
    std::string child_frame_id = "base_link";
    ros::SonarOptions sonar = withoutFrame();

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"port", "", "input port that a connection leads to"}, self.port);
        visit(Field{"topic", "", "as in ROS: /auv/sonar"}, self.topic);
        visit(Field{"type", "", "of ROS's message"}, self.type);
        visit(Field{"child_frame_id", "", "the body of an Odometry whose pose names none"}, self.child_frame_id);
        ros::SonarOptions::describe(self.sonar, visit);
    }
};

struct PublisherConfig {
    std::vector<TopicOut> topics;
    std::string frame_id = "sonar", world_frame_id = "map";
    Reliability reliability = Reliability::Reliable;
    int depth = 5;
    NodeConfig node;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"topics", "", "what is sent; a port may have several"}, self.topics);
        visit(Field{"frame_id", "", "of pings and pictures; a topic may have its own"}, self.frame_id);
        visit(Field{"world_frame_id", "", "of poses that name none; a topic may have its own"}, self.world_frame_id);
        visit(Field{"reliability", "", "best_effort is not heard by readers that ask for reliable ones"},
              self.reliability);
        visit(Field{"depth", "1", "messages kept for readers that are behind", 1, 1000}, self.depth);
        NodeConfig::describe(self.node, visit);
    }
    void check(types::Problems& problems) const {
        node.check(problems);
        if (topics.empty()) problems.push_back({"topics", "is empty; must hold a topic"});
        std::set<std::string> names;
        for (size_t i = 0; i < topics.size(); ++i) {
            const std::string path = "topics[" + std::to_string(i) + "].";
            if (topics[i].port.empty()) problems.push_back({path + "port", "must name an input port"});
            if (const std::string fault = faultOfTopic(topics[i].topic); !fault.empty())
                problems.push_back({path + "topic", fault});
            else if (!names.insert(ddsTopic(topics[i].topic)).second)
                problems.push_back({path + "topic", "is " + topics[i].topic + " a second time"});
        }
    }
};

}  // namespace insonify::dds
