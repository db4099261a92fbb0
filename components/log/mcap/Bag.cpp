#include "components/log/mcap/Bag.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

#include "types/ConfigError.hpp"

namespace insonify::log::mcap {
namespace fs = std::filesystem;
namespace {

std::string quoted(const std::string& text) {
    std::string line = "\"";
    for (const char c : text) line += c == '\n' ? "\\n" : c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return line + "\"";
}

/** Returns the first file in a bag's metadata; empty: there is none. */
std::string firstFileOf(const fs::path& metadata) try {
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

Span spanOf(const FileSummary& file) { return {file.first_ns, file.last_ns - file.first_ns}; }

}  // namespace

const std::string qos_profile =
    "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

Bag::Bag(const fs::path& first_file) : path_(first_file.parent_path() / "metadata.yaml") {
    if (!fs::exists(path_)) return;
    const std::string other = firstFileOf(path_), own = first_file.filename().string();
    if (other != own)
        throw types::ConfigError(path_, "",
                                 "describes another bag, of " + (other.empty() ? "no file" : quoted(other)) +
                                     "; give " + quoted(own) + " a folder of its own, as in bag/" +
                                     first_file.filename().string());
}

std::string Bag::text(const ChunkWriter& present) const {
    std::vector<FileSummary> files = finished_;
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
    for (const FileSummary& file : files) out << "    - " << quoted(file.path.filename().string()) << '\n';
    out << "  duration:\n    nanoseconds: " << last - first
        << "\n  starting_time:\n    nanoseconds_since_epoch: " << first << "\n  message_count: " << messages
        << "\n  topics_with_message_count:" << (counts.empty() ? " []\n" : "\n");
    for (size_t i = 0; i < counts.size(); ++i) {
        const Channel& channel = present.channels()[i];
        const Texts& texts = channel.metadata;
        const auto profile = texts.find("offered_qos_profiles");
        out << "    - topic_metadata:\n        name: " << quoted(channel.topic)
            << "\n        type: " << (channel.schema == 0 ? "\"\"" : present.schemas()[channel.schema - 1u].name)
            << "\n        serialization_format: " << channel.encoding
            << "\n        offered_qos_profiles: " << quoted(profile == texts.end() ? qos_profile : profile->second)
            << "\n      message_count: " << counts[i] << '\n';
    }
    out << "  compression_format: \"\"\n  compression_mode: \"\"\n  files:\n";
    for (const FileSummary& file : files)
        out << "    - path: " << quoted(file.path.filename().string())
            << "\n      starting_time:\n        nanoseconds_since_epoch: " << spanOf(file).first
            << "\n      duration:\n        nanoseconds: " << spanOf(file).length
            << "\n      message_count: " << file.messages << '\n';
    return out.str();
}

void Bag::write(const ChunkWriter& present) const {
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

}  // namespace insonify::log::mcap
