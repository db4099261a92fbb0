#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/gazebo/PoseConfig.hpp"
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
};

/** Takes messages on the threads of Gazebo's transport and hands them to the task. Everything is for any thread. */
class Inbox {
public:
    static constexpr size_t capacity = 1000;  ///< Messages, of which the oldest go when nobody takes them.

    /** `arrived` is called on the transport's threads. */
    explicit Inbox(std::function<void()> arrived) : arrived_(std::move(arrived)) {}
    void put(Arrived message);
    std::vector<Arrived> take();
    /** From now on nobody is told and nothing is kept. */
    void close();
    uint64_t lost() const;

private:
    mutable std::mutex mutex_;
    std::function<void()> arrived_;  ///< Empty: closed.
    std::vector<Arrived> messages_;
    uint64_t lost_ = 0;
};

/** The topics of Gazebo's transport that a configuration needs; their messages go to the inbox while this lives. */
class Subscriptions {
public:
    /** Throws types::ConfigError where a topic or the partition has no name that the transport takes. */
    Subscriptions(const PoseConfig& config, std::shared_ptr<Inbox> inbox);
    ~Subscriptions();
    Subscriptions(const Subscriptions&) = delete;
    Subscriptions& operator=(const Subscriptions&) = delete;

    /** By their numbers in Arrived. */
    const std::vector<std::string>& topics() const { return topics_; }

private:
    struct Transport;

    void followEntities(const PoseConfig& config);
    void followOdometry(const PoseConfig& config, size_t body);

    std::shared_ptr<Inbox> inbox_;
    std::vector<std::string> topics_;
    std::unique_ptr<Transport> transport_;
};

}  // namespace insonify::gazebo
