#include "components/dds/SubscriberTask.hpp"

#include <algorithm>
#include <utility>

#include "types/Time.hpp"

namespace insonify::dds {
namespace {

constexpr int max_at_once = 1000;           ///< Messages of a topic in one cycle; then the other topics follow.
constexpr types::Time patience{3'000'000};  ///< Time for the first pose of a topic before its absence is reported.

}  // namespace

SubscriberTask::~SubscriberTask() { cleanupHook(); }

types::Notices SubscriberTask::notices() const {
    types::Notices all;
    for (const TopicIn& topic : config->namedBy(environment().names, name()).topics)
        if (topic.type == PoseType::NavSatFix && !topic.orientation)
            all.push_back(topic.topic + " has only positions: the body is level and looks to the north");
    for (const auto* counted : counts_.all())
        for (std::string& line : counted->summary()) all.push_back(std::move(line));
    return all;
}

void SubscriberTask::checkMore(types::Diagnostics& diagnostics) const {
    if (config->hasFixes()) checkDatum(config->datum, diagnostics);
}

bool SubscriberTask::configureHook() {
    for (auto* counted : counts_.all()) counted->reset();
    types::Diagnostics diagnostics;
    checkMore(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError("", name() + ".datum", diagnostics.front().message);
    outputs_.forEach([](auto& output) { output.kept.subscription.reset(); });  // remains of a failed configure
    const SubscriberConfig named = config->namedBy(environment().names, name());
    refuseWrong(named);
    node_.emplace(domainId(named.node.domain), named.node.node_name, static_cast<size_t>(named.node.gid_size));
    outputs_.forEach([&](auto& output) {
        const auto entry = std::ranges::find(named.topics, output.port.name(), &TopicIn::port);
        output.kept.subscription =
            std::make_unique<Subscription>(*node_, named, *entry, counts_, [this] { arrived_.raise(); });
    });
    node_->announce();
    return true;
}

bool SubscriberTask::startHook() {
    types::Pose stale;
    started_ = now();
    outputs_.forEach([&](auto& output) {
        for (int i = 0; i < max_at_once && output.kept.subscription->take(now(), stale);) ++i;
        output.kept.came = output.kept.absence_reported = false;
    });
    return true;
}

void SubscriberTask::updateHook() {
    types::Pose pose;
    outputs_.forEach([&](auto& output) {
        Subscription& subscription = *output.kept.subscription;
        int taken = 0;
        for (; taken < max_at_once && subscription.take(now(), pose); ++taken)
            if (config->depth > 1) output.port.write(pose);
        if (taken > 0 && config->depth == 1) output.port.write(pose);
        output.kept.came |= taken > 0;
        if (taken == max_at_once || subscription.more()) arrived_.raise();
    });
    for (types::ThrottledWarning* counted : counts_.all())
        if (const std::string warning = counted->consumeWarning(); !warning.empty()) warn(warning);
    reportAbsence();
}

void SubscriberTask::reportAbsence() {
    if (!types::due(started_, patience, now())) return;
    outputs_.forEach([&](auto& output) {
        auto& kept = output.kept;
        if (kept.came || std::exchange(kept.absence_reported, true)) return;
        warn(output.port.path() + ": no pose yet: " + kept.subscription->absence(*node_));
    });
}

void SubscriberTask::cleanupHook() {
    outputs_.forEach([](auto& output) { output.kept.subscription.reset(); });
    node_.reset();
}

}  // namespace insonify::dds
