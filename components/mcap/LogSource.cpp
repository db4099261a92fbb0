#include "components/mcap/LogSource.hpp"

#include <algorithm>

#include "components/mcap/Conversions.hpp"
#include "components/pocolog/SampleCheck.hpp"
#include "components/ros/Cdr.hpp"

namespace insonify::mcap {
namespace {

std::string valueOr(const Texts& texts, const char* key, const std::string& otherwise) {
    const auto found = texts.find(key);
    return found == texts.end() ? otherwise : found->second;
}

template <class E>
void readEnum(const Texts& texts, const char* key, E& value) {
    const auto& names = types::EnumNames<E>::names;
    const auto found = std::ranges::find(names, valueOr(texts, key, ""));
    if (found != std::end(names)) value = static_cast<E>(found - std::begin(names));
}

/** Reads messages of one channel as samples. */
class Decoder {
public:
    virtual ~Decoder() = default;
    /** Fills `to` as typelib marshals the sample. Throws std::exception for what is no such message. */
    virtual void decode(std::span<const char> message, std::vector<char>& to) = 0;
};

template <class By>
class TypedDecoder final : public Decoder {
public:
    explicit TypedDecoder(const McapConfig& config) : config_(config) {}
    void decode(std::span<const char> message, std::vector<char>& to) override {
        ros::decode(message, message_);
        By::toSample(message_, config_, sample_);
        to.clear();
        pocolog::marshal(sample_, to);
    }

private:
    McapConfig config_;
    typename By::Message message_;
    typename By::Sample sample_{};
};

McapConfig configOf(const Texts& metadata) {
    McapConfig config;
    config.world_frame = ros::WorldFrame::Enu;
    readEnum(metadata, "insonify_order", config.order);
    readEnum(metadata, "insonify_frame", config.frame);
    readEnum(metadata, "insonify_world_frame", config.world_frame);
    return config;
}

/** Finds what a channel's messages are read as. */
struct Matcher {
    const Schema& schema;
    const Channel& channel;
    pocolog::Stream& stream;
    std::unique_ptr<Decoder> decoder{};

    template <class By>
    void offer() {
        using Sample = typename By::Sample;
        const std::string wanted = valueOr(channel.metadata, "insonify_type", pocolog::cxxName<Sample>());
        if (decoder || schema.name != By::Message::type_name || wanted != pocolog::cxxName<Sample>()) return;
        decoder = std::make_unique<TypedDecoder<By>>(configOf(channel.metadata));
        stream.type = pocolog::typelibName<Sample>();
        static const std::string registry = pocolog::registryOf<Sample>();
        stream.registry = registry;
    }
    void run() {
        if (channel.encoding != "cdr") return;
        pocolog::forEachSampleType([&]<class T>(std::type_identity<T>) {
            if constexpr (std::is_same_v<T, typename Conversion<T>::Sample>)
                if (!std::is_same_v<T, types::Angle> || channel.metadata.contains("insonify_type"))
                    offer<Conversion<T>>();
        });
        offer<StampedPoseConversion>();
    }
};

std::string streamName(const Channel& channel) {
    std::string name = channel.topic.substr(channel.topic.starts_with('/'));
    std::ranges::replace(name, '/', '.');
    return valueOr(channel.metadata, "insonify_stream", name);
}

types::Time timeOf(uint64_t ns) { return {static_cast<int64_t>(ns / 1000)}; }

class LogSource final : public pocolog::Source {
public:
    explicit LogSource(const std::filesystem::path& path) : file_(path) {
        bytes = file_.size();
        const Contents contents = file_.contents();
        fault = contents.fault;
        if (fault) gaps.push_back({contents.read_to, bytes, fault->byte, fault->what()});
        std::map<uint16_t, size_t> numbers;
        for (const auto& [number, channel] : contents.channels) {
            numbers[number] = streams.size();
            addStream(channel, contents);
        }
        for (const MessageRef& message : contents.messages) addSample(numbers.at(message.channel), message);
    }

    void read(const pocolog::SampleRef& at, std::vector<char>& to) override {
        if (!decoders_[at.stream]) throw std::runtime_error("is of a type that is not read");
        file_.read({.position = at.position, .size = at.size, .offset = at.offset, .compressed = at.compressed},
                   message_);
        try {
            decoders_[at.stream]->decode(message_, to);
        } catch (const std::logic_error& error) {
            throw std::runtime_error(error.what());
        }
    }

    std::optional<Fault> fault;

private:
    void addStream(const Channel& channel, const Contents& contents) {
        static const Schema none;
        const auto schema = contents.schemas.find(channel.schema);
        pocolog::Stream& stream = streams.emplace_back();
        stream.name = streamName(channel);
        stream.type = schema == contents.schemas.end() ? channel.encoding : schema->second.name;
        for (const Contents::Metadata& metadata : contents.metadata)
            if (metadata.name == "insonify" && metadata.channels_before < streams.size())
                stream.metadata = metadata.texts;
        Matcher matcher{schema == contents.schemas.end() ? none : schema->second, channel, stream};
        matcher.run();
        decoders_.push_back(std::move(matcher.decoder));
    }

    void addSample(size_t number, const MessageRef& message) {
        const types::Time time = timeOf(message.publish_ns);
        samples.push_back({.stream = number,
                           .received = timeOf(message.log_ns),
                           .time = time,
                           .position = message.position,
                           .size = message.size,
                           .compressed = message.compressed,
                           .offset = message.offset});
        pocolog::Stream& stream = streams[number];
        if (stream.count++ == 0) stream.first = time;
        stream.last = time;
    }

    File file_;
    std::vector<std::unique_ptr<Decoder>> decoders_;  ///< Of each stream; null: its type is not known.
    std::vector<char> message_;
};

}  // namespace

bool isMcap(const std::filesystem::path& path) { return path.extension() == ".mcap"; }

std::unique_ptr<pocolog::Reader> openLog(const std::filesystem::path& path) {
    if (!isMcap(path)) return std::make_unique<pocolog::Reader>(path);
    return std::make_unique<pocolog::Reader>(path, std::make_unique<LogSource>(path));
}

pocolog::Verdict checkLog(const std::filesystem::path& path) {
    if (!isMcap(path)) return pocolog::check(path);
    LogSource log(path);
    pocolog::Verdict verdict{log.streams.size(), 0, {}};
    pocolog::SampleCheck check;
    std::vector<char> sample;
    for (const pocolog::SampleRef& at : log.samples) {
        const pocolog::Stream& stream = log.streams[at.stream];
        if (!stream.registry.empty()) try {
                log.read(at, sample);
                check(stream, sample);
            } catch (const std::runtime_error& error) {
                verdict.wrong = {path, at.position, "the message of " + stream.name + " here: " + error.what()};
                return verdict;
            }
        ++verdict.samples;
    }
    if (log.fault) verdict.wrong = {path, log.fault->byte, log.fault->what()};
    return verdict;
}

}  // namespace insonify::mcap
