#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"
#include "types/Time.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/samples/Pose.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Describe.hpp"

namespace insonify::gazebo {

/** A place in the axes of a parent. */
struct Place {
    glm::dvec3 position{0};              ///< [m]
    glm::dquat orientation{1, 0, 0, 0};  ///< As sent; of any length.
};

/** An entity with its parents, from the model of the world's top level to the entity. */
struct Chain {
    struct Part {
        uint32_t id = 0;
        Place place{};  ///< The newest: of an entity that messages omit.
    };
    std::vector<Part> parts;
};

/** The poses in a message Pose_V: the models of a world and all their links, by name. */
struct PoseMessage {
    struct Entity {
        std::string name;
        types::Pose pose;  ///< In our axes, without a time. Values that the message does not have are unknown.
        uint32_t id = 0;
        Place place{};  ///< In Gazebo's axes, in its parent.
    };
    std::optional<types::Time> stamp;  ///< Simulated time; none when the message has no stamp, or it is out of bounds.
    std::vector<Entity> entities;
};
/** Reads a Pose_V; none when the bytes are no Pose_V. */
std::optional<PoseMessage> readPoses(std::string_view message, types::WorldFrame frame);

/** The pose in a message Odometry, with velocities, which the message has in the frame of the body. */
struct OdometryMessage {
    std::optional<types::Time> stamp;  ///< As in PoseMessage.
    types::Pose pose;                  ///< As in PoseMessage::Entity.
};
/** Reads an Odometry; none when the bytes are no Odometry. */
std::optional<OdometryMessage> readOdometry(std::string_view message, types::WorldFrame frame);

/** The result of a search for an entity by name. */
struct FoundEntity {
    const types::Pose* pose = nullptr;
    std::string diagnostic;  ///< Why there is no pose: no entity, or several entities, have the name.
};
FoundEntity findEntity(const PoseMessage& message, const std::string& name);

/** Returns the pose in the world of an entity below other entities, in our axes. Keeps the places of the message. */
types::Pose poseOfChain(const PoseMessage& message, Chain& chain, types::WorldFrame frame);

/** Reads the models and links of a message Scene, by their scope ("rov::arm::hand"). Throws types::ConfigError when the
 *  bytes are no Scene. */
std::map<std::string, Chain> readChains(std::string_view message);

/** Keeps the simulated time of a world's poses, and their time on our clock, for findStamp(). Thread-safe. */
void noteStamp(const std::string& world, const std::string& partition, types::Time time, types::Time stamp);
/** Returns the simulated time for a time of our clock: that of the poses of this time, interpolated between poses. None
 *  while no message of the world's poses was read in this process. Thread-safe. */
std::optional<types::Time> findStamp(const std::string& world, const std::string& partition, types::Time time);

/** The source of the poses of one output port. */
struct BodyConfig {
    std::string port = "pose";
    std::string entity;
    std::string odometry;
    double period = 0;

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "output port of the poses"}, self.port);
        visit({"entity", "",
               "the model of this name, or the link or nested model of this scope (rov::base), of the world's poses; "
               "empty: odometry is given"},
              self.entity);
        visit({"odometry", "", "topic of the body's Odometry, /model/rov/odometry; empty: entity is given"},
              self.odometry);
        visit({"period", "s",
               "simulated time between poses, as of a sensor: the next pose from each multiple on; 0: all", 0, 1e6},
              self.period);
    }
};

struct PoseConfig {
    std::string world;
    std::string pose_topic;
    std::vector<BodyConfig> bodies;
    types::WorldFrame world_frame = types::WorldFrame::AsIs;
    std::string partition;
    double timeout = 10;

    PoseConfig();  // not inline: g++ 12 would warn that its strings are uninitialized

    static void describe(auto& self, auto& visit) {
        visit({"bodies", "", "bodies whose poses are read"}, self.bodies);
        visit({"world", "", "name of Gazebo's world, whose poses are on /world/NAME/pose/info"}, self.world);
        visit({"pose_topic", "", "another topic of poses; empty: that of the world"}, self.pose_topic);
        visit({"world_frame", "",
               "axes of Gazebo's world: as_is, those of the scene, as when both read the same SDF file; enu or "
               "ned, if x of the scene is north"},
              self.world_frame);
        visit({"partition", "", "of Gazebo's transport; empty: GZ_PARTITION, or IGN_PARTITION"}, self.partition);
        visit({"timeout", "s", "max wait for the world where an entity is a link or a nested model", 0.1, 3600},
              self.timeout);
    }
    void check(types::Diagnostics& diagnostics) const;
    /** Returns the topic of the entities' poses. */
    std::string poseTopic() const { return pose_topic.empty() ? "/world/" + world + "/pose/info" : pose_topic; }
};

