#include "components/gazebo/Subscriptions.hpp"

#include <algorithm>
#include <utility>

#include "components/gazebo/Poses.hpp"
#include "components/gazebo/World.hpp"
#include "types/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

/** Returns the entry for a message that is damaged or has a wrong type. */
Arrived unread(size_t topic, const std::string& type, const std::string& wanted) {
    return {topic,
            {},
            {},
            {},
            type == wanted ? "bytes that are no " + wanted : "messages of type " + type + ", not " + wanted};
}

}  // namespace

WorldWatch::Change WorldWatch::take(const PoseMessage& message) {
    const auto isSame = [](const std::string& name, const PoseMessage::Entity& entity) { return name == entity.name; };
    if (std::ranges::equal(last_names_, message.entities, isSame)) return {};
    last_names_.clear();
    for (const PoseMessage::Entity& entity : message.entities) last_names_.push_back(entity.name);
    std::set<std::string> now(last_names_.begin(), last_names_.end());
    if (!std::exchange(is_taken_, true)) known_ = now;
    Change change;
    for (const std::string& name : now)
        if (!known_.contains(name) && reported_.insert(name).second) change.came.push_back(name);
    for (const std::string& name : present_)
        if (!now.contains(name) && known_.contains(name) && reported_.insert(name).second) change.went.push_back(name);
    if (reported_.size() > max_reported)
        std::erase_if(reported_, [&](const std::string& name) { return !now.contains(name); });
    present_ = std::move(now);
    return change;
}

void Inbox::put(Arrived message) {
    {
        const std::lock_guard lock(mutex_);
        if (messages_.size() >= capacity) {
            messages_.erase(messages_.begin());
            ++lost_;
        }
        messages_.push_back(std::move(message));
    }
    arrived_();
}

std::vector<Arrived> Inbox::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

uint64_t Inbox::lost() const {
    const std::lock_guard lock(mutex_);
    return lost_;
}

Subscriptions::Subscriptions(const PoseConfig& config, Inbox& inbox)
    : options_(TransportOptions::fromEnvironment(config.partition)) {
    std::vector<Topic> topics;
    if (std::ranges::any_of(config.bodies, [](const BodyConfig& body) { return !body.entity.empty(); }))
        topics.push_back(entities(config, inbox));
    for (size_t i = 0; i < config.bodies.size(); ++i)
        if (!config.bodies[i].odometry.empty()) topics.push_back(odometry(config, i, inbox));
    for (size_t i = 0; i < topics_.size(); ++i)
        if (!qualifiedName(options_.partition, topics_[i]))
            throw types::ConfigError("", keys_[i],
                                     "is " + topics_[i] + ", which Gazebo's transport does not take for a topic");
    subscriber_ = std::make_unique<Subscriber>(options_, std::move(topics));
}

Topic Subscriptions::entities(const PoseConfig& config, Inbox& inbox) {
    const size_t number = topics_.size();
    topics_.push_back(config.poseTopic());
    keys_.push_back(config.pose_topic.empty() ? "world" : "pose_topic");
    struct State {
        std::vector<BodyConfig> bodies;
        types::WorldFrame frame;
        std::string world;  ///< Empty when the topic is not that of a whole world.
        std::string partition;
        std::optional<WorldWatch> watch;
    };
    const auto state = std::make_shared<State>(State{
        config.bodies, config.world_frame, config.pose_topic.empty() ? config.world : "", options_.partition, {}});
    return {topics_.back(), [&inbox, number, state](const std::string& type, std::string_view bytes) {
                const auto message = type == "Pose_V" ? readPoses(bytes, state->frame) : std::nullopt;
                if (!message) return inbox.put(unread(number, type, "Pose_V"));
                Arrived arrived{number, message->stamp, {}, {}, ""};
                for (size_t i = 0; i < state->bodies.size(); ++i) {
                    if (state->bodies[i].entity.empty()) continue;
                    auto [pose, diagnostic] = findEntity(*message, state->bodies[i].entity);
                    arrived.bodies.push_back({i, pose ? *pose : types::Pose{}, std::move(diagnostic)});
                }
                if (!state->world.empty()) {
                    if (!state->watch) state->watch.emplace(namesTaken(state->world, state->partition));
                    arrived.change = state->watch->take(*message);
                }
                inbox.put(std::move(arrived));
            }};
}

Topic Subscriptions::odometry(const PoseConfig& config, size_t body, Inbox& inbox) {
    const size_t number = topics_.size();
    topics_.push_back(config.bodies[body].odometry);
    keys_.push_back("bodies[" + std::to_string(body) + "].odometry");
    return {topics_.back(),
            [&inbox, number, body, frame = config.world_frame](const std::string& type, std::string_view bytes) {
                const auto message = type == "Odometry" ? readOdometry(bytes, frame) : std::nullopt;
                if (!message) return inbox.put(unread(number, type, "Odometry"));
                inbox.put({number, message->stamp, {{body, message->pose, ""}}, {}, ""});
            }};
}

}  // namespace insonify::gazebo
