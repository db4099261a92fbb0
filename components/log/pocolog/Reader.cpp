#include "components/log/pocolog/Reader.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "components/log/TypeNames.hpp"
#include "components/log/pocolog/Metadata.hpp"
#include "components/log/pocolog/Wire.hpp"

namespace insonify::log::pocolog {
namespace {

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

std::optional<size_t> sampleOf(const std::string& type) {
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
        streams_.push_back({declared.name, declared.type, sampleOf(declared.type), metadataFromYaml(declared.yaml)});
        registries_.push_back(std::move(declared.registry));
        yamls_.push_back(std::move(declared.yaml));
    };
    const auto add = [this](const Block& block) {
        addSample(block.stream, block.header.received(), block.header.time(), block.position);
        stored_.push_back({block.header.size, block.header.compressed != 0});
    };
    scan(file_, path, at_damage, {declare, add, gaps_});
}

std::span<const char> Reader::bytesOf(const SampleRef& at) {
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

void Reader::decode(const SampleRef& at, types::SampleRoom room) { pocolog::decode(bytesOf(at), room); }

}  // namespace insonify::log::pocolog
