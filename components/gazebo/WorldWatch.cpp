#include "components/gazebo/WorldWatch.hpp"

#include <algorithm>
#include <utility>

namespace insonify::gazebo {

WorldWatch::Change WorldWatch::take(const PoseMessage& message) {
    const auto isSame = [](const std::string& name, const PoseMessage::Entity& entity) { return name == entity.name; };
    if (std::ranges::equal(last_names_, message.entities, isSame)) return {};
    last_names_.clear();
    for (const PoseMessage::Entity& entity : message.entities) last_names_.push_back(entity.name);
    std::set<std::string> now(last_names_.begin(), last_names_.end());
    if (!std::exchange(is_taken_, true)) known_ = now;
    Change change;
    const auto isNews = [&](const std::string& name) {
        return reported_.size() < max_reported && reported_.insert(name).second;
    };
    for (const std::string& name : now)
        if (!known_.contains(name) && isNews(name)) change.came.push_back(name);
    for (const std::string& name : present_)
        if (!now.contains(name) && known_.contains(name) && isNews(name)) change.went.push_back(name);
    present_ = std::move(now);
    return change;
}

}  // namespace insonify::gazebo
