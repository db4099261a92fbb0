#pragma once
#include <memory>
#include <string>
#include <vector>

#include "components/gazebo/Inbox.hpp"
#include "components/gazebo/PoseConfig.hpp"

namespace insonify::gazebo {

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
