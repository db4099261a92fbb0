#include "components/dds/Publication.hpp"

#include <optional>
#include <stdexcept>

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
    std::optional<std::string> world_frame_id, child_frame_id;  ///< In place of those that a pose names.
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

/** What is given, or what the pose says, or what is usual. */
void name(std::string& frame, const std::optional<std::string>& given, const char* usual) {
    if (given) frame = *given;
    if (frame.empty()) frame = usual;
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
    name(message.header.frame_id, options.world_frame_id, "map");
    if constexpr (requires { message.child_frame_id; })
        name(message.child_frame_id, options.child_frame_id, "base_link");
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
bool canBe(MessageType type) {
    return encoderOf<Sample>(type, {}) != nullptr;
}

template <class Sample>
std::string messagesOf() {
    std::string all;
    constexpr const auto& names = types::EnumNames<MessageType>::names;
    for (size_t i = 0; i < std::size(names); ++i)
        if (canBe<Sample>(static_cast<MessageType>(i))) all += (all.empty() ? "" : ", ") + std::string(names[i]);
    return all;
}

template <class Sample>
Publication<Sample>::Publication(Node& node, const PublisherConfig& config, const TopicOut& topic, Drops& drops)
    : topic_(topic.topic),
      encode_(encoderOf<Sample>(topic.type, optionsOf(config, topic))),
      writer_(writerOf(node, config, topic)),
      drops_(drops) {
    node.addWriter(writer_.handle());
    if (encode_) return;
    const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
    throw types::ConfigError(
        "", "topics",
        type + " cannot be made of what comes on port " + topic.port + "; that can be " + messagesOf<Sample>());
}

template <class Sample>
bool Publication<Sample>::publish(const Sample& sample) {
    if (!writer_.hasReaders()) return false;
    try {
        encode_(sample, bytes_);
    } catch (const std::logic_error& error) {
        drops_.add(topic_ + ": " + error.what());
        return false;
    }
    if (writer_.write(bytes_)) return true;
    drops_.add(topic_ + ": " + writer_.failure());
    return false;
}

template class Publication<types::Sonar>;
template class Publication<types::Pose>;
template class Publication<types::Image>;
template bool canBe<types::Sonar>(MessageType);
template bool canBe<types::Pose>(MessageType);
template bool canBe<types::Image>(MessageType);
template std::string messagesOf<types::Sonar>();
template std::string messagesOf<types::Pose>();
template std::string messagesOf<types::Image>();

}  // namespace insonify::dds
