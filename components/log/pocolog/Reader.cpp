#include "components/log/pocolog/Reader.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "components/log/TypeNames.hpp"
#include "components/log/pocolog/Wire.hpp"

namespace insonify::log::pocolog {
namespace {

std::string inQuotes(std::string_view value) {
    std::string text = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\')
            text += {'\\', c};
        else if (c == '\n')
            text += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            text += fmt::format("\\x{:02x}", c);
        else
            text += c;
    }
    return text + '"';
}

size_t findByte(const YAML::Mark& mark) { return mark.is_null() ? 0 : static_cast<size_t>(mark.pos); }

constexpr std::string_view index_magic = "POCOSIM_INDEX";
constexpr uint32_t index_version = 3;
constexpr uint64_t stream_entry_size = 8 * sizeof(uint64_t);
constexpr uint64_t sample_entry_size = 2 * sizeof(uint64_t);

void putBigEndian(std::vector<char>& bytes, auto value) {
    for (size_t i = sizeof value; i-- > 0;) bytes.push_back(static_cast<char>(value >> (8 * i)));
}

void put(std::vector<char>& bytes, uint64_t value) { putBigEndian(bytes, value); }
void put(std::vector<char>& bytes, types::Time time) { put(bytes, static_cast<uint64_t>(time.microseconds)); }

/** Returns the earliest and latest time, 0 without samples. The earliest need not be the first sample's: the clock may
 *  have been set back, and offsets from it are not negative. */
std::pair<types::Time, types::Time> getSpan(const StreamIndex& stream) {
    if (stream.samples.empty()) return {};
    const auto [first, last] = std::ranges::minmax_element(stream.samples, {}, &StreamIndex::Entry::time);
    return {first->time, last->time};
}

void putStream(std::vector<char>& bytes, const StreamIndex& stream, uint64_t data_position) {
    put(bytes, stream.declaration);
    const auto [first, last] = getSpan(stream);
    put(bytes, data_position);
    put(bytes, first);
    put(bytes, stream.samples.size());
    put(bytes, stream.first_received);
    put(bytes, stream.last_received);
    put(bytes, first);
    put(bytes, last);
}

/** The place of a sample. */
struct Block {
    size_t stream = 0;
    uint64_t position = 0;  ///< Position of the sample's bytes in the file [B].
    DataHeader header;
};

/** The receivers of what one pass over the block headers of a file finds, in file order. */
struct Found {
    std::function<void(Declaration)> declare;
    std::function<void(const Block&)> add;
    std::vector<Gap>& gaps;  ///< Unreadable parts.
};

class Scanner {
public:
    Scanner(const BlockFile& file, const Found& found) : file_(file), found_(found) {}

    /** Reads complete blocks until the file ends; anything else is skipped or ends the pass. */
    void run(AtDamage at_damage) {
        for (uint64_t position = sizeof(Prologue); position < file_.size();) try {
                position = take(position);
            } catch (const FormatError& error) {
                const bool skips = at_damage == AtDamage::Skip;
                const uint64_t next = skips ? nextBlock(position + 1) : file_.size();
                addGap(found_.gaps, {position, next, error.byte, error.what()});
                position = next;
            }
    }

private:
    /** Reads a block and returns where the next one begins. */
    uint64_t take(uint64_t block) {
        const BlockHeader header = file_.header(block);
        if (header.type == BlockType::Stream && !index_.contains(header.stream)) {  // repetitions are harmless
            found_.declare(file_.declaration(block, header));
            index_.emplace(header.stream, index_.size());
        }
        if (header.type == BlockType::Data) sample(block, header);
        return block + sizeof header + header.size;
    }

    void sample(uint64_t block, const BlockHeader& header) {
        const auto stream = index_.find(header.stream);
        if (stream == index_.end())
            throw FormatError(block + offsetof(BlockHeader, stream),
                              "a sample of a stream that is not declared: " + std::to_string(header.stream));
        const DataHeader data = file_.data(block, header);
        const uint64_t position = block + sizeof header + data_header_size;
        found_.add({stream->second, position, data});
    }

