#include "components/gazebo/Subscriptions.hpp"

#include <algorithm>
#include <ignition/transport/Node.hh>
#include <utility>

#include "components/gazebo/Poses.hpp"
#include "types/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

ignition::transport::NodeOptions optionsOf(const PoseConfig& config) {
    ignition::transport::NodeOptions options;
    if (!config.partition.empty() && !options.SetPartition(config.partition))
        throw types::ConfigError("", "partition",
                                 "is " + config.partition + ", which Gazebo's transport does not take");
    return options;
}

/** `use` may be called on other threads for a while after the node has gone. */
template <class Message>
void subscribe(ignition::transport::Node& node, const std::string& key, const std::string& topic,
               std::function<void(const Message&)> use) {
    if (!node.Subscribe(topic, use))
        throw types::ConfigError("", key, "is " + topic + ", which Gazebo's transport does not take for a topic");
}

}  // namespace

void Inbox::put(Arrived message) {
    std::lock_guard lock(mutex_);
    if (!arrived_) return;
    if (messages_.size() >= capacity) {
        messages_.erase(messages_.begin());
        ++lost_;
    }
    messages_.push_back(std::move(message));
    arrived_();
}

std::vector<Arrived> Inbox::take() {
    std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

void Inbox::close() {
    std::lock_guard lock(mutex_);
    arrived_ = {};
    messages_.clear();
}

uint64_t Inbox::lost() const {
    std::lock_guard lock(mutex_);
    return lost_;
}

struct Subscriptions::Transport {
    explicit Transport(const PoseConfig& config) : node(optionsOf(config)) {}
    ignition::transport::Node node;
};

Subscriptions::Subscriptions(const PoseConfig& config, std::shared_ptr<Inbox> inbox)
    : inbox_(std::move(inbox)), transport_(std::make_unique<Transport>(config)) {
    if (std::ranges::any_of(config.bodies, [](const BodyConfig& body) { return !body.entity.empty(); }))
        followEntities(config);
    for (size_t i = 0; i < config.bodies.size(); ++i)
        if (!config.bodies[i].odometry.empty()) followOdometry(config, i);
}

Subscriptions::~Subscriptions() { inbox_->close(); }

void Subscriptions::followEntities(const PoseConfig& config) {
    const size_t topic = topics_.size();
    topics_.push_back(config.poseTopic());
    const auto use = [inbox = inbox_, topic, bodies = config.bodies,
                      frame = config.world_frame](const ignition::msgs::Pose_V& message) {
        Arrived arrived{topic, stampOf(message.has_header(), message.header()), {}};
        for (size_t i = 0; i < bodies.size(); ++i) {
            if (bodies[i].entity.empty()) continue;
            auto [pose, diagnostic] = findEntity(message, bodies[i].entity);
            arrived.bodies.push_back({i, pose ? poseOf(*pose, frame) : types::Pose{}, std::move(diagnostic)});
        }
        inbox->put(std::move(arrived));
    };
    subscribe<ignition::msgs::Pose_V>(transport_->node, config.pose_topic.empty() ? "world" : "pose_topic",
                                      topics_.back(), use);
}

void Subscriptions::followOdometry(const PoseConfig& config, size_t body) {
    const size_t topic = topics_.size();
    topics_.push_back(config.bodies[body].odometry);
    const auto use = [inbox = inbox_, topic, body,
                      frame = config.world_frame](const ignition::msgs::Odometry& message) {
        inbox->put({topic, stampOf(message.has_header(), message.header()), {{body, poseOf(message, frame), ""}}});
    };
    subscribe<ignition::msgs::Odometry>(transport_->node, "bodies[" + std::to_string(body) + "].odometry",
                                        topics_.back(), use);
}

}  // namespace insonify::gazebo
