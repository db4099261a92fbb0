#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "components/dds/Endpoints.hpp"
#include "components/dds/PublisherConfig.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"
#include "types/Check.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Notice.hpp"

namespace insonify::dds {

/** Options for converting samples to the messages of one topic. */
struct TopicOptions {
    ros::MessageOptions messages;
    std::optional<std::string> world_frame_id, child_frame_id;  ///< Override the frames that a pose names.
    std::string frame_prefix;
};
inline TopicOptions getOptions(const PublisherConfig& config, const TopicOut& topic, const std::string& frame_prefix) {
    TopicOptions options{{}, config.world_frame_id, topic.child_frame_id, frame_prefix};
    static_cast<ros::SonarOptions&>(options.messages) = topic.sonar;
    options.messages.world_frame = config.node.world_frame;
    if (topic.sonar.frame_id.empty())
        options.messages.frame_id = config.frame_id;
    else
        options.world_frame_id = topic.sonar.frame_id;
    options.messages.frame_id = types::prefixed(frame_prefix, options.messages.frame_id);
    return options;
}

/** Sets `frame` to `given`; without it keeps the pose's frame, or uses `usual` if that is empty. */
inline void nameFrame(std::string& frame, const std::optional<std::string>& given, const char* usual) {
    if (given) frame = *given;
    if (frame.empty()) frame = usual;
}

/** Whether a T can be converted to a Message. */
template <class T, class Message>
concept Fills = requires(const T& sample, const ros::MessageOptions& options, Message& message) {
    ros::toMessage(sample, options, message);
};

/** Names the frames of a message given in the world frame: a pose, points. */
void nameFrames(const TopicOptions& options, auto& message) {
    if constexpr (requires { message.header; }) nameFrame(message.header.frame_id, options.world_frame_id, "map");
    if constexpr (requires { message.child_frame_id; }) {
        nameFrame(message.child_frame_id, options.child_frame_id, "base_link");
        if (!options.frame_prefix.empty())
            message.child_frame_id = types::prefixed(options.frame_prefix, message.child_frame_id);
    }
    if constexpr (requires { message.transforms; })
        for (ros::TransformStamped& transform : message.transforms) nameFrames(options, transform);
}

template <class T, class Message>
void fill(const T& sample, const TopicOptions& options, Message& message) {
    ros::toMessage(sample, options.messages, message);
    ros::restoreStamps(message);
    constexpr bool of_the_world = std::is_same_v<T, types::Pose> || std::is_same_v<T, types::PointCloud>;
    if constexpr (of_the_world) nameFrames(options, message);
}

template <class Sample>
using Encode = std::function<void(const Sample&, const TopicOptions&, Bytes&)>;

/** Returns the encoder; empty if a Sample cannot be converted to the message. */
template <class Sample>
Encode<Sample> encoder(MessageType type) {
    return withMessage(type, [&]<class Message>(std::type_identity<Message>) -> Encode<Sample> {
        if constexpr (Fills<Sample, Message>)
            return [message = Message{}](const Sample& sample, const TopicOptions& options, Bytes& bytes) mutable {
                fill(sample, options, message);
                bytes.clear();
                ros::encode(message, bytes);
            };
        else
            return {};
    });
}

template <class Sample>
bool canBe(MessageType type) {
    return encoder<Sample>(type) != nullptr;
}

/** Returns the types of messages that a Sample can become, as in YAML: "nav_msgs/Odometry, ...". */
template <class Sample>
std::string getMessages() {
    std::string all;
    ros::forEachMessageType<Sample>([&]<class Message>(std::type_identity<Message>) {
        const auto name = types::EnumNames<MessageType>::names[static_cast<size_t>(message_type<Message>)];
        all += (all.empty() ? "" : ", ") + std::string(name);
    });
    return all;
}

/** Returns the writer of a topic. */
inline Writer findWriter(Node& node, const PublisherConfig& config, const TopicOut& topic) {
    const Quality quality{.reliability = config.reliability, .depth = config.depth};
    return withMessage(topic.type, [&]<class Message>(std::type_identity<Message>) {
        return Writer(node, ddsTopic(topic.topic), Message::type_name, ros::typeHash<Message>(), quality);
    });
}

/** Sends samples as the messages of one topic. */
template <class Sample>
class Publication {
public:
    /** @param frame_prefix of all frames except the world's
     *  Messages that are not sent are counted in `drops`, which must outlive this. Throws types::ConfigError if a
     *  Sample cannot be converted to the message, and as Writer does. */
    Publication(Node& node, const PublisherConfig& config, const TopicOut& topic, const std::string& frame_prefix,
                types::ThrottledWarning& drops)
        : topic_(topic.topic),
          options_(getOptions(config, topic, frame_prefix)),
          encode_(encoder<Sample>(topic.type)),
          writer_(findWriter(node, config, topic)),
          drops_(drops) {
        node.addWriter(writer_.handle());
        if (encode_) return;
        const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
        throw types::ConfigError(
            "", "topics",
            type + " cannot be made of the samples of port " + topic.port + "; they can be " + getMessages<Sample>());
    }

    /** Sets the device's frequency [kHz], which is used if the topic does not name one, and what is known of its
     *  bins. */
    void setSonar(double khz, const types::ReturnRules& returns) {
        if (!names_frequency_) options_.messages.frequency_khz = khz;
        options_.messages.returns = returns;
    }

    /** Returns a remedy once, if a message was larger than Linux's default receive buffers; else an empty text. */
    std::string consumeSizeWarning() {
        constexpr size_t usual_buffer = 212'992;  // net.core.rmem_default [B]
        if (maximum_ <= usual_buffer || std::exchange(size_is_reported_, true)) return "";
        const bool can_shrink =
            std::is_same_v<Sample, types::Sonar> && options_.messages.dtype == ros::ImageType::Float32;
        return fmt::format(
            "{}: its messages of {:.0f} kB are larger than Linux's receive buffers ({:.0f} kB), so that readers "
            "with Fast DDS lose most of them; {}raise these on their machine: "
            "sysctl net.core.rmem_default=4194304 net.core.rmem_max=4194304",
            topic_, static_cast<double>(maximum_) / 1e3, static_cast<double>(usual_buffer) / 1e3,
            can_shrink ? "take dtype: uint8, or " : "");
    }

    /** Publishes a sample; returns whether it was sent. Makes no message for a topic without readers. Drops a sample
     *  that the message cannot represent (see ros/Samples.hpp). */
    bool publish(const Sample& sample) {
        if (!writer_.hasReaders()) return false;
        try {
            encode_(sample, options_, bytes_);
        } catch (const types::CheckFailure&) {
            throw;
        } catch (const std::logic_error& error) {
            drops_.add(topic_ + ": " + error.what());
            return false;
        }
        maximum_ = std::max(maximum_, bytes_.size());
        if (writer_.write(bytes_)) return true;
        drops_.add(topic_ + ": " + writer_.failure());
        return false;
    }

private:
    std::string topic_;
    TopicOptions options_;
    bool names_frequency_ = options_.messages.frequency_khz > 0;
    Encode<Sample> encode_;
    Writer writer_;
    Bytes bytes_;
    size_t maximum_ = 0;  ///< Max size of a message so far [B].
    bool size_is_reported_ = false;
    types::ThrottledWarning& drops_;
};

}  // namespace insonify::dds
