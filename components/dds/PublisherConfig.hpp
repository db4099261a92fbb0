#pragma once
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "components/dds/Node.hpp"
#include "components/ros/Samples.hpp"

namespace insonify::dds {

/** Appends the types of `More` that `List` lacks. */
template <class List, class More>
struct Joined;
template <class... Listed>
struct Joined<std::tuple<Listed...>, std::tuple<>> {
    using type = std::tuple<Listed...>;
};
template <class... Listed, class First, class... Rest>
struct Joined<std::tuple<Listed...>, std::tuple<First, Rest...>> {
    static constexpr bool known = (std::is_same_v<Listed, First> || ...);
    using Next = std::conditional_t<known, std::tuple<Listed...>, std::tuple<Listed..., First>>;
    using type = typename Joined<Next, std::tuple<Rest...>>::type;
};
template <class List, class Samples>
struct MessagesOfAll {
    using type = List;
};
template <class List, class First, class... Rest>
struct MessagesOfAll<List, std::tuple<First, Rest...>> {
    using Next = typename Joined<List, typename ros::MessagesOf<First>::type>::type;
    using type = typename MessagesOfAll<Next, std::tuple<Rest...>>::type;
};
/** All messages that samples can become, see ros/Samples.hpp. */
using SentMessages = MessagesOfAll<std::tuple<>, types::SampleTypes>::type;
inline constexpr size_t message_count = std::tuple_size_v<SentMessages>;

/** The type of a sent message: an index into SentMessages. */
enum class MessageType : size_t {};

/** Calls `use(std::type_identity<Message>{})` with the message of the given type. */
template <size_t i = 0, class Use>
decltype(auto) withMessage(MessageType type, Use&& use) {
    if constexpr (i + 1 < message_count)
        if (static_cast<size_t>(type) != i) return withMessage<i + 1>(type, use);
    return use(std::type_identity<std::tuple_element_t<i, SentMessages>>{});
}

template <class Message, size_t i = 0>
constexpr MessageType getPlace() {
    if constexpr (std::is_same_v<Message, std::tuple_element_t<i, SentMessages>>)
        return MessageType{i};
    else
        return getPlace<Message, i + 1>();
}
template <class Message>
inline constexpr MessageType message_type = getPlace<Message>();

/** Shortens "nav_msgs/msg/Odometry" to "nav_msgs/Odometry". */
template <class Message>
struct ShortName {
    static constexpr std::string_view whole{Message::type_name}, infix{"msg/"};
    static constexpr std::array<char, whole.size() - infix.size()> text = [] {
        std::array<char, whole.size() - infix.size()> kept{};
        const size_t cut = whole.find(infix);
        for (size_t i = 0; i < kept.size(); ++i) kept[i] = whole[i < cut ? i : i + infix.size()];
        return kept;
    }();
};
template <class Messages>
struct ShortNames;
template <class... Message>
struct ShortNames<std::tuple<Message...>> {
    static constexpr std::array<std::string_view, sizeof...(Message)> names{
        std::string_view(ShortName<Message>::text.data(), ShortName<Message>::text.size())...};
};

/** Options that use the task's frame. */
inline ros::SonarOptions withoutFrame() {
    ros::SonarOptions options;
    options.frame_id.clear();
    return options;
}

/** One topic that is sent with the samples of one port. */
struct TopicOut {
    std::string port, topic;
    MessageType type = message_type<ros::ProjectedSonarImage>;
    std::optional<std::string> child_frame_id;
    ros::SonarOptions sonar = withoutFrame();

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "input port that a connection leads to"}, self.port);
        visit({"topic", "", "as in ROS: /auv/sonar"}, self.topic);
        visit({"type", "", "type of the ROS message"}, self.type);
        visit({"child_frame_id", "", "the body of an Odometry; absent: what its pose names, or base_link"},
              self.child_frame_id);
        ros::SonarOptions::describe(self.sonar, visit);
    }
};

/** Static transforms of the sonars' mounts on the body. */
struct StaticTransforms {
    std::string topic = "/tf_static";
    std::string frame_id = "base_link";

    static void describe(auto& self, auto& visit) {
        visit({"topic", "", "as in ROS"}, self.topic);
        visit({"frame_id", "", "frame of the body that carries the sonars"}, self.frame_id);
    }
};

/** Returns the axes of the ping's message; none if it has no axes, or is the message of a pose. */
inline std::optional<ros::SensorFrame> getAxes(const TopicOut& topic) {
    const auto is = [&]<class Message>(std::type_identity<Message>) { return topic.type == message_type<Message>; };
    if (is(std::type_identity<ros::ProjectedSonarImage>{}) || is(std::type_identity<ros::SonarRanges>{}) ||
        is(std::type_identity<ros::SonarDetections>{}))
        return topic.sonar.frame;
    if (is(std::type_identity<ros::PointCloud2>{}) || is(std::type_identity<ros::LaserScan>{}))
        return ros::SensorFrame::XForward;
    return std::nullopt;
}

