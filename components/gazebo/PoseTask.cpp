#include "components/gazebo/PoseTask.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "components/gazebo/PublisherTask.hpp"
#include "types/Time.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

constexpr types::Time between_reports{60'000'000};  ///< Of changes of the world.
constexpr types::Time patience{5'000'000};          ///< Time until the warning that nobody offers a topic.

/** Returns a text such as "crate, lid and 3 more". */
std::string list(const std::vector<std::string>& names) {
    constexpr size_t maximum = 5;
    const size_t shown = std::min(names.size(), maximum);
    std::string text;
    for (size_t i = 0; i < shown; ++i) text += (i > 0 ? ", " : "") + names[i];
    return names.size() > shown ? text + " and " + std::to_string(names.size() - shown) + " more" : text;
}

}  // namespace

using Order = types::SenderClock::Order;

PoseConfig::PoseConfig() = default;

void PoseConfig::check(types::Diagnostics& diagnostics) const {
    if (bodies.empty()) diagnostics.push_back({"bodies", "is empty; must hold a body"});
    std::set<std::string> ports;
    bool has_entity = false;
    for (size_t i = 0; i < bodies.size(); ++i) {
        const std::string path = "bodies[" + std::to_string(i) + "]";
        has_entity |= !bodies[i].entity.empty();
        if (bodies[i].entity.empty() == bodies[i].odometry.empty())
            diagnostics.push_back({path, "must have either an entity or an odometry"});
        if (!ports.insert(bodies[i].port).second)
            diagnostics.push_back({path + ".port", "is " + bodies[i].port + " a second time"});
    }
    if (has_entity && world.empty() == pose_topic.empty())
        diagnostics.push_back({"world", "must be given for the poses of entities, or pose_topic, but not both"});
}

types::Notices PoseTask::notices() const {
    types::Notices all;
    for (std::string& line : drops_.summary()) all.push_back(std::move(line));
    if (const uint64_t lost = inbox_ ? inbox_->lost() : 0; lost > 0)
        all.push_back(std::to_string(lost) + " messages lost, replaced by newer messages");
    return all;
}

bool PoseTask::configureHook() {
    drops_.reset();
    subscriptions_.reset();
    inbox_ = std::make_unique<Inbox>([this] { arrived_.raise(); });
    try {
        subscriptions_ = std::make_unique<Subscriptions>(*config, *inbox_);
    } catch (const types::ConfigError& error) {
        const types::Diagnostic& first = error.diagnostics().front();
        throw types::ConfigError("", name() + (first.path.empty() ? "" : "." + first.path), first.message);
    }
    return true;
}

bool PoseTask::startHook() {
    inbox_->take();  // drops messages from before the start
    clocks_.assign(subscriptions_->topics().size(), {});
    next_.assign(config->bodies.size(), {});
    started_ = now();
    is_silence_reported_ = false;
    changed_ = {};
    reported_.reset();
    return true;
}

void PoseTask::updateHook() {
    for (Arrived& message : inbox_->take()) take(message);
    warnOfSilence();
    reportChanges();
    if (const std::string reported = drops_.consumeWarning(); !reported.empty()) warn(reported);
}

void PoseTask::warnOfSilence() {
    if (is_silence_reported_ || !types::due(started_, patience, now())) return;
    is_silence_reported_ = true;
    for (size_t i = 0; i < subscriptions_->topics().size(); ++i)
        if (!subscriptions_->hasPublisher(i))
            warn("nobody publishes " + subscriptions_->topics()[i] + " in partition " + subscriptions_->partition() +
                 "; " + subscriptions_->received());
}

void PoseTask::gather(WorldWatch::Change& change) {
    std::ranges::move(change.came, std::back_inserter(changed_.came));
    std::ranges::move(change.went, std::back_inserter(changed_.went));
    changed_.came.resize(std::min(changed_.came.size(), WorldWatch::max_reported));
    changed_.went.resize(std::min(changed_.went.size(), WorldWatch::max_reported));
}

void PoseTask::reportChanges() {
    if (changed_.isEmpty() || (reported_ && !types::due(*reported_, between_reports, now()))) return;
    reported_ = now();
    const WorldWatch::Change change = std::exchange(changed_, {});
    if (!change.came.empty())
        warn("world " + config->world + " has entities that the scene does not have: " + list(change.came) +
             "; restart to take the world as it is");
    if (!change.went.empty())
        warn("world " + config->world + " has lost entities that the scene still has: " + list(change.went));
}

void PoseTask::take(Arrived& message) {
    if (!message.diagnostic.empty())
        return drops_.add(subscriptions_->topics()[message.topic] + ": " + message.diagnostic);
    gather(message.change);
    types::Time time = now();
    if (message.stamp) {
        const auto reading = clocks_[message.topic].read(*message.stamp, now());
        if (reading.order == Order::Repeated) return;
        if (reading.order == Order::Late)
            return drops_.add(subscriptions_->topics()[message.topic] +
                              ": the stamp is before that of the previous message");
        time = reading.time;
        if (reading.order == Order::Restarted) next_.assign(config->bodies.size(), {});
        if (!config->world.empty()) noteStamp(config->world, subscriptions_->partition(), time, *message.stamp);
    }
    for (Placed& placed : message.bodies)
        if (!message.stamp || isDue(placed.body, *message.stamp)) write(placed, time);
}

bool PoseTask::isDue(size_t body, types::Time stamp) {
    const types::Time period = types::Time::fromSeconds(config->bodies[body].period);
    if (period.microseconds <= 0) return true;
    std::optional<types::Time>& next = next_[body];
    if (next && stamp < *next) return false;
    const types::Time from = next.value_or(stamp);  // poses come at times of their own: the grid of the period is kept
    next = from + types::Time{((stamp - from).microseconds / period.microseconds + 1) * period.microseconds};
    return true;
}

void PoseTask::write(Placed& placed, types::Time time) {
    const BodyConfig& body = config->bodies[placed.body];
    const std::string& name = body.entity.empty() ? body.odometry : body.entity;
    if (!placed.diagnostic.empty()) return drops_.add(name + ": " + placed.diagnostic);
    if (!types::isUsable(placed.pose))
        return drops_.add(name + ": position and orientation are not finite, or the orientation has no length");
    placed.pose.time = time;
    placed.pose.orientation = glm::normalize(placed.pose.orientation);
    outputs_.forEach([&](auto& output) {
        if (output.port.name() == body.port) output.port.write(placed.pose);
    });
}

void PoseTask::cleanupHook() {
    subscriptions_.reset();
    inbox_.reset();
}

void registerTasks(framework::Registry& registry) {
    registry.add<PoseTask>("gazebo::PoseTask", "reads the poses of bodies in a Gazebo world");
    registry.add<PublisherTask>("gazebo::PublisherTask", "sends samples on Gazebo's topics");
}

}  // namespace insonify::gazebo