    /** Returns the first place from `position` on with a plausible block, or the end of the file. */
    uint64_t nextBlock(uint64_t position) const {
        std::vector<char> window(1 << 20);
        for (; position + sizeof(BlockHeader) <= file_.size(); position += window.size()) {
            const size_t size = std::min<uint64_t>(window.size(), file_.size() - position);
            if (!file_.read(position, window.data(), size)) break;
            for (size_t i = 0; i < size; ++i)
                if ((window[i] == 1 || window[i] == 2) && looksLikeBlock(position + i)) return position + i;
        }
        return file_.size();
    }

    /** Without marks in the format, nothing is certain: checks two sizes against each other, and for a block or the end
     *  behind. */
    bool looksLikeBlock(uint64_t block) const try {
        const BlockHeader header = file_.header(block);
        if (header.type == BlockType::Stream)
            file_.declaration(block, header);
        else if (!index_.contains(header.stream) || !hasMicroseconds(file_.data(block, header)))
            return false;
        const uint64_t next = block + sizeof header + header.size;
        uint8_t type = 0;
        return !file_.read(next, &type, sizeof type) || (type >= 1 && type <= 3);
    } catch (const FormatError&) {
        return false;
    }

    static bool hasMicroseconds(const DataHeader& data) {
        return data.received_us < 1'000'000 && data.time_us < 1'000'000 && data.compressed <= 1;
    }

    const BlockFile& file_;
    const Found& found_;
    std::map<uint16_t, size_t> index_;  ///< From the number in the file to that among the declarations.
};

void checkPrologue(const Prologue& prologue, const std::filesystem::path& path) {
    if (!std::equal(magic.begin(), magic.end(), prologue.magic_bytes.begin()))
        throw types::ConfigError(path, "", "is not a pocolog file: it does not start with POCOSIM");
    if (prologue.version != format_version)
        throw types::ConfigError(
            path, "",
            "is a pocolog file of version " + std::to_string(prologue.version) + "; only version 2 can be read");
    if (prologue.flags & big_endian_flag)
        throw types::ConfigError(path, "", "was logged on a big-endian machine; only little-endian logs can be read");
}

/** Scans a file. Throws ConfigError that names `path` when it is not a pocolog v2 file. */
void scan(const BlockFile& file, const std::filesystem::path& path, AtDamage at_damage, const Found& found) {
    Prologue prologue;
    const size_t there = std::min<size_t>(file.size(), sizeof prologue);
    if (there < magic.size() || !file.read(0, &prologue, there))
        throw types::ConfigError(path, "", "is not a pocolog file: it is too short");
    try {
        checkPrologue(prologue, path);
    } catch (const types::ConfigError& error) {
        if (at_damage == AtDamage::Stop) throw;
        found.gaps.push_back({0, there, 0, "the prologue " + error.diagnostics().front().message});
    }
    if (there < sizeof prologue)
        found.gaps.push_back({0, there, there, "the file ends within its prologue"});
    else
        Scanner(file, found).run(at_damage);
}

}  // namespace

std::string toYaml(const Metadata& metadata) {
    std::string yaml;
    for (const auto& [key, value] : metadata) yaml += key + ": " + inQuotes(value) + "\n";
    return yaml;
}

Metadata metadataFromYaml(std::string_view yaml) try {
    Metadata metadata;
    const YAML::Node map = YAML::Load(std::string(yaml));
    if (!map.IsMap()) return metadata;
    for (const auto& entry : map)
        if (entry.first.IsScalar() && !entry.second.IsMap() && !entry.second.IsSequence())
            metadata[entry.first.Scalar()] = entry.second.Scalar();
    return metadata;
} catch (const YAML::Exception&) {
    return {};
}

