#include "components/log/MessageDecoder.hpp"

#include <algorithm>

#include "components/log/TypeNames.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Stamps.hpp"

namespace insonify::log {
namespace {

std::string valueOr(const Metadata& texts, const char* key, const std::string& otherwise) {
    const auto found = texts.find(key);
    return found == texts.end() ? otherwise : found->second;
}

template <class E>
void readEnum(const Metadata& texts, const char* key, E& value) {
    const auto& names = types::EnumNames<E>::names;
    const auto found = std::ranges::find(names, valueOr(texts, key, ""));
    if (found != std::end(names)) value = static_cast<E>(found - std::begin(names));
}

ros::MessageOptions getOptions(const DeclaredTopic& topic) {
    ros::MessageOptions options;
    options.world_frame = topic.foreign;
    readEnum(*topic.texts, "insonify_order", options.order);
    readEnum(*topic.texts, "insonify_frame", options.frame);
    readEnum(*topic.texts, "insonify_world_frame", options.world_frame);
    return options;
}

template <class T, class Message>
class TypedDecoder final : public MessageDecoder {
public:
    explicit TypedDecoder(const ros::MessageOptions& options) : options_(options) {}
    void decode(std::span<const char> bytes, types::SampleRoom room) override {
        ros::decode(bytes, message_);
        ros::noteStamp(message_);
        ros::toSample(message_, options_, *std::get<T*>(room));
    }

private:
    ros::MessageOptions options_;
    Message message_;
};

/** Calls `use` with the first type of samples, and its message, that the topic's messages are read as. */
void withSample(const DeclaredTopic& topic, auto&& use) {
    if (topic.encoding != "cdr") return;
    const auto named = topic.texts->find("insonify_type");
    bool is_found = false;
    const auto offer = [&]<class T, class Message>(std::type_identity<T> sample, std::type_identity<Message> message) {
        if (is_found || topic.type != Message::type_name) return;
        if (named == topic.texts->end() ? ros::only_by_name<T> : named->second != cxxName<T>()) return;
        is_found = true;
        use(sample, message);
    };
    types::forEachSampleType([&]<class T>(std::type_identity<T> sample) {
        ros::forEachMessageType<T>([&]<class Message>(std::type_identity<Message> message) {
            if constexpr (ros::ReadFrom<T, Message>) offer(sample, message);
        });
    });
}

}  // namespace

Stream getStream(const DeclaredTopic& topic) {
    std::string name = topic.name.substr(topic.name.starts_with('/'));
    std::ranges::replace(name, '/', '.');
    Stream stream;
    stream.name = valueOr(*topic.texts, "insonify_stream", name);
    stream.topic = topic.name;
    stream.type = topic.type.empty() ? topic.encoding : topic.type;
    if (topic.encoding == "cdr") stream.message = topic.type;
    withSample(topic, [&]<class T, class Message>(std::type_identity<T>, std::type_identity<Message>) {
        stream.type = typelibName<T>();
        stream.sample = types::sampleIndex<T>();
    });
    return stream;
}

std::unique_ptr<MessageDecoder> makeDecoder(const DeclaredTopic& topic) {
    std::unique_ptr<MessageDecoder> decoder;
    withSample(topic, [&]<class T, class Message>(std::type_identity<T>, std::type_identity<Message>) {
        decoder = std::make_unique<TypedDecoder<T, Message>>(getOptions(topic));
    });
    return decoder;
}

}  // namespace insonify::log
