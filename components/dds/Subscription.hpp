#pragma once
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/ros/Messages.hpp"
#include "types/geometry/Datum.hpp"
#include "types/samples/Fix.hpp"
#include "types/samples/Imu.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/Notice.hpp"

namespace insonify::dds {

/** The message type of the poses. */
enum class PoseType { Odometry, PoseStamped, PoseWithCovarianceStamped, NavSatFix };

/** The message type of orientations. */
enum class OrientationType { Imu, Odometry, PoseStamped, PoseWithCovarianceStamped };

/** The source of a pose's time. */
enum class StampFrom { Message, Arrival };

/** The topic of the orientations of a body whose poses are fixes. */
struct OrientationIn {
    std::string topic;
    OrientationType type = OrientationType::Imu;

    static void describe(auto& self, auto& visit) {
        visit({"topic", "", "as in ROS: /auv/imu"}, self.topic);
        visit({"type", "", "type of the ROS message"}, self.type);
    }
};

/** One output port with the poses of one topic. */
struct TopicIn {
    std::string topic, port = "pose";
    PoseType type = PoseType::Odometry;
    StampFrom stamp = StampFrom::Message;
    std::optional<OrientationIn> orientation{};

    static void describe(auto& self, auto& visit) {
        visit({"topic", "", "as in ROS: /auv/odometry"}, self.topic);
        visit({"port", "", "output port that connections lead from"}, self.port);
        visit({"type", "", "type of the ROS message"}, self.type);
        visit({"stamp", "",
               "time of a pose: its message's, or that of its arrival, for a sender whose clock is not ours (a "
               "simulator's, a bag's)"},
              self.stamp);
        visit({"orientation", "",
               "turns a body whose messages are fixes, which have only positions; absent: it is level and looks to the "
               "north"},
              self.orientation);
    }
};

struct SubscriberConfig {
    NodeConfig node;
    std::vector<TopicIn> topics;
    std::optional<types::Datum> datum{};
    Reliability reliability = Reliability::BestEffort;
    int depth = 1;

    static void describe(auto& self, auto& visit) {
        visit({"topics", "", "topics that are read"}, self.topics);
        visit({"datum", "", "the world's origin on the earth, for fixes; absent: the deployment's"}, self.datum);
        visit({"reliability", "", "reliable receives nothing from best-effort writers"}, self.reliability);
        visit({"depth", "1", "messages that wait to be taken; 1: only the newest is handed on", 1, 1000}, self.depth);
        NodeConfig::describe(self.node, visit);
    }
    /** Resolves the names of topics and the node in a deployment. @param task the name of the reading task */
    SubscriberConfig namedBy(const types::RosNames& names, const std::string& task) const;
    void check(types::Diagnostics& diagnostics) const;
    bool hasFixes() const;
};

/** What the subscriptions of a task count. */
struct Counts {
    types::ThrottledWarning drops{"message", "dropped"}, odd{"pose", "made of unit length"},
        far{"position", "far from the datum"};

    auto all() { return std::array{&drops, &odd, &far}; }
    auto all() const { return std::array{&drops, &odd, &far}; }
};

/** Decodes and checks the poses of one topic. */
class Subscription {
public:
    /** @param arrived as in Reader
     *  @param counts must outlive this
     *  Fixes need the `datum` of the configuration. */
    Subscription(Node& node, const SubscriberConfig& config, const TopicIn& topic, Counts& counts,
                 std::function<void()> arrived);

    /** Takes the next valid pose, in Rock's axes, with an orientation of unit length. The time is `now` if the message
     *  has no stamp, or if the topic is configured so.
     *
     *  Returns false and leaves `pose` unchanged if there is none, or after 64 drops; more() then returns true. Bytes
     *  that cannot be decoded or exceed 64 KiB are dropped, and poses that are not finite or without an orientation.
     *  Stamps are dropped if they are more than a second ahead of `now` or before that of the previous pose. Earlier
     *  stamps are accepted once the sender is gone or no valid pose arrived for a second: a looped bag and a reset
     *  simulator begin anew.
     *
     *  A fix becomes a pose by types::placeFix(); one without a position is dropped. With an `orientation` it is
     *  dropped, too, if no orientation is known within a second of it; else it has that of its time by slerp, or the
     *  newest one if that is older. */
    bool take(types::Time now, types::Pose& pose);

    /** Returns why no pose arrives, from the domain's discovery: no writer, a writer of another type or quality, or
     *  writers that send nothing valid. */
    std::string absence(Node& node) const;

    /** Returns whether take() stopped before it had looked at all messages. */
    bool more() const { return more_; }

private:
    /** In the order of PoseType, and then an inertial unit. */
    using Message =
        std::variant<ros::Odometry, ros::PoseStamped, ros::PoseWithCovarianceStamped, ros::NavSatFix, ros::Imu>;
    static Message makeMessage(PoseType type);
    static Message makeMessage(OrientationType type);
    const char* getType() const;

    /** @param queue max messages that wait */
    Subscription(Node& node, const SubscriberConfig& config, const std::string& topic, StampFrom stamp, Message message,
                 int queue, Counts& counts, std::function<void()> arrived);
    /** Takes the next valid pose into `read_`. */
    bool takeNext(types::Time now);
    // These return why the message or the pose is dropped; an empty text if it is valid.
    std::string decode();
    std::string convert(const ros::NavSatFix& message);
    std::string convert(const ros::Imu& message);
    std::string convert(const auto& message);
    std::string findDiagnostic(types::Time now, const types::Pose& pose);
    std::string turn();
    void takeOrientations(types::Time now);

    std::string topic_;
    uint32_t domain_;
    Reliability reliability_;
    Message message_;
    std::optional<types::Datum> datum_;
    ros::WorldFrame world_frame_;
    Bytes bytes_;
    types::Pose read_;
    types::Fix fix_;
    types::Imu imu_;
    ros::Time stamp_;  ///< Stamp of the last message, with its nanoseconds.
    uint64_t sender_ = 0, newest_sender_ = 0;
    types::Time newest_, newest_came_;
    bool stamped_on_arrival_, more_ = false;
    Counts& counts_;
    Reader reader_;
    std::unique_ptr<Subscription> orientation_;  ///< Of fixes; null: level and to the north.
    std::deque<types::Attitude> attitudes_;      ///< The last ones that it has taken, in the order of time.
    bool was_placed_ = false;                    ///< Whether a fix has become a pose.
};

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::PoseType> {
    static constexpr std::string_view names[] = {"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                                                 "geometry_msgs/PoseWithCovarianceStamped", "sensor_msgs/NavSatFix"};
};
template <>
struct insonify::types::EnumNames<insonify::dds::OrientationType> {
    static constexpr std::string_view names[] = {"sensor_msgs/Imu", "nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                                                 "geometry_msgs/PoseWithCovarianceStamped"};
};
template <>
struct insonify::types::EnumNames<insonify::dds::StampFrom> {
    static constexpr std::string_view names[] = {"message", "arrival"};
};