struct PublisherConfig {
    std::vector<TopicOut> topics;
    std::string frame_id = "sonar";
    std::optional<std::string> world_frame_id;
    Reliability reliability = Reliability::Reliable;
    int depth = 5;
    std::optional<StaticTransforms> tf_static;
    bool parameter_services = false;
    std::optional<std::string> lifecycle;
    bool sends_diagnostics = false, sends_rosout = false;
    NodeConfig node;

    static void describe(auto& self, auto& visit) {
        visit({"topics", "", "what is sent; a port may have several"}, self.topics);
        visit({"frame_id", "", "frame of pings and pictures; a topic may have its own"}, self.frame_id);
        visit({"world_frame_id", "",
               "world frame of poses; a topic may have its own; absent: the frame that the poses name, or map"},
              self.world_frame_id);
        visit({"reliability", "", "readers that request reliable receive nothing from a best_effort writer"},
              self.reliability);
        visit({"tf_static", "",
               "publishes the transforms from the body to the frames of pings, from the scene's mount; absent: "
               "not published"},
              self.tf_static);
        visit({"depth", "1", "messages kept for readers that are behind", 1, 1000}, self.depth);
        visit({"parameter_services", "",
               "whether nodes with rmw_cyclonedds_cpp may list, get, set and describe the properties of all tasks"},
              self.parameter_services);
        visit({"lifecycle", "",
               "task whose states are those of this node as a lifecycle node of ROS 2; absent: it is none"},
              self.lifecycle);
        visit({"diagnostics", "", "whether the state of each task is sent to /diagnostics, once a second"},
              self.sends_diagnostics);
        visit({"rosout", "", "whether warnings, notices and states of all tasks are sent to /rosout"},
              self.sends_rosout);
        NodeConfig::describe(self.node, visit);
    }
    std::string getFrame(const TopicOut& topic) const {
        return topic.sonar.frame_id.empty() ? frame_id : topic.sonar.frame_id;
    }
    /** Returns a diagnostic for each frame of messages with different axes, which no single transform fits. */
    std::vector<std::string> sharedFrames() const {
        std::map<std::string, std::array<std::string, 2>> by_frame;  // topics with x ahead, with z ahead
        for (const TopicOut& topic : topics)
            if (const auto axes = getAxes(topic)) {
                std::string& topics_so = by_frame[getFrame(topic)][*axes == ros::SensorFrame::ZForward];
                topics_so += (topics_so.empty() ? "" : ", ") + topic.topic;
            }
        std::vector<std::string> shared;
        for (const auto& [frame, kinds] : by_frame)
            if (!kinds[0].empty() && !kinds[1].empty())
                shared.push_back("frame_id " + frame + " has x ahead on " + kinds[0] + " and z ahead on " + kinds[1] +
                                 ": give one of them another frame_id, for transforms");
        return shared;
    }
    /** Resolves the names of topics and the node in a deployment. @param task the name of the sending task */
    PublisherConfig namedBy(const types::RosNames& names, const std::string& task) const {
        PublisherConfig named = *this;
        named.node.node_name = node.nameIn(names, task);
        for (TopicOut& topic : named.topics) topic.topic = names.topic(topic.topic, named.node.node_name);
        if (tf_static) named.tf_static->topic = names.topic(tf_static->topic, named.node.node_name);
        return named;
    }
    void check(types::Diagnostics& diagnostics) const {
        node.check(diagnostics);
        if (topics.empty()) diagnostics.push_back({"topics", "is empty; must hold a topic"});
        ros::checkFrame("frame_id", frame_id, diagnostics);
        if (world_frame_id) ros::checkFrame("world_frame_id", *world_frame_id, diagnostics);
        if (tf_static) ros::checkFrame("tf_static.frame_id", tf_static->frame_id, diagnostics);
        std::set<std::string> names;
        if (tf_static) {
            if (const std::string diagnostic = diagnosticOfTopic(tf_static->topic); !diagnostic.empty())
                diagnostics.push_back({"tf_static.topic", diagnostic});
            names.insert(ddsTopic(tf_static->topic));
        }
        for (size_t i = 0; i < topics.size(); ++i) {
            const std::string path = "topics[" + std::to_string(i) + "].";
            const auto& [of_pings, of_body] = std::pair(topics[i].sonar.frame_id, topics[i].child_frame_id);
            if (!of_pings.empty()) ros::checkFrame(path + "frame_id", of_pings, diagnostics);
            if (of_body) ros::checkFrame(path + "child_frame_id", *of_body, diagnostics);
            if (topics[i].port.empty()) diagnostics.push_back({path + "port", "must name an input port"});
            if (const std::string diagnostic = diagnosticOfTopic(topics[i].topic); !diagnostic.empty())
                diagnostics.push_back({path + "topic", diagnostic});
            else if (!names.insert(ddsTopic(topics[i].topic)).second)
                diagnostics.push_back({path + "topic", "is " + topics[i].topic + " a second time"});
        }
    }
};

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::MessageType> {
    static constexpr auto names = insonify::dds::ShortNames<insonify::dds::SentMessages>::names;
};