std::optional<size_t> findNotFlat(std::string_view yaml) try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(std::string(yaml));
    if (documents.size() > 1) return findByte(documents[1].Mark());
    if (documents.empty() || documents[0].IsNull()) return {};
    const YAML::Node& map = documents[0];
    if (!map.IsMap()) return findByte(map.Mark());
    for (const auto& entry : map)
        for (const YAML::Node& node : {YAML::Node(entry.first), YAML::Node(entry.second)})
            if (node.IsMap() || node.IsSequence()) return findByte(node.Mark());
    return {};
} catch (const YAML::Exception& error) {
    return findByte(error.mark);
}

std::filesystem::path indexPath(const std::filesystem::path& log) {
    return std::filesystem::path(log).replace_extension(".idx");
}

std::vector<char> indexBytes(const std::vector<StreamIndex>& streams, uint64_t log_size, types::Time log_modified) {
    std::vector<char> bytes(index_magic.begin(), index_magic.end());
    putBigEndian(bytes, index_version);
    put(bytes, log_size);
    put(bytes, log_modified);
    put(bytes, streams.size());
    uint64_t data_position = bytes.size() + streams.size() * stream_entry_size, size = data_position;
    for (const StreamIndex& stream : streams) size += stream.samples.size() * sample_entry_size;
    bytes.reserve(size);
    for (const StreamIndex& stream : streams) {
        putStream(bytes, stream, data_position);
        data_position += stream.samples.size() * sample_entry_size;
    }
    for (const StreamIndex& stream : streams) {
        const types::Time first = getSpan(stream).first;
        for (const StreamIndex::Entry& sample : stream.samples) {
            put(bytes, sample.position);
            put(bytes, sample.time - first);
        }
    }
    return bytes;
}

void writeIndex(const std::filesystem::path& log, const std::vector<StreamIndex>& streams) {
    struct stat status {};
    if (stat(log.c_str(), &status) != 0) return;
    const types::Time modified{int64_t{status.st_mtim.tv_sec} * 1'000'000 + status.st_mtim.tv_nsec / 1000};
    const std::vector<char> bytes = indexBytes(streams, static_cast<uint64_t>(status.st_size), modified);
    std::ofstream file(indexPath(log), std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) std::filesystem::remove(indexPath(log));
}

std::optional<size_t> findSample(const std::string& type) {
    std::optional<size_t> sample;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (type == typelibName<T>() || type == cxxName<T>()) sample = types::sampleIndex<T>();
    });
    return sample;
}

void decode(std::span<const char> bytes, types::SampleRoom room) {
    std::visit([&](auto* sample) { unmarshal(bytes, *sample); }, room);
}

Reader::Reader(const std::filesystem::path& path, AtDamage at_damage) : log::Reader(path), file_(path) {
    const auto declare = [this](Declaration declared) {
        streams_.push_back({declared.name, declared.type, findSample(declared.type), metadataFromYaml(declared.yaml)});
        registries_.push_back(std::move(declared.registry));
        yamls_.push_back(std::move(declared.yaml));
    };
    const auto add = [this](const Block& block) {
        addSample(block.stream, block.header.received(), block.header.time(), block.position);
        stored_.push_back({block.header.size, block.header.compressed != 0});
    };
    scan(file_, path, at_damage, {declare, add, gaps_});
}

std::span<const char> Reader::toBytes(const SampleRef& at) {
    const Stored& stored = stored_[at.number];
    buffer_.resize(stored.size);
    if (!file_.read(at.position, buffer_.data(), stored.size)) failSample(at, "cannot be read any more");
    if (!stored.compressed) return buffer_;
    try {
        inflateTo(inflated_, buffer_);
    } catch (const FormatError& error) {
        failSample(at, error.what());
    }
    return inflated_;
}

void Reader::decode(const SampleRef& at, types::SampleRoom room) { pocolog::decode(toBytes(at), room); }

}  // namespace insonify::log::pocolog