/** A topic of Gazebo's transport, and the function that takes its messages. */
struct Topic {
    std::string name;  ///< "/world/sea/pose/info".
    /** Called on the subscriber's thread, with the name of the message's type, "Pose_V", and its bytes. */
    std::function<void(const std::string& type, std::string_view message)> use;
};

/** Receives topics of Gazebo's transport on its own thread until destroyed.
 *
 *  Supports Gazebo Fortress and all later versions. Publishers may start, stop and restart at any time. Messages arrive
 *  by TCP from each publisher of the topic. */
class Subscriber {
public:
    /** Throws types::ConfigError when no network supports multicast, or when a topic is invalid for the transport;
     *  `path` is then the index of the topic, such as "1". */
    Subscriber(const TransportOptions& options, std::vector<Topic> topics);
    ~Subscriber();
    Subscriber(const Subscriber&) = delete;
    Subscriber& operator=(const Subscriber&) = delete;

    /** Returns whether the topic of this index has a publisher. Thread-safe. */
    bool hasPublisher(size_t topic) const;
    /** Lists the available topics with the ending of the first topic. Thread-safe. */
    std::string received() const;

private:
    class Worker;
    std::unique_ptr<Worker> worker_;
};

/** Finds entities that have appeared in a world, or disappeared, since its scene was read, by the names in its
 *  poses. */
class WorldWatch {
public:
    /** `taken` are the names in the scene; none: the scene is not from Gazebo, and the names of the first message
     *  count. */
    explicit WorldWatch(std::optional<std::set<std::string>> taken)
        : known_(taken.value_or(std::set<std::string>())), is_taken_(taken.has_value()) {}

    struct Change {
        std::vector<std::string> came, went;
        bool isEmpty() const { return came.empty() && went.empty(); }
    };
    static constexpr size_t max_reported = 1000;  ///< Names that are remembered, apart from those in the world [1].

    /** Returns the changes of this message; each name is reported once, as long as it is remembered. */
    Change take(const PoseMessage& message);
    size_t remembered() const { return reported_.size(); }  ///< Names that are not reported again [1].

private:
    std::set<std::string> known_;
    std::set<std::string> present_;        ///< Names in the previous message.
    std::vector<std::string> last_names_;  ///< Names in the previous message, in its order.
    std::set<std::string> reported_;
    bool is_taken_;
};

/** A body in a message. */
struct Placed {
    size_t body = 0;  ///< Index in the configuration.
    types::Pose pose;
    std::string diagnostic;  ///< Why there is no pose.
};

/** The relevant parts of one message. */
struct Arrived {
    size_t topic = 0;
    std::optional<types::Time> stamp;  ///< Simulated time.
    std::vector<Placed> bodies;
    WorldWatch::Change change;
    std::string diagnostic;  ///< Why the message is dropped.
};

/** Passes messages from the thread of Gazebo's transport to the task. Thread-safe. */
class Inbox {
public:
    static constexpr size_t capacity = 1000;  ///< Max messages; a full inbox drops the oldest message.

    /** `arrived` is called on the transport's thread. */
    explicit Inbox(std::function<void()> arrived) : arrived_(std::move(arrived)) {}
    void put(Arrived message);
    std::vector<Arrived> take();
    uint64_t lost() const;

private:
    mutable std::mutex mutex_;
    const std::function<void()> arrived_;
    std::vector<Arrived> messages_;
    uint64_t lost_ = 0;
};

/** Subscribes to the topics that a configuration needs, and puts their messages into the inbox until destroyed. */
class Subscriptions {
public:
    /** Throws types::ConfigError when a topic or the partition is invalid for the transport, or when no network
     *  supports multicast. */
    Subscriptions(const PoseConfig& config, Inbox& inbox);

    /** Returns the topics by the index Arrived::topic. */
    const std::vector<std::string>& topics() const { return topics_; }
    const std::string& partition() const { return options_.partition; }
    bool hasPublisher(size_t topic) const { return subscriber_->hasPublisher(topic); }
    /** Lists the available topics with the ending of the first topic. */
    std::string received() const { return subscriber_->received(); }

private:
    Topic entities(const PoseConfig& config, Inbox& inbox);
    /** Returns the chain of each entity, if one of them is a scope; models without a number, and bodies without an
     *  entity, have none. Throws types::ConfigError. */
    std::vector<std::optional<Chain>> chains(const PoseConfig& config) const;
    Topic odometry(const PoseConfig& config, size_t body, Inbox& inbox);

    const TransportOptions options_;
    std::vector<std::string> topics_;
    std::vector<std::string> keys_;  ///< Key of the configuration for each topic.
    std::unique_ptr<Subscriber> subscriber_;
};

}  // namespace insonify::gazebo
