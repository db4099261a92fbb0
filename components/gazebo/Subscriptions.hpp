#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/gazebo/PoseConfig.hpp"
#include "components/gazebo/Poses.hpp"
#include "components/gazebo/Subscriber.hpp"
#include "types/Pose.hpp"
#include "types/Time.hpp"

namespace insonify::gazebo {

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
    Topic odometry(const PoseConfig& config, size_t body, Inbox& inbox);

    const TransportOptions options_;
    std::vector<std::string> topics_;
    std::vector<std::string> keys_;  ///< Key of the configuration for each topic.
    std::unique_ptr<Subscriber> subscriber_;
};

}  // namespace insonify::gazebo
