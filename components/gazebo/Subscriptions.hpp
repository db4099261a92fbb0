#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/gazebo/PoseConfig.hpp"
#include "components/gazebo/Subscriber.hpp"
#include "components/gazebo/WorldWatch.hpp"
#include "types/Pose.hpp"
#include "types/Time.hpp"

namespace insonify::gazebo {

/** A body in a message. */
struct Placed {
    size_t body = 0;  ///< Its place in the configuration.
    types::Pose pose;
    std::string diagnostic;  ///< Why there is no pose.
};

/** One message, as far as it is wanted. */
struct Arrived {
    size_t topic = 0;
    std::optional<types::Time> stamp;  ///< Of the simulation.
    std::vector<Placed> bodies;
    WorldWatch::Change change;
    std::string diagnostic;  ///< Why nothing of the message is taken.
};

/** Takes messages on the thread of Gazebo's transport and hands them to the task. Everything is for any thread. */
class Inbox {
public:
    static constexpr size_t capacity = 1000;  ///< Messages, of which the oldest go when nobody takes them.

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

/** The topics of Gazebo's transport that a configuration needs; their messages go to the inbox while this lives. */
class Subscriptions {
public:
    /** Throws types::ConfigError where a topic or the partition has no name that the transport takes, or no network
     *  takes part. */
    Subscriptions(const PoseConfig& config, Inbox& inbox);

    /** By their numbers in Arrived. */
    const std::vector<std::string>& topics() const { return topics_; }
    const std::string& partition() const { return options_.partition; }
    bool hasPublisher(size_t topic) const { return subscriber_->hasPublisher(topic); }
    /** Lists the topics that are there and end like the first. */
    std::string heard() const { return subscriber_->heard(); }

private:
    Topic entities(const PoseConfig& config, Inbox& inbox);
    Topic odometry(const PoseConfig& config, size_t body, Inbox& inbox);

    const TransportOptions options_;
    std::vector<std::string> topics_;
    std::vector<std::string> keys_;  ///< Key of the configuration for each topic.
    std::unique_ptr<Subscriber> subscriber_;
};

}  // namespace insonify::gazebo
