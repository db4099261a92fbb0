#include "components/dds/Publication.hpp"

#include "components/ros/Cdr.hpp"
#include "components/ros/FromSonar.hpp"
#include "components/ros/Pictures.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Times.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dds {
namespace {

struct Options {
    ros::WorldFrame world_frame;
    std::string world_frame_id, child_frame_id;
    ros::SonarOptions sonar;
};

Options optionsOf(const PublisherConfig& config, const TopicOut& topic) {
    Options options{config.node.world_frame, config.world_frame_id, topic.child_frame_id, topic.sonar};
    if (topic.sonar.frame_id.empty())
        options.sonar.frame_id = config.frame_id;
    else
        options.world_frame_id = topic.sonar.frame_id;
    return options;
}

template <class Message>
auto fill(const types::Sonar& ping, const Options& options, Message& message)
    -> decltype(ros::convert(ping, options.sonar, message)) {
    ros::convert(ping, options.sonar, message);
}

void fill(const types::Image& picture, const Options& options, ros::Image& message) {
    ros::convert(picture, options.sonar.frame_id, message);
}

template <class Message>
auto fill(const types::Pose& pose, const Options& options, Message& message)
    -> decltype(ros::convert(pose, options.world_frame, message)) {
    ros::convert(pose, options.world_frame, message);
    if (message.header.frame_id.empty()) message.header.frame_id = options.world_frame_id;
    if constexpr (requires { message.child_frame_id; })
        if (message.child_frame_id.empty()) message.child_frame_id = options.child_frame_id;
}

template <class Sample>
void fill(const Sample& sample, const Options&, ros::Clock& message) {
    message = ros::toClock(sample.time);
}

template <class Sample, class Message>
concept Fills = requires(const Sample& sample, const Options& options, Message& message) {
    fill(sample, options, message);
};

template <class Sample>
using Encode = std::function<void(const Sample&, Bytes&)>;

/** None where the message cannot be made of a Sample. */
template <class Sample>
Encode<Sample> encoderOf(MessageType type, const Options& options) {
    return withMessage(type, [&]<class Message>(std::type_identity<Message>) -> Encode<Sample> {
        if constexpr (Fills<Sample, Message>)
            return [options, message = Message{}](const Sample& sample, Bytes& bytes) mutable {
                fill(sample, options, message);
                bytes.clear();
                ros::encode(message, bytes);
            };
        else
            return {};
    });
}

Writer writerOf(Node& node, const PublisherConfig& config, const TopicOut& topic) {
    const Quality quality{.reliability = config.reliability, .depth = config.depth};
    return withMessage(topic.type, [&]<class Message>(std::type_identity<Message>) {
        return Writer(node, ddsTopic(topic.topic), Message::type_name, Message::type_hash, quality);
    });
}

}  // namespace

template <class Sample>
std::string messagesOf() {
    std::string all;
    constexpr const auto& names = types::EnumNames<MessageType>::names;
    for (size_t i = 0; i < std::size(names); ++i)
        if (encoderOf<Sample>(static_cast<MessageType>(i), {}))
            all += (all.empty() ? "" : ", ") + std::string(names[i]);
    return all;
}

template <class Sample>
Publication<Sample>::Publication(Node& node, const PublisherConfig& config, const TopicOut& topic)
    : topic_(topic.topic),
      encode_(encoderOf<Sample>(topic.type, optionsOf(config, topic))),
      writer_(writerOf(node, config, topic)) {
    node.addWriter(writer_.handle());
    if (encode_) return;
    const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
    throw types::ConfigError(
        "", "topics",
        type + " cannot be made of what comes on port " + topic.port + "; that can be " + messagesOf<Sample>());
}

template <class Sample>
void Publication<Sample>::publish(const Sample& sample) {
    if (!writer_.hasReaders()) return;
    try {
        encode_(sample, bytes_);
    } catch (const std::logic_error& error) {
        throw std::invalid_argument(topic_ + ": " + error.what());
    }
    if (!writer_.write(bytes_)) ++lost_;
}

template <class Sample>
std::string Publication<Sample>::losses() const {
    if (lost_ == 0) return "";
    return std::to_string(lost_) + " messages on " + topic_ + " could not be sent: " + writer_.failure();
}

template class Publication<types::Sonar>;
template class Publication<types::Pose>;
template class Publication<types::Image>;
template std::string messagesOf<types::Sonar>();
template std::string messagesOf<types::Pose>();
template std::string messagesOf<types::Image>();

}  // namespace insonify::dds
