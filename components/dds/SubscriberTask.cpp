#include "components/dds/SubscriberTask.hpp"

#include <algorithm>

#include "components/framework/Activity.hpp"

namespace insonify::dds {
namespace {

constexpr int max_at_once = 1000;  ///< Messages of a topic in one cycle: then others have their turn.

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

void SubscriberTask::check(types::Diagnostics& diagnostics) const {
    if (environment().lockstep)
        diagnostics.push_back(
            {"", "messages come on the wall clock's time, for which lockstep does not wait; set schedule: realtime"});
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const auto is = [&](const Outlet& outlet) { return outlet.port->name() == config->topics[i].port; };
        if (std::ranges::none_of(outlets_, is))
            diagnostics.push_back({"topics[" + std::to_string(i) + "].port",
                                   "no connection leads from " + name() + "." + config->topics[i].port});
    }
}

std::vector<std::string> SubscriberTask::notices() const { return drops_.summary(); }

bool SubscriberTask::configureHook() {
    drops_.reset();
    for (Outlet& outlet : outlets_) outlet.subscription.reset();  // of a configure that failed
    node_.emplace(domainId(config->node.domain), config->node.nameOr(name()),
                  static_cast<size_t>(config->node.gid_size));
    for (Outlet& outlet : outlets_)
        outlet.subscription = std::make_unique<Subscription>(*node_, *config, *topicOf(*config, outlet.port->name()),
                                                             drops_, [this] { activity().trigger(); });
    node_->announce();
    return true;
}

bool SubscriberTask::startHook() {
    types::Pose stale;
    for (Outlet& outlet : outlets_)
        for (int i = 0; i < max_at_once && outlet.subscription->take(now(), stale);) ++i;
    return true;
}

void SubscriberTask::updateHook() {
    types::Pose pose;
    for (Outlet& outlet : outlets_) {
        int taken = 0;
        for (; taken < max_at_once && outlet.subscription->take(now(), pose); ++taken)
            if (config->depth > 1) outlet.port->write(pose);
        if (taken > 0 && config->depth == 1) outlet.port->write(pose);
        if (taken == max_at_once || outlet.subscription->more()) activity().trigger();
    }
    if (const std::string told = drops_.takeWarning(); !told.empty()) warn(told);
}

void SubscriberTask::cleanupHook() {
    for (Outlet& outlet : outlets_) outlet.subscription.reset();
    node_.reset();
}

}  // namespace insonify::dds
