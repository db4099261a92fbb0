#include "components/log/mcap/Reader.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <system_error>

#include "components/log/mcap/Transforms.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log::mcap {
namespace {

types::Time getTime(uint64_t ns) { return {static_cast<int64_t>(ns / 1000)}; }

}  // namespace

namespace fs = std::filesystem;
namespace {

std::string quoteYaml(const std::string& text) {
    std::string line = "\"";
    for (const char c : text) line += c == '\n' ? "\\n" : c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return line + "\"";
}

/** Returns the first file in a bag's metadata; empty: there is none. */
std::string findFirstFile(const fs::path& metadata) try {
    return YAML::LoadFile(metadata)["rosbag2_bagfile_information"]["relative_file_paths"][0].as<std::string>("");
} catch (const YAML::Exception&) {
    return {};
}

/** Waits until a file is on the disk, which a rename alone does not. */
void syncFile(const fs::path& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    fsync(file);
    close(file);
}

struct Span {
    uint64_t first = 0, length = 0;
};

Span getSpan(const FileSummary& file) { return {file.first_ns, file.last_ns - file.first_ns}; }

}  // namespace

const std::string qos_profile =
    "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

Bag::Bag(const fs::path& first_file, bool is_written)
    : path_(first_file.parent_path() / "metadata.yaml"), is_written_(is_written) {
    if (!is_written || !fs::exists(path_)) return;
    const std::string other = findFirstFile(path_), own = first_file.filename().string();
    const auto getName = [](const fs::path& file) { return file.stem().stem(); };
    const bool is_sequel = sequenceNumber(other) && sequenceNumber(own) && getName(other) == getName(own);
    if (other != own && !is_sequel)
        throw types::ConfigError(path_, "",
                                 "describes another bag, of " + (other.empty() ? "no file" : quoteYaml(other)) +
                                     "; give " + quoteYaml(own) + " a folder of its own, as in bag/" +
                                     first_file.filename().string());
}

std::string Bag::text(const ChunkWriter& present) const {
    std::vector<FileSummary> files = finished_;
    std::error_code none;
    std::erase_if(files, [&](const FileSummary& file) { return !fs::exists(file.path, none); });  // the oldest
    files.push_back(present.summary());
    uint64_t first = std::numeric_limits<uint64_t>::max(), last = 0, messages = 0;
    std::vector<uint64_t> counts(present.channels().size());
    for (const FileSummary& file : files) {
        messages += file.messages;
        if (file.messages > 0) first = std::min(first, file.first_ns), last = std::max(last, file.last_ns);
        for (size_t i = 0; i < file.counts.size(); ++i) counts[i] += file.counts[i];
    }
    if (messages == 0) first = last = 0;
    std::ostringstream out;
    out << "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  relative_file_paths:\n";
    for (const FileSummary& file : files) out << "    - " << quoteYaml(file.path.filename().string()) << '\n';
    out << "  duration:\n    nanoseconds: " << last - first
        << "\n  starting_time:\n    nanoseconds_since_epoch: " << first << "\n  message_count: " << messages
        << "\n  topics_with_message_count:" << (counts.empty() ? " []\n" : "\n");
    for (size_t i = 0; i < counts.size(); ++i) {
        const Channel& channel = present.channels()[i];
        const Texts& texts = channel.metadata;
        const auto profile = texts.find("offered_qos_profiles");
        out << "    - topic_metadata:\n        name: " << quoteYaml(channel.topic)
            << "\n        type: " << (channel.schema == 0 ? "\"\"" : present.schemas()[channel.schema - 1u].name)
            << "\n        serialization_format: " << channel.encoding
            << "\n        offered_qos_profiles: " << quoteYaml(profile == texts.end() ? qos_profile : profile->second)
            << "\n      message_count: " << counts[i] << '\n';
    }
    out << "  compression_format: \"\"\n  compression_mode: \"\"\n  files:\n";
    for (const FileSummary& file : files)
        out << "    - path: " << quoteYaml(file.path.filename().string())
            << "\n      starting_time:\n        nanoseconds_since_epoch: " << getSpan(file).first
            << "\n      duration:\n        nanoseconds: " << getSpan(file).length
            << "\n      message_count: " << file.messages << '\n';
    return out.str();
}

