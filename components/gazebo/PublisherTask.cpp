#include "components/gazebo/PublisherTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "components/framework/Graph.hpp"
#include "components/framework/execution/Timing.hpp"
#include "components/gazebo/Publisher.hpp"
#include "components/gazebo/Subscriptions.hpp"
#include "components/ros/Samples.hpp"
#include "types/Check.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

std::string getName(MessageType type) {
    return std::string(types::EnumNames<MessageType>::names[static_cast<size_t>(type)]);
}

/** Whether samples of this type can become the message. */
template <class Sample>
bool canBe(MessageType type) {
    if constexpr (std::is_same_v<Sample, types::Image>) return type == MessageType::Image;
    if constexpr (std::is_same_v<Sample, types::Sonar>) return type != MessageType::Image;
    return type == MessageType::PointCloudPacked;
}

template <class Message, class Sample>
std::string viaRos(const Sample& sample, const ros::MessageOptions& options, const Stamp& stamp) {
    Message message;
    ros::toMessage(sample, options, message);
    return encode(message, stamp);
}

template <class Sample>
std::string makeMessage(const Sample& sample, MessageType type, const ros::MessageOptions& options,
                        const Stamp& stamp) {
    if constexpr (std::is_same_v<Sample, types::Image>) return viaRos<ros::Image>(sample, options, stamp);
    if constexpr (std::is_same_v<Sample, types::Sonar>) {
        if (type == MessageType::FloatV) return encode(sample, stamp);
        if (type == MessageType::LaserScan) return viaRos<ros::LaserScan>(sample, options, stamp);
    }
    if constexpr (!std::is_same_v<Sample, types::Image>) return viaRos<ros::PointCloud2>(sample, options, stamp);
}

}  // namespace

void PublisherConfig::check(types::Diagnostics& diagnostics) const {
    if (topics.empty()) diagnostics.push_back({"topics", "is empty; must hold a topic"});
    std::set<std::string> names;
    for (size_t i = 0; i < topics.size(); ++i) {
        const std::string path = fmt::format("topics[{}].", i);
        if (topics[i].port.empty()) diagnostics.push_back({path + "port", "must name an input port"});
        if (!qualifiedName("any", topics[i].topic))
            diagnostics.push_back(
                {path + "topic", fmt::format("is \"{}\", which Gazebo's transport does not take for a "
                                             "topic; /rov/sonar is one",
                                             topics[i].topic)});
        else if (!names.insert(topics[i].topic).second)
            diagnostics.push_back({path + "topic", fmt::format("is {} a second time", topics[i].topic)});
    }
}

framework::InputPortBase* PublisherTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    if (std::ranges::none_of(config->topics, [&](const TopicOut& topic) { return topic.port == port; }))
        throw types::ConfigError("", "", fmt::format("no topic of {} is for port {}", name(), port));
    if (framework::InputPortBase* const made = inputs_.make(port, source)) return made;
    throw types::ConfigError(
        "", "",
        fmt::format("{} is {}, which has no message of Gazebo; pings, pictures, points and range images have",
                    source.path(), source.typeName()));
}

void PublisherTask::check(types::Diagnostics& diagnostics) const {
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const TopicOut& topic = config->topics[i];
        const std::string path = fmt::format("topics[{}].", i);
        bool has_input = false;
        inputs_.forEach([&]<class Input>(const Input& input) {
            if (input.port.name() != topic.port) return;
            has_input = true;
            if (canBe<typename Input::Sample>(topic.type)) return;
            std::string can;
            for (const MessageType type :
                 {MessageType::Image, MessageType::LaserScan, MessageType::PointCloudPacked, MessageType::FloatV})
                if (canBe<typename Input::Sample>(type)) can += (can.empty() ? "" : ", ") + getName(type);
            diagnostics.push_back(
                {path + "type", fmt::format("is {}; {} can be {}", getName(topic.type), input.port.typeName(), can)});
        });
        if (!has_input)
            diagnostics.push_back(
                {path + "port", fmt::format("is {}; no connection leads to {}.{}", topic.port, name(), topic.port)});
    }
}

types::Notices PublisherTask::notices() const {
    types::Notices notices;
    for (std::string& line : drops_.summary()) notices.push_back(std::move(line));
    if (const uint64_t lost = publisher_ ? publisher_->lost() : 0; lost > 0)
        notices.push_back(fmt::format("{} messages lost, because they were made faster than sent", lost));
    return notices;
}

bool PublisherTask::configureHook() {
    drops_.reset();
    publisher_.reset();
    std::vector<Offer> offers;
    for (const TopicOut& topic : config->topics) offers.push_back({topic.topic, getName(topic.type)});
    try {
        const TransportOptions options = TransportOptions::fromEnvironment(config->partition);
        partition_ = options.partition;
        publisher_ = std::make_unique<Publisher>(options, offers);
    } catch (const types::ConfigError& error) {
        const types::Diagnostic& first = error.diagnostics().front();
        const std::string where = first.path.empty() ? "" : ".topics[" + first.path + "].topic";
        throw types::ConfigError("", name() + where, first.message);
    }
    known_changes_.reset();
    return true;
}

types::Time PublisherTask::getStamp(types::Time time) const {
    return config->world.empty() ? time : findStamp(config->world, partition_, time).value_or(time);
}

template <class Sample>
void PublisherTask::send(const std::string& port, const Sample& sample, const types::ReturnRules& returns) {
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const TopicOut& topic = config->topics[i];
        if (topic.port != port || !publisher_->hasReaders(i)) continue;
        ros::MessageOptions options;
        options.frame = ros::SensorFrame::XForward;
        options.world_frame = ros::WorldFrame::AsIs;
        options.threshold_db = topic.threshold_db;
        options.frame_id = topic.frame_id;
        options.returns = returns;
        try {
            publisher_->publish(i, makeMessage(sample, topic.type, options, {getStamp(sample.time), topic.frame_id}));
        } catch (const types::CheckFailure&) {
            throw;
        } catch (const std::logic_error& error) {
            drops_.add(fmt::format("{}: {}", topic.topic, error.what()));
        }
    }
}

void PublisherTask::updateHook() {
    if (const uint64_t changes = *environment().record_changes; changes != known_changes_) {
        known_changes_ = changes;
        inputs_.forEach(
            [](auto& input) { input.kept.returns = framework::upstreamReturnRules(input.port, types::left_receiver); });
    }
    inputs_.forEach([this]<class Input>(Input& input) {
        for (typename Input::Carried sample{}; input.port.readNew(sample);) {
            const auto* const content = types::carriedSample(sample);
            send(input.port.name(), *content, input.kept.returns);
            framework::noteLatency(*this, content->time);
        }
    });
    if (const std::string reported = drops_.consumeWarning(); !reported.empty()) warn(reported);
}

void PublisherTask::cleanupHook() { publisher_.reset(); }

}  // namespace insonify::gazebo
