#include "components/log/mcap/SampleWriter.hpp"

#include <algorithm>
#include <charconv>

#include "components/log/TypeNames.hpp"
#include "components/log/mcap/Reader.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"
#include "types/Check.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::log::mcap {
namespace {

/** Converts "task.port" to "/task/port", with letters, digits and underscores, as in ROS names. */
std::string usualTopic(const std::string& stream) {
    std::string topic = stream.starts_with('/') ? stream : "/" + stream;
    for (char& c : topic)
        if (c == '.')
            c = '/';
        else if (c != '/' && !types::isLetter(c) && !types::isDigit(c))
            c = '_';
    return topic;
}

/** Returns the nanoseconds of a time after 1970, with the part of its stamp below a microsecond; 0 for earlier
 *  times. */
uint64_t exactNanoseconds(types::Time time) try {
    if (time.microseconds <= 0) return 0;
    const ros::Time stamp = ros::fineStamps().exact(ros::toRos(time));
    return static_cast<uint64_t>(stamp.sec) * 1'000'000'000 + stamp.nanosec;
} catch (const std::out_of_range&) {
    return static_cast<uint64_t>(time.microseconds) * 1000;
}

uint64_t nanoseconds(types::Time time) { return static_cast<uint64_t>(std::max<int64_t>(time.microseconds, 0)) * 1000; }

/** Adds a stream's differences from the shared record; an empty text means a missing key. The deployment is the whole
 *  log's. */
void addDifferences(const Metadata& shared, const Metadata& metadata, Texts& channel) {
    for (const auto& [key, value] : shared)
        if (!metadata.contains(key) && key != "insonify_deployment") channel.emplace(key, "");
    for (const auto& [key, value] : metadata)
        if (const auto found = shared.find(key); found == shared.end() || found->second != value)
            channel.emplace(key, value);
}

template <class E>
std::string getName(E value) {
    return std::string(types::EnumNames<E>::names[static_cast<size_t>(value)]);
}

/** Returns "/auv/sonar" for a topic with or without its slash. */
std::string rooted(const std::string& topic) { return "/" + topic.substr(topic.starts_with('/')); }

std::set<std::string> getTopics(const McapConfig& config) {
    std::set<std::string> topics;
    for (const auto& [name, stream] : config.streams)
        if (stream.topic) topics.insert(rooted(config.names.topic(*stream.topic)));
    return topics;
}

}  // namespace

std::string SampleWriter::getTopic(const std::string& stream) const {
    const auto given = config_.streams.find(stream);
    if (given == config_.streams.end() || !given->second.topic) return config_.names.ros_namespace + usualTopic(stream);
    return rooted(config_.names.topic(*given->second.topic));
}

SampleWriter::Options SampleWriter::getOptions(const std::string& stream, const Metadata& metadata) const {
    Options options{config_, {}, {}};
    const auto frequency = metadata.find("insonify_frequency_khz");
    if (options.frequency_khz == 0 && frequency != metadata.end())
        std::from_chars(frequency->second.data(), frequency->second.data() + frequency->second.size(),
                        options.frequency_khz);
    if (const auto given = config_.streams.find(stream); given != config_.streams.end()) {
        if (given->second.frame_id) options.frame_id = *given->second.frame_id;
        options.world_frame_id = given->second.frame_id;
        options.child_frame_id = given->second.child_frame_id;
    }
    options.frame_id = config_.names.frame(options.frame_id);
    return options;
}

SampleWriter::SampleWriter(std::filesystem::path path, const McapConfig& config)
    : config_(config), bag_(path, config.is_bag), out_(std::move(path)), transforms_(out_, getTopics(config)) {}

SampleWriter::~SampleWriter() {
    if (out_.isEmpty()) return;
    try {
        close();
    } catch (const std::exception&) {
        // A destructor cannot report errors; close() does.
    }
}

void SampleWriter::checkTopic(const std::string& stream) const {
    const std::string topic = getTopic(stream);
    for (const Channel& other : out_.channels())
        if (other.topic == topic)
            throw types::ConfigError(
                path(), stream,
                "its topic " + topic + " belongs to another stream; give one of them another " + "under mcap.streams");
}

size_t SampleWriter::add(size_t sample, const std::string& name, const Metadata& metadata) {
    checkTopic(name);
    size_t number = 0;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (types::sampleIndex<T>() != sample) return;
        using Message = ros::LoggedMessage<T>;
        const Schema schema{Message::type_name, "ros2msg", ros::describeSchema<Message>()};
        Texts texts = {{"offered_qos_profiles", qos_profile},
                       {"topic_type_hash", ros::typeHash<Message>()},
                       {"insonify_stream", name},
                       {"insonify_type", cxxName<typename ros::MessagesOf<T>::read_as>()},
                       {"insonify_order", getName(config_.order)},
                       {"insonify_frame", getName(config_.frame)},
                       {"insonify_world_frame", getName(config_.world_frame)}};
        const Options options = getOptions(name, metadata);
        if (std::is_same_v<Message, ros::ProjectedSonarImage> || std::is_same_v<Message, ros::SonarDetections>)
            texts.emplace(frame_id_key, options.frame_id);
        number = declare(&schema, {0, getTopic(name), "cdr", std::move(texts)}, metadata);
        options_.resize(number + 1);
        options_[number] = options;
        if (config_.transforms) transforms_.follow(channels_[number], metadata);
    });
    return number;
}

