#include "components/log/mcap/SampleWriter.hpp"

#include <algorithm>
#include <cctype>

#include "components/log/TypeNames.hpp"
#include "components/log/mcap/Reader.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Schema.hpp"

namespace insonify::log::mcap {
namespace {

/** "/task/port" of "task.port", of letters, digits and underscores, as ROS has its names. */
std::string topicOf(const std::string& stream) {
    std::string topic = "/" + stream;
    for (char& c : topic)
        if (c == '.')
            c = '/';
        else if (c != '/' && !std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    return topic;
}

uint64_t nanoseconds(types::Time time) { return static_cast<uint64_t>(std::max<int64_t>(time.microseconds, 0)) * 1000; }

template <class E>
std::string nameOf(E value) {
    return std::string(types::EnumNames<E>::names[static_cast<size_t>(value)]);
}

}  // namespace

SampleWriter::SampleWriter(std::filesystem::path path, const McapConfig& config)
    : config_(config), bag_(path), out_(std::move(path)) {
    bag_.write(out_);
}

SampleWriter::~SampleWriter() {
    try {
        close();
    } catch (const std::exception&) {
        // A destructor has nobody to tell; close() does.
    }
}

size_t SampleWriter::add(size_t sample, const std::string& name, const Metadata& metadata) {
    size_t number = 0;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (types::sampleIndex<T>() != sample) return;
        using Message = ros::LoggedMessage<T>;
        const Schema schema{Message::type_name, "ros2msg", ros::schemaOf<Message>()};
        Texts texts = {{"offered_qos_profiles", qos_profile},
                       {"topic_type_hash", Message::type_hash},
                       {"insonify_stream", name},
                       {"insonify_type", cxxName<typename ros::MessagesOf<T>::read_as>()},
                       {"insonify_order", nameOf(config_.order)},
                       {"insonify_frame", nameOf(config_.frame)},
                       {"insonify_world_frame", nameOf(config_.world_frame)}};
        number = declare(&schema, {0, topicOf(name), "cdr", std::move(texts)}, metadata);
    });
    return number;
}

size_t SampleWriter::declare(const Schema* schema, Channel channel, const Metadata& metadata) {
    if (metadata_ != metadata) out_.addMetadata("insonify", metadata_ = metadata);
    if (schema) {
        auto known = schemas_.find(*schema);
        if (known == schemas_.end()) known = schemas_.emplace(*schema, out_.addSchema(*schema)).first;
        channel.schema = known->second;
    }
    return out_.addChannel(std::move(channel));
}

size_t SampleWriter::addLike(const log::Reader& log, size_t number) {
    const Stream& stream = log.streams()[number];
    if (const auto* same = dynamic_cast<const Reader*>(&log))
        return declare(same->schema(number), same->channel(number), stream.metadata);
    if (stream.sample) return add(*stream.sample, stream.name, stream.metadata);
    throw types::ConfigError(log.path(), stream.name, "holds " + stream.type + ", which has no message");
}

void SampleWriter::put(size_t stream, types::Time received, types::Time time, types::SampleView sample) {
    const auto encode = [&]<class T>(const T* held) {
        auto& message = std::get<ros::LoggedMessage<T>>(messages_);
        bytes_.clear();
        ros::toMessage(*held, config_, message);
        ros::encode(message, bytes_);
        time = sampleTime(*held, time);
    };
    try {
        std::visit(encode, sample);
    } catch (const std::logic_error& error) {
        fail(stream, error.what());
    }
    out_.write(static_cast<uint16_t>(stream), nanoseconds(received), nanoseconds(time), bytes_);
}

void SampleWriter::copy(size_t stream, log::Reader& log, const SampleRef& at) {
    const auto* const same = dynamic_cast<const Reader*>(&log);
    if (!same) return put(stream, at.received, at.time, log.sampleAt(at));
    const MessageRef& message = same->message(at);
    out_.write(static_cast<uint16_t>(stream), message.log_ns, message.publish_ns, log.bytesOf(at));
}

void SampleWriter::fail(size_t stream, const std::string& why) const {
    throw std::runtime_error(path().string() + ": a sample of " +
                             out_.channels()[stream].metadata.at("insonify_stream") +
                             " cannot be written as a message: " + why);
}

void SampleWriter::close() {
    if (std::exchange(closed_, true)) return;
    out_.close();
    bag_.write(out_);
}

void SampleWriter::next(std::filesystem::path path) {
    out_.close();
    bag_.add(out_.summary());
    out_.next(std::move(path));
    bag_.write(out_);
}

}  // namespace insonify::log::mcap