void Bag::write(const ChunkWriter& present) const {
    if (!is_written_) return;
    const fs::path draft = path_.string() + ".part";
    std::ofstream file(draft);
    file << text(present);
    file.close();
    const int why = errno;
    if (!file)
        throw std::runtime_error(draft.string() + ": cannot be written: " + std::generic_category().message(why));
    if (present.syncs()) syncFile(draft);
    fs::rename(draft, path_);
}

bool isOfStream(const Texts& channel, const std::string& key) {
    static const std::set<std::string> of_messages = {"offered_qos_profiles", "topic_type_hash", "insonify_stream",
                                                      "insonify_type",        "insonify_order",  "insonify_frame",
                                                      "insonify_world_frame", frame_id_key};
    return channel.contains("insonify_stream") && !of_messages.contains(key);
}

Reader::Reader(const std::filesystem::path& path, AtDamage at_damage, types::WorldFrame foreign)
    : log::Reader(path), file_(path), contents_(file_.contents(at_damage)) {
    gaps_ = contents_.gaps;
    std::erase_if(contents_.messages, [&](const MessageRef& message) {
        return contents_.channels.at(message.channel).metadata.contains(derived_key);
    });
    std::map<uint16_t, size_t> numbers;
    size_t place = 0;
    for (const auto& [number, channel] : contents_.channels) {
        const size_t own_place = place++;
        if (channel.metadata.contains(derived_key)) {
            has_transforms_ = true;
            continue;
        }
        numbers[number] = streams_.size();
        channels_.push_back(number);
        addStream(channel, own_place, foreign);
    }
    for (const MessageRef& message : contents_.messages)
        addSample(numbers.at(message.channel), getTime(message.log_ns), getTime(message.publish_ns), message.position);
}

void Reader::addStream(const Channel& channel, size_t place, types::WorldFrame foreign) {
    const Contents& contents = contents_;
    const auto schema = contents.schemas.find(channel.schema);
    const DeclaredTopic topic{channel.topic, schema == contents.schemas.end() ? "" : schema->second.name,
                              channel.encoding, &channel.metadata, foreign};
    Stream& stream = streams_.emplace_back(getStream(topic));
    decoders_.push_back(makeDecoder(topic));
    for (const Contents::Metadata& metadata : contents.metadata)
        if (metadata.name == "insonify" && metadata.channels_before <= place) stream.metadata = metadata.texts;
    if (streams_.size() > 1 && streams_.front().metadata.contains("insonify_deployment"))
        stream.metadata.erase("insonify_deployment");  // belongs to the whole log; its first stream has it
    for (const auto& [key, value] : channel.metadata)
        if (isOfStream(channel.metadata, key)) stream.metadata[key] = value;
    std::erase_if(stream.metadata, [](const auto& text) { return text.second.empty(); });
}

const Schema* Reader::schema(size_t stream) const {
    const auto found = contents_.schemas.find(channel(stream).schema);
    return found == contents_.schemas.end() ? nullptr : &found->second;
}

const std::string& Reader::layout(size_t stream) const {
    static const std::string none;
    return schema(stream) ? schema(stream)->text : none;
}

const Channel& Reader::channel(size_t stream) const { return contents_.channels.at(channels_[stream]); }

std::span<const char> Reader::toBytes(const SampleRef& at) try {
    file_.read(message(at), bytes_);
    return bytes_;
} catch (const FormatError& error) {
    failSample(at, error.what());
}

void Reader::decode(const SampleRef& at, types::SampleRoom room) { decoders_[at.stream]->decode(toBytes(at), room); }

}  // namespace insonify::log::mcap