size_t SampleWriter::declare(const Schema* schema, Channel channel, const Metadata& metadata) {
    std::erase_if(channel.metadata, [&](const auto& text) { return isOfStream(channel.metadata, text.first); });
    if (metadata_.empty() && !metadata.empty())
        out_.addMetadata("insonify", metadata_ = metadata);
    else
        addDifferences(metadata_, metadata, channel.metadata);
    if (schema) {
        auto known = schemas_.find(*schema);
        if (known == schemas_.end()) known = schemas_.emplace(*schema, out_.addSchema(*schema)).first;
        channel.schema = known->second;
    }
    channels_.push_back(out_.addChannel(std::move(channel)));
    return channels_.size() - 1;
}

size_t SampleWriter::addLike(const log::Reader& log, size_t number, const Metadata& more) {
    const Stream& stream = log.streams()[number];
    Metadata all = stream.metadata;
    all.insert(more.begin(), more.end());
    if (const auto* same = dynamic_cast<const Reader*>(&log)) {
        const size_t copied = declare(same->schema(number), same->channel(number), all);
        if (same->hasTransforms()) transforms_.follow(channels_[copied], all);
        return copied;
    }
    if (stream.sample) return add(*stream.sample, stream.name, all);
    if (stream.message.empty())
        throw types::ConfigError(log.path(), stream.name, "holds " + stream.type + ", which has no message");
    Schema schema{stream.message, "ros2msg", log.layout(number)};
    if (schema.text.empty())
        ros::forEachMessage([&]<class Message>(std::type_identity<Message>) {
            if (stream.message == Message::type_name) schema.text = ros::describeSchema<Message>();
        });
    return declare(&schema, {0, stream.topic, "cdr", {{"offered_qos_profiles", qos_profile}}}, all);
}

void SampleWriter::put(size_t stream, types::Time received, types::Time time, types::SampleView sample) {
    const auto encode = [&]<class T>(const T* held) {
        auto& message = std::get<ros::LoggedMessage<T>>(messages_);
        bytes_.clear();
        const Options& options = options_.at(stream);
        ros::toMessage(*held, options, message);
        ros::restoreStamps(message);
        constexpr bool of_the_world = std::is_same_v<T, types::Pose> || std::is_same_v<T, types::PointCloud>;
        if constexpr (of_the_world && requires { message.header; })
            if (options.world_frame_id) message.header.frame_id = *options.world_frame_id;
        if constexpr (requires { message.child_frame_id; }) {
            if (options.child_frame_id) message.child_frame_id = *options.child_frame_id;
            if (const types::RosNames& names = config_.names; !names.frame_prefix.empty())
                message.child_frame_id =
                    names.frame(message.child_frame_id.empty() ? "base_link" : message.child_frame_id);
        }
        ros::encode(message, bytes_);
        time = sampleTime(*held, time);
    };
    try {
        std::visit(encode, sample);
    } catch (const types::CheckFailure&) {
        throw;
    } catch (const std::logic_error& error) {
        fail(stream, error.what());
    }
    writeMessage(stream, nanoseconds(received), exactNanoseconds(time), bytes_);
}

void SampleWriter::writeMessage(size_t stream, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes) {
    transforms_.before(channels_.at(stream), log_ns, publish_ns, bytes);
    out_.write(channels_[stream], log_ns, publish_ns, bytes);
}

void SampleWriter::copy(size_t stream, log::Reader& log, const SampleRef& at) {
    const auto* const same = dynamic_cast<const Reader*>(&log);
    if (!same && log.streams()[at.stream].sample) return put(stream, at.received, at.time, log.sampleAt(at));
    if (!same) return writeMessage(stream, nanoseconds(at.received), nanoseconds(at.time), log.toBytes(at));
    const MessageRef& message = same->message(at);
    writeMessage(stream, message.log_ns, message.publish_ns, log.toBytes(at));
}

void SampleWriter::fail(size_t stream, const std::string& why) const {
    throw std::runtime_error(path().string() + ": a sample of " +
                             out_.channels()[channels_[stream]].metadata.at("insonify_stream") +
                             " cannot be written as a message: " + why);
}

void SampleWriter::flush() {
    out_.flush();
    if (!std::exchange(described_, true)) bag_.write(out_);
}

void SampleWriter::sync() {
    out_.sync();
    if (std::exchange(description_synced_, true)) return;
    described_ = true;
    bag_.write(out_);  // after the sync, so that it is synced too
}

void SampleWriter::close() {
    if (std::exchange(closed_, true)) return;
    if (out_.isOpen()) transforms_.finish();
    out_.close();
    bag_.write(out_);
}

void SampleWriter::next(std::filesystem::path path) {
    if (out_.isOpen()) transforms_.finish();
    out_.close();
    out_.discard();
    if (is_begun_ && out_.path() != path) bag_.add(out_.summary());
    is_begun_ = false;  // until next() succeeds, which may be tried again with the same or another path
    out_.next(std::move(path));
    is_begun_ = true;
    transforms_.nextFile();
    description_synced_ = false;
    bag_.write(out_);
}

}  // namespace insonify::log::mcap
