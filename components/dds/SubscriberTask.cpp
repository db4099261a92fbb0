#include "components/dds/SubscriberTask.hpp"

#include <algorithm>

#include "components/framework/Activity.hpp"

namespace insonify::dds {
namespace {

constexpr int most_at_once = 1000;  ///< Messages of a topic in one cycle: then others have their turn.

const TopicIn* topicOf(const SubscriberConfig& config, const std::string& port) {
    const auto found = std::ranges::find(config.topics, port, &TopicIn::port);
    return found == config.topics.end() ? nullptr : &*found;
}

}  // namespace

framework::OutputPortBase* SubscriberTask::makeOutput(const std::string& port) {
    if (!topicOf(*config, port)) return nullptr;
    outlets_.push_back(
        {std::make_unique<framework::OutputPort<types::Pose>>(this, port, "body in the world: x north, y west, z up"),
         {}});
    return outlets_.back().port.get();
}

void SubscriberTask::check(types::Problems& problems) const {
    if (environment().lockstep)
        problems.push_back(
            {"", "messages come on the wall clock's time, for which lockstep does not wait; set schedule: realtime"});
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const auto is = [&](const Outlet& outlet) { return outlet.port->name() == config->topics[i].port; };
        if (std::ranges::none_of(outlets_, is))
            problems.push_back({"topics[" + std::to_string(i) + "].port",
                                "no connection leads from " + name() + "." + config->topics[i].port});
    }
}

std::vector<std::string> SubscriberTask::notices() const {
    std::vector<std::string> notices = drops_;
    for (const Outlet& outlet : outlets_)
        if (outlet.subscription)
            for (const auto& [reason, count] : outlet.subscription->dropped())
                notices.push_back(std::to_string(count) + " messages dropped: " + reason);
    return notices;
}

bool SubscriberTask::configureHook() {
    drops_.clear();
    told_ = 0;
    node_.emplace(domainId(config->node.domain), config->node.nameOr(name()),
                  static_cast<size_t>(config->node.gid_size));
    for (Outlet& outlet : outlets_)
        outlet.subscription = std::make_unique<Subscription>(*node_, *config, *topicOf(*config, outlet.port->name()),
                                                             [this] { activity().trigger(); });
    node_->announce();
    return true;
}

bool SubscriberTask::startHook() {
    types::Pose stale;
    for (Outlet& outlet : outlets_)
        for (int i = 0; i < most_at_once && outlet.subscription->take(now(), stale);) ++i;
    return true;
}

void SubscriberTask::updateHook() {
    types::Pose pose;
    for (Outlet& outlet : outlets_) {
        int taken = 0;
        for (; taken < most_at_once && outlet.subscription->take(now(), pose); ++taken) outlet.port->write(pose);
        if (taken == most_at_once) activity().trigger();
    }
    tellDrops();
}

void SubscriberTask::tellDrops() {
    uint64_t count = 0;
    const Subscription* last = nullptr;
    for (const Outlet& outlet : outlets_)
        for (const auto& [reason, dropped] : outlet.subscription->dropped()) {
            count += dropped;
            last = outlet.subscription.get();
        }
    if (count <= told_ || (told_ > 0 && Clock::now() < told_at_ + std::chrono::seconds(10))) return;
    warn(std::to_string(count) + " messages dropped; the last: " + last->lastDrop());
    told_ = count;
    told_at_ = Clock::now();
}

void SubscriberTask::cleanupHook() {
    drops_ = notices();
    for (Outlet& outlet : outlets_) outlet.subscription.reset();
    node_.reset();
}

}  // namespace insonify::dds
